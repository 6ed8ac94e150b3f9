"""A small study of an experiment of one's own: a grain that falls, beside its folder."""

from __future__ import annotations

from pathlib import Path

from tests.liggghts_io.own.folders import make_folder

STUDY = """\
name = "falling"
title = "A grain that falls"

[run]
seed = 7

[[material]]
name = "glass"
d32_um = 1000.0
density_kg_m3 = 2500.0

[[surface]]
name = "steel"

[[experiment]]
name = "fall"
folder = "rig"

[[target]]
name = "time"
experiment = "fall"
observable = "t_ground_s"
unit = "ms"
value = 45.2
se = 0.2

[parameter.mu_pp]
value = 0.5

[parameter.e_pp]
value = 0.6

[parameter.height_m]
range = [0.015, 0.03]
"""
CURVE = """
[[target]]
name = "path"
experiment = "fall"
observable = "height"
file = "path.csv"
x_column = "time_s"
column = "height_mm"
se_column = "sem_mm"
"""


def write_rig(
    folder: Path, *changes: tuple[str, str], more: str = "", definition: str = ""
) -> Path:
    """Write the study and its folder, words of the study replaced and lines added."""
    make_folder(folder / "rig", definition)
    text = STUDY
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    path = folder / "study.toml"
    path.write_text(text + more, encoding="utf-8")
    return path
