"""Points of curves under the names that recorded runs have."""

from __future__ import annotations

from calibrate.runs.reuse import point_of, with_curves
from liggghts_io import CaseResult, CaseSpec
from tests.calibrate.diagnose.engine import LEVELS


def observed(result: CaseResult, spec: CaseSpec) -> dict[str, float]:
    """Return what is recorded of a run: its observables, and the times at some masses."""
    shown = dict(with_curves(result, spec, {("conveyor", "mass_time"): LEVELS}).observables)
    for m in LEVELS:
        if (point := point_of("mass_time", m)) in shown:
            shown.setdefault(f"t{m}_s", shown.pop(point))
    return {name: value for name, value in shown.items() if "@" not in name}
