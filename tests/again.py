"""Stored runs are what the engine gives today."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import pytest

from calibrate.runs.table import TableRow, digest_of
from liggghts_io import case_id, execute
from liggghts_io.case.spec import describe

NOISE: Final = {"angle_deg": 5.0, "t100_s": 2.5, "m1_g": 3.0, "m2_g": 2.5, "m3_g": 1.7,
                "m4_g": 1.0, "beside_g": 3.5}  # fmt: skip
"""Three and a half standard deviations between two seeds (docs/apparatus.md): another processor
rounds otherwise, and trajectories part."""


def comes_out_again(row: TableRow, folder: Path) -> None:
    """Run a stored case again and compare: the same digest, or the same but for rounding."""
    case = describe(row.spec)
    if case_id(row.spec) == row.result.case_id:
        assert case.inputs["script"].startswith(row.facts["script"])
    result = execute(row.spec, folder)
    assert result.status == row.result.status, row.result.case_id
    if digest_of(result) == row.facts["digest"]:
        return
    for name, value in row.result.observables.items():
        assert result.observables[name] == pytest.approx(value, abs=NOISE[name]), name


def short(row: TableRow, steps: float) -> bool:
    """Whether a run takes fewer particle-steps."""
    return row.facts["steps"] * row.facts["grains"] < steps
