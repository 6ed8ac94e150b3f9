"""From a study file to the lines of a script, on the engine itself: planted values come back."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from tests.calibrate.study.rigs import CURVE, write_rig

SMALL = "[design]\nruns = 30\nstart = 12\ncheck_seeds = 2\ncheck_draws = 2\n"
HEIGHT, WEIGHT = 0.0222, -0.1
"""Planted: 22.2 mm above the ground, and gravity 10 % weaker than assumed."""


def planted(folder: Path) -> Path:
    """Write a study of a falling grain whose data follow from Newton's law."""
    gravity = 9.81 * (1.0 + WEIGHT)
    times = np.linspace(0.002, 0.05, 25)
    path = 1000.0 * (HEIGHT - 0.5 * gravity * times**2)
    rows = "".join(f"{t:.4f},{z:.4f},0.05\n" for t, z in zip(times, path, strict=True))
    (folder / "path.csv").write_text(f"time_s,height_mm,sem_mm\n{rows}")
    half_ms = 1000.0 * (HEIGHT / gravity) ** 0.5  # until half the height
    return write_rig(
        folder,
        ("value = 45.2", f"value = {half_ms:.4f}"),
        ("[[material]]", f"{SMALL}[[material]]"),
        more=f"{CURVE}levels = [0.01, 0.02, 0.03, 0.04]\n[parameter.weight]\nrange = [-0.3, 0.3]\n",
    )


def test_a_joint_calibration_from_study_to_export(bulkcal, tmp_path: Path) -> None:
    study, out = planted(tmp_path), tmp_path / "out"
    words = ["calibrate", str(study), "--out", str(out)]
    code, said, err = bulkcal(*words)
    assert code == 0, err
    assert "Check with the engine at these values" in said
    record = json.loads((out / "calibration.json").read_text(encoding="utf-8"))["joint"]
    truth = {"height_m": HEIGHT, "weight": WEIGHT}
    for row in record["unknowns"]:
        assert row["low_95"] <= truth[row["name"]] <= row["high_95"]
    runs = len(list((out / "runs").iterdir()))
    assert said.startswith(bulkcal(*words, "-q")[1])  # from what is stored, to the same words
    assert len(list((out / "runs").iterdir())) == runs
    code, lines, err = bulkcal("export", str(out), "--format", "csv")
    assert code == 0, err
    values = {row.split(",")[0]: row.split(",")[1] for row in lines.splitlines()[1:]}
    assert abs(float(values["height_m"]) - HEIGHT) < 0.5e-3
    page = (out / "report.html").read_text(encoding="utf-8")
    assert page.count("data:image/png") >= 4
