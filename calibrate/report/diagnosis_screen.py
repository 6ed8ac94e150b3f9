"""The diagnosis on the screen: tables and sentences."""

from __future__ import annotations

from rich.console import Console
from rich.table import Table

from calibrate.diagnose.pipeline import Diagnosis
from calibrate.diagnose.residuals import Residual
from calibrate.report.diagnosis_words import sentences


def show(found: Diagnosis, console: Console) -> None:
    """Print residuals, the absorption table, then the verdict."""
    title = "Measured and simulated, all parameters refitted jointly"
    console.print(residual_table(found.residuals, title))
    console.print(_absorption(found))
    if found.engine_before:
        title = "The engine at the refitted parameters, fresh seeds"
        console.print(residual_table(found.engine_before, title))
    if found.engine_after:
        title = f"The engine with {found.verdict.names[0]}, fresh seeds"
        console.print(residual_table(found.engine_after, title))
    for line in sentences(found):
        console.print(line, markup=False, highlight=False, soft_wrap=True)


def residual_table(rows: tuple[Residual, ...], title: str) -> Table:
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


def _absorption(found: Diagnosis) -> Table:
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
