"""Rows of the tables of a diagnosis."""

from __future__ import annotations

from typing import Any

from calibrate.report.diagnosis.rows import engine_rows


def _row(level: float | None, measured: float, simulated: float, z: float) -> dict[str, Any]:
    return {
        "name": "curve", "label": "curve", "unit": "s", "level": level, "measured": measured,
        "measured_se": 0.11, "simulated": simulated, "simulated_se": 0.08, "seeds": 3, "z": z,
    }  # fmt: skip


def _cells(before: dict[str, Any], after: dict[str, Any]) -> list[str]:
    return engine_rows({"engine_before": [before], "engine_after": [after]})[0]


def test_a_curve_that_is_furthest_off_at_another_level_with_the_cause_says_so():
    worst = _row(90.0, 13.21, 11.67, 11.5)
    name, measured, without, _, with_cause, z = _cells(worst, _row(70.0, 12.06, 11.97, 0.7))
    assert (name, measured, without) == ("curve at 90", "13.21 ± 0.11 s", "11.670 ± 0.080")
    assert with_cause == "11.970 ± 0.080 at 70, measured 12.06 ± 0.11"
    assert z == "+0.7"
    assert _cells(worst, _row(90.0, 13.21, 13.1, 0.8))[4] == "13.100 ± 0.080"
    assert _cells(_row(None, 5.0, 4.0, 3.0), _row(None, 5.0, 4.9, 0.2))[4] == "4.900 ± 0.080"
