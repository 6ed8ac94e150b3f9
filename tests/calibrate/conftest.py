"""What the tests of the calibration share."""

from __future__ import annotations

import shutil
from pathlib import Path

import pandas as pd
import pytest

from calibrate.cli import calibrate_study, main, running
from calibrate.cli.joint import study as joint_study
from calibrate.cli.plans import diagnosis as plans_of_diagnosis
from calibrate.cli.plans import study as plans_of_study
from calibrate.cli.sensitivity import plan as plan_of_sensitivity
from calibrate.runs import cost
from calibrate.runs.campaign import Campaign, run_table
from calibrate.study.load import load_study
from calibrate.study.model import Study
from calibrate.study.resources import bundled_study
from calibrate.study.write import study_text
from tests.calibrate import stand_in


@pytest.fixture
def study_path() -> Path:
    return bundled_study()


@pytest.fixture
def study(study_path: Path) -> Study:
    return load_study(study_path)


@pytest.fixture
def runner(tmp_path: Path):
    """Return a runner that calls the stand-in in this process."""

    def run(specs, label) -> pd.DataFrame:
        del label
        return run_table(specs, [stand_in.execute(spec, tmp_path / "runs") for spec in specs])

    return run


@pytest.fixture
def bulkcal(capsys, monkeypatch):
    """Return a function that runs the command and gives exit code, stdout and stderr."""
    monkeypatch.setenv("NO_COLOR", "1")

    def call(*words: str) -> tuple[int, str, str]:
        with pytest.raises(SystemExit) as ended:
            main.main(words)
        out, err = capsys.readouterr()
        code = ended.value.code
        return int(code) if isinstance(code, int) else 1, out, err

    return call


@pytest.fixture
def small_study(tmp_path: Path) -> Path:
    """Write a study of one small stage beside its data."""
    bundled = bundled_study()
    for csv in bundled.parent.glob("*.csv"):
        shutil.copy(csv, tmp_path)
    study = load_study(bundled)
    stage = study.stages[0].model_copy(update={"points": 10, "repeats": 2, "infill": 0})
    glued = ("mu_pp", "mu_roll_pp", "e_pp")
    small = study.model_copy(
        update={
            "stages": [stage],
            "targets": study.targets[:2],
            "surfaces": [study.surface_named("glued")],
            "parameters": {name: study.parameters[name] for name in glued},
            "design": study.design.model_copy(
                update={"check_seeds": 2, "check_draws": 1, "runs": 40}
            ),
        }
    )
    path = tmp_path / "small.toml"
    path.write_text(study_text(small), encoding="utf-8")
    return path


@pytest.fixture
def on_stand_in(monkeypatch):
    """Let whole studies run on the stand-in; returns the list of cases it was asked for."""
    asked = []

    class Inline(Campaign):
        """Runs in this process, so that the stand-in needs no importing."""

        def _results(self, specs, todo):
            for index in list(todo):
                asked.append(specs[index])
                yield index, stand_in.execute(specs[index], self.root)

    def render(directory: Path) -> Path:
        msg = "the stand-in has no pictures"
        raise OSError(msg)

    monkeypatch.setattr(running, "Campaign", Inline)
    monkeypatch.setattr(cost.cost_of, "__defaults__", (stand_in.execute, lambda _line: None))
    for module in (running, plans_of_study, plans_of_diagnosis, plan_of_sensitivity):
        monkeypatch.setattr(module, "stored_case", stand_in.stored)
    for module in (calibrate_study, joint_study):
        monkeypatch.setattr(module, "render_case", render)
    return asked
