"""A study calibrated both ways, as several files of tests need it."""

from __future__ import annotations

import shutil
from dataclasses import dataclass, field
from pathlib import Path

import pytest


@dataclass
class Kept:
    """A calibrated directory to copy from, and what its calibration printed."""

    folder: Path
    said: list[str] = field(default_factory=list)


@pytest.fixture(scope="session")
def kept(tmp_path_factory) -> Kept:
    """Return the place for what the first test calibrates."""
    return Kept(tmp_path_factory.mktemp("calibrated") / "out")


@pytest.fixture
def both(bulkcal, small_study: Path, tmp_path: Path, on_stand_in, kept: Kept):
    """Calibrate in both modes, once for all tests, whose directories are copies.

    Returns the directory, what was printed, and the list of cases asked for from now on.
    """
    out = tmp_path / "out"
    if not kept.said:
        code, said, err = bulkcal("calibrate", str(small_study), "--out", str(out))
        assert code == 0, err
        shutil.copytree(out, kept.folder)
        kept.said += [said, err]
    else:
        shutil.copytree(kept.folder, out)
    return out, *kept.said, on_stand_in
