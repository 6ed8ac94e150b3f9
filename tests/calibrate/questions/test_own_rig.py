"""Experiments of one's own are calibrated jointly: planted values are found again."""

from __future__ import annotations

import shutil
import tomllib
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from calibrate.questions.joint.calibration import calibrate_jointly
from calibrate.questions.joint.result import JointResult
from calibrate.runs.campaign import run_table
from calibrate.study.data import load_data
from liggghts_io import execute
from tests.calibrate.study.rigs import CURVE, write_rig
from tests.paths import ROOT

SMALL = "[design]\nruns = 24\nstart = 12\ncheck_seeds = 2\ncheck_draws = 2\n"
FEW = "[design]\nruns = 11\nstart = 8\ncheck_seeds = 2\ncheck_draws = 1\n"
HEIGHT, WEIGHT = 0.022, 0.12
"""Planted: 22 mm above the ground, and gravity 12 % stronger than assumed."""


def calibrated(study: Path, folder: Path) -> JointResult:
    run = partial(execute, root=folder)
    return calibrate_jointly(
        load_data(study), lambda specs, _label: run_table(specs, [run(spec) for spec in specs])
    )


def test_a_height_and_an_own_effect_are_found_from_a_falling_grain(tmp_path: Path) -> None:
    gravity = 9.81 * (1.0 + WEIGHT)
    times = np.linspace(0.002, 0.05, 25)
    path = 1000.0 * (HEIGHT - 0.5 * gravity * times**2)
    rows = "".join(f"{t:.4f},{z:.4f},0.05\n" for t, z in zip(times, path, strict=True))
    (tmp_path / "path.csv").write_text(f"time_s,height_mm,sem_mm\n{rows}")
    time_ms = 1000.0 * (HEIGHT / gravity) ** 0.5  # until half the height
    study = write_rig(
        tmp_path,
        ("value = 45.2", f"value = {time_ms:.4f}"),
        ("[[material]]", f"{SMALL}[[material]]"),
        more=f"{CURVE}levels = [0.01, 0.02, 0.03, 0.04]\n[parameter.weight]\nrange = [-0.3, 0.3]\n",
    )
    found = calibrated(study, tmp_path / "runs")
    table = found.table()
    for name, truth in (("height_m", HEIGHT), ("weight", WEIGHT)):
        assert table.low_95[name] <= truth <= table.high_95[name]
    # Both are known to about the errors of the measurement: 0.05 mm of 20 mm, 0.2 ms of 45 ms.
    assert table.sd["height_m"] < 0.5e-3
    assert table.sd["weight"] < 0.05


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.parametrize("name", ["drum", "plain_script"])
def test_a_shipped_example_finds_its_planted_values(tmp_path: Path, name: str) -> None:
    """A tenth of the study's runs; `cases/own_rigs_planted.csv` has the whole, and drawdown."""
    case = Path(shutil.copytree(ROOT / "cases" / name, tmp_path / name))
    study = case / "study.toml"
    text = study.read_text(encoding="utf-8")
    assert "[design]\nruns = 120\n" in text
    study.write_text(text.replace("[design]\nruns = 120\n", FEW), encoding="utf-8")
    truth = tomllib.loads((case / "truth.toml").read_text(encoding="utf-8"))["parameters"]
    posterior = calibrated(study, tmp_path / "runs").posterior
    for free in posterior.names:
        # Intervals of 99 %: right ones of 95 % would miss in every third design of runs.
        span = posterior.interval(free, 0.99)
        assert span.low <= truth[free] <= span.high
