"""What the tests of the calibration share."""

from __future__ import annotations

import sys
from pathlib import Path

import pandas as pd
import pytest

# Worker processes import the stand-ins by name; they inherit this path.
sys.path.insert(0, str(Path(__file__).parent))

import stand_in

from calibrate.runs.campaign import run_table
from calibrate.study.load import load_study
from calibrate.study.model import Study
from calibrate.study.resources import bundled_study


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
