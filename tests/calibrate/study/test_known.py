"""Independent measurements in a study file: what is taken, what a calibration does not use."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from calibrate.errors import StudyError
from calibrate.study.checks.known import unheeded
from calibrate.study.data import load_data
from tests.calibrate.questions.planted import bench, planted_study

TILT = "[known.plate_tilt_deg]\nvalue = 2.0\nse = {se}\n"
FUNNEL = """
[[known.mass_flow_factor]]
value = {value}
se = 0.01
experiment = "conveyor"
surface = "{wall}"
"""


@pytest.mark.parametrize(
    ("se", "effects", "said"),
    [(0.1, "", 1), (1.0, "", 0), (0.1, "[effects]\nplate_tilt_deg = 2.0\n", 0)],
)
def test_a_strength_that_is_not_zero_is_no_mistake_but_said(
    folder: Path, se: float, effects: str, said: int
) -> None:
    path = folder / "study.toml"
    path.write_text(f"{path.read_text(encoding='utf-8')}\n{TILT.format(se=se)}{effects}")
    lines = unheeded(load_data(path).study)
    assert len(lines) == said
    for line in lines:
        assert "known.plate_tilt_deg: 2 with standard error 0.1 excludes zero" in line
        assert "switch it on: [effects] plate_tilt_deg = 2," in line


def test_a_calibration_says_what_it_does_not_use(bulkcal, folder: Path) -> None:
    path = folder / "study.toml"
    path.write_text(f"{path.read_text(encoding='utf-8')}\n{TILT.format(se=0.1)}")
    code, said, err = bulkcal("calibrate", str(path), "--out", str(folder / "out"), "--dry-run")
    assert code == 0, err
    assert f"{path}: known.plate_tilt_deg: 2 with standard error 0.1" in " ".join(err.split())
    assert "known.plate_tilt_deg" not in said


def test_two_funnels_may_both_have_been_weighed(tmp_path: Path) -> None:
    walls = [*bench("A", "steel"), *bench("A", "glued")]
    tables = "".join(FUNNEL.format(value=v, wall=w) for v, w in ((0.0, "steel"), (0.02, "glued")))
    study = planted_study(tmp_path, walls, np.random.default_rng(1), more=tables).study
    assert [one.value for one in study.known["mass_flow_factor"]] == [0.0, 0.02]
    twice = tables + FUNNEL.format(value=0.1, wall="steel")
    with pytest.raises(StudyError, match="two measurements of conveyor_flat; join them into one"):
        planted_study(tmp_path, walls, np.random.default_rng(1), more=twice)


@pytest.mark.parametrize(("value", "wrong"), [(0.75, False), (0.82, False), (0.9, True)])
def test_a_measurement_that_its_range_cannot_agree_with_is_a_mistake(
    folder: Path, value: float, wrong: bool
) -> None:
    """The range ends at 0.8; three standard errors of 0.01 may lie above it."""
    path = folder / "study.toml"
    path.write_text(path.read_text() + f"\n[known.mu_pp]\nvalue = {value}\nse = 0.01\n")
    if not wrong:
        assert load_data(path).study.known
        return
    with pytest.raises(StudyError, match=r"lies outside its range, 0.1 to 0.8; widen the range"):
        load_data(path)
