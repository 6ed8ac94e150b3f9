"""Show the observables of a case."""

from __future__ import annotations

from calibrate.cli.show.output import Screen, table
from calibrate.errors import CalibrationError
from liggghts_io import CaseResult, CaseSpec, experiment_of

__all__ = ["show_result"]


def show_result(result: CaseResult, spec: CaseSpec, screen: Screen, as_json: bool) -> None:
    """Print what a run says.

    Raises
    ------
    CalibrationError
        If the run failed: it is data for a campaign, but a person who asked for it wants to know.
    """
    if as_json:
        screen.json(
            {
                "case_id": result.case_id,
                "status": result.status,
                "reason": result.reason,
                "failure": result.failure,
                "observables": dict(result.observables),
                "wall_s": result.wall_s,
            }
        )
    elif result.status == "ok":
        screen.hint(f"{spec.particle.name}, {spec.experiment} on a {spec.kind} wall")
        shown = table(["observable", "value", "unit", "meaning"], ["value"])
        for one in experiment_of(spec).observables:
            shown.add_row(one.name, f"{result.observables[one.name]:.6g}", one.unit, one.meaning)
        screen.table(shown)
        screen.hint(f"{result.wall_s:.1f} s")
    if result.status != "ok":
        msg = f"{result.path}: the run failed: {result.reason}"
        raise CalibrationError(msg)
