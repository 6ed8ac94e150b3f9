"""What a calibration by stages shows on the screen."""

from __future__ import annotations

from rich.table import Table

from calibrate.report.numbers import band, plus_minus, signed
from calibrate.significance import shown
from calibrate.staged.calibration import Calibration
from calibrate.staged.crossing import LINES
from calibrate.staged.result import StageResult

__all__ = ["result_tables", "stage_line"]

REMARKS = {
    "crossing": "",
    "no_crossing": "lines do not cross",
    "out_of_reach": "a target is out of reach",
}
"""Status of a stage in the words of a table."""


def stage_line(result: StageResult) -> str:
    """Return what a stage found with its 90 % intervals, in one line."""
    found = ", ".join(
        f"{name} = {value:.3f} ({band(result.intervals[name][0.9])})"
        for name, value in result.found.items()
    )
    return f"{result.stage.title}: {found}"


def result_tables(result: Calibration) -> list[Table]:
    """Return the parameters with intervals, and measured against simulated."""
    return [_parameter_table(result), _check_table(result)]


def _parameter_table(result: Calibration) -> Table:
    table = Table(title=f"{result.study.title}: parameters", title_justify="left")
    table.add_column("parameter")
    known = any(one.published for one in result.study.parameters.values())
    headings = ("value", "68 % interval", "90 % interval", "eq. 18", *(["published"] * known))
    for heading in headings:
        table.add_column(heading, justify="right")
    table.add_column("remark")
    for stage in result.stages:
        for name, instance in stage.freed.keys:
            value, levels = stage.found[name], stage.intervals[name]
            published = result.study.published_of(name, instance)
            table.add_row(
                result.study.label(name, instance),
                f"{value:.3f}",
                band(levels[0.68]),
                band(levels[0.90]),
                f"{stage.least_squares[name]:.3f}",
                *(["" if published is None else f"{published:.3f}"] * known),
                _remark(stage),
            )
    return table


def _remark(stage: StageResult) -> str:
    missed = stage.verdict.status == "no_crossing" and stage.posterior.size != LINES
    return "no point meets all targets" if missed else REMARKS[stage.verdict.status]


def _check_table(result: Calibration) -> Table:
    table = Table(
        title=f"Check with the simulator, {result.study.design.check_seeds} seeds",
        title_justify="left",
    )
    table.add_column("observable")
    for heading in ("unit", "measured", "simulated", "deviation", "z"):
        table.add_column(heading, justify="right")
    for row in result.check:
        table.add_row(
            row.label if row.used else f"{row.label} (not used)",
            row.unit,
            plus_minus(row.measured, row.measured_se),
            plus_minus(row.simulated, row.simulated_se),
            signed(row.deviation_percent, " %"),
            shown(row.z),
        )
    return table
