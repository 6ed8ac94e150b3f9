"""What a calibration and a diagnosis show on the screen."""

from __future__ import annotations

from rich.console import Console
from rich.table import Table

from calibrate.diagnose.pipeline import Diagnosis
from calibrate.diagnose.residuals import Residual
from calibrate.report.diagnosis_words import sentences
from calibrate.report.numbers import band, plus_minus, signed
from calibrate.significance import shown
from calibrate.staged.calibration import Calibration
from calibrate.staged.crossing import LINES
from calibrate.staged.result import StageResult

__all__ = ["result_tables", "show_diagnosis", "stage_line"]

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
    for heading in ("value", "68 % interval", "90 % interval", "eq. 18", "published"):
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
                "" if published is None else f"{published:.3f}",
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


def show_diagnosis(found: Diagnosis, console: Console) -> None:
    """Print residuals, the absorption table, then the verdict."""
    title = "Measured and simulated, all parameters refitted jointly"
    console.print(_residual_table(found.residuals, title))
    console.print(_absorption_table(found))
    if found.engine_before:
        title = "The engine at the refitted parameters, fresh seeds"
        console.print(_residual_table(found.engine_before, title))
    if found.engine_after:
        title = f"The engine with {found.verdict.names[0]}, fresh seeds"
        console.print(_residual_table(found.engine_after, title))
    for line in sentences(found):
        console.print(line, markup=False, highlight=False, soft_wrap=True)


def _residual_table(rows: tuple[Residual, ...], title: str) -> Table:
    """Table of residuals."""
    table = Table(title=title, title_justify="left")
    table.add_column("observable")
    for head in ("measured", "se", "simulated", "se", "z", "z left out"):
        table.add_column(head, justify="right")
    for r in rows:
        table.add_row(
            r.name,
            f"{r.measured:.4g}",
            f"{r.measured_sd:.2g}",
            f"{r.simulated:.4g}",
            f"{r.simulated_sd:.2g}",
            f"{r.z:+.1f}",
            f"{r.z_left_out:+.1f}",
        )
    return table


def _absorption_table(found: Diagnosis) -> Table:
    table = Table(title="What each cause would look like in these data", title_justify="left")
    table.add_column("cause")
    for head in ("absorbed", "seen from", "plausible up to"):
        table.add_column(head, justify="right")
    table.add_column("looks like")
    for v in found.absorption.candidates:
        table.add_row(
            v.candidate,
            f"{100 * v.absorbed:.0f} %",
            f"{v.detectable:.3g}",
            f"{v.limit:.3g}",
            ", ".join(v.alike) or "-",
        )
    return table
