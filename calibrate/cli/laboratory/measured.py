"""The commands `measured scale` and `measured add`: what was measured, as a study reads it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from calibrate.cli import completion
from calibrate.cli.arguments import AsJson, Quiet, one_of
from calibrate.cli.laboratory.options import (
    CHECK,
    ExperimentWord,
    MaterialName,
    ObservableName,
    Out,
    Plot,
    SurfaceLabel,
    TargetName,
    TimeColumn,
    TimeUnit,
    alone_with_table,
    checked_target,
    new_picture,
    place_of,
    write_all,
)
from calibrate.cli.show.output import Screen
from calibrate.cli.show.waiting import Waiting
from calibrate.errors import CalibrationError

if TYPE_CHECKING:
    from calibrate.laboratory.entries import Entry
    from calibrate.laboratory.targets import Place

__all__ = ["app"]

app = typer.Typer(
    name="measured",
    rich_markup_mode=None,
)

_QUANTITIES = ("time", "onset", "slope", "plateau")


Logs = Annotated[
    list[Path], typer.Argument(metavar="LOG.csv ...", help="Logs of one experiment, repeats.")
]
Mass = Annotated[str, typer.Option("--mass", help="Mass whose time is asked for, with its unit.")]
QuantityName = Annotated[
    str,
    typer.Option(
        "--quantity", metavar="|".join(_QUANTITIES),
        autocompletion=completion.offer(_QUANTITIES),
        help="What is written: the time of --mass, or another number of the log.",
    ),
]  # fmt: skip
WholeCurve = Annotated[
    bool, typer.Option("--curve", help="Write the whole mass-time curve into --out.")
]
Start = Annotated[
    list[str],
    typer.Option(
        "--start", metavar="TIME",
        help="When the funnel was opened, as the log counts; once for all logs, or for each.",
    ),
]  # fmt: skip
MassColumn = Annotated[
    str, typer.Option("--mass-column", help="Column of the mass, where the file does not say.")
]
MassUnit = Annotated[
    str, typer.Option("--mass-unit", help="Its unit: g, kg, mg, lb, oz; if the file does not.")
]
Numbers = Annotated[
    list[str],
    typer.Argument(metavar="NUMBER ...|TABLE.csv", help="Numbers, or a table of repeats."),
]
Column = Annotated[
    str, typer.Option("--column", help="Column of the table that holds the numbers.")
]
Where = Annotated[
    list[str],
    typer.Option(
        "--where", metavar="COLUMN=WORD", help="Rows of the table that count, repeatable."
    ),
]
Unit = Annotated[
    str, typer.Option("--unit", help="Unit of the numbers, where the column does not say.")
]
OneError = Annotated[
    float | None,
    typer.Option("--se", help="Standard error of a single number, which is then a mean."),
]
Repeats = Annotated[
    int, typer.Option("--repeats", min=0, max=10**9, help="Measurements behind --se.")
]


@app.callback(invoke_without_command=True)
def measured(ctx: typer.Context) -> None:
    """Turn logs of a scale and repeated numbers into targets of a study.

    Example: bulkcal measured scale run1.csv run2.csv --out measured.csv --name t100_steel

    Example: bulkcal measured add 34.2 33.8 34.6 --unit deg
    """
    if ctx.invoked_subcommand is None:
        Screen().result(ctx.get_help())


@app.command("scale", short_help="Logs of a scale: times, onset, flow, plateau.")
def scale(
    logs: Logs,
    mass: Mass = "100g",
    quantity: QuantityName = "time",
    curve: WholeCurve = False,
    start: Start = [],  # noqa: B006 - typer copies it
    time_column: TimeColumn = "",
    mass_column: MassColumn = "",
    time_unit: TimeUnit = "",
    mass_unit: MassUnit = "",
    out: Out = None,
    name: TargetName = "",
    material: MaterialName = "",
    surface: SurfaceLabel = "",
    experiment: ExperimentWord = "conveyor",
    observable: ObservableName = "",
    plot: Plot = None,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> None:
    """Read logs of a scale: time until a mass lies on it, onset, steady flow, plateau.

    Tables of most scales are read as they are: any separator, decimal commas, time stamps, lines
    of the scale about itself. What was on the scale before is taken off, and so are drift, bumps
    and rows that stand twice. Several logs are repeats; their mean goes into --out as a row that a
    study reads, and the lines of the study are printed.

    Example: bulkcal measured scale run1.csv run2.csv run3.csv --mass 100g --out measured.csv
    --name t100_steel --surface steel
    """
    screen = Screen(quiet)
    one_of("--quantity", quantity, _QUANTITIES)
    with Waiting(screen.console, "reading the logs"):
        from calibrate.cli.laboratory.scale_result import (
            Asked,
            read_logs,
            scale_data,
            scale_files,
            show_scale,
        )
        from calibrate.laboratory.instrument.series import Form

        wanted = ("mass_time" if curve else "t100_s") if quantity == "time" else ""
        place = None
        if out is not None:
            checked_target(out, name)
            place = place_of(experiment, observable or (wanted if experiment == "conveyor" else ""))
        asked = Asked(mass, quantity, curve, out, name, material, surface, place)
        picture = new_picture(plot, None if out is None else out.with_name(f"{name}.png"))
        form = Form(time_column, mass_column, time_unit, mass_unit)
        found = read_logs(logs, form, start, asked)
        with alone_with_table(out):
            files, lines = scale_files(found, asked, picture)
            write_all(files)
    if as_json:
        screen.json(scale_data(found, asked, files, lines))
        return
    show_scale(screen, found, asked)
    _written(screen, list(files), lines)


@app.command("add", short_help="Repeated numbers: mean and standard error.")
def add(
    words: Numbers,
    column: Column = "",
    where: Where = [],  # noqa: B006 - typer copies it
    unit: Unit = "",
    se: OneError = None,
    repeats: Repeats = 0,
    out: Out = None,
    name: TargetName = "",
    material: MaterialName = "",
    surface: SurfaceLabel = "",
    experiment: ExperimentWord = "",
    observable: ObservableName = "",
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> None:
    """Turn repeats into mean and standard error of the mean, and into a target of a study.

    The repeats are the numbers of the command line, or a column of a table with a row for each;
    of a table that tells walls or bulk solids apart, those of --surface and --material.

    Example: bulkcal measured add 34.2 33.8 34.6 --unit deg --out measured.csv
    --name angle_steel --surface steel --experiment heap --observable angle_deg
    """
    screen = Screen(quiet)
    from calibrate.cli.laboratory.values_result import values_of

    found = values_of(words, column, where, unit, se, repeats, surface, material)
    if out is None:
        _show_mean(screen, found, as_json)
        return
    from calibrate.laboratory.entries import Entry, extended
    from calibrate.laboratory.targets import check_value, value_lines

    checked_target(out, name)
    place: Place = place_of(experiment, observable)
    if not found["unit"]:
        msg = "--unit: is missing; give the unit of the numbers, such as --unit deg"
        raise CalibrationError(msg)
    entry: Entry = Entry(name, material, surface, found["mean"], found["se"], found["unit"],
                         found["repeats"], found["from"])  # fmt: skip
    check_value(entry, place)
    for number in found["values"]:
        check_value(replace(entry, value=number), place)
    with alone_with_table(out):
        write_all({out: extended(out, entry)})
    lines = value_lines(entry, place, out.name)
    if as_json:
        screen.json({**found, "written": [str(out)], "study": lines})
        return
    _show_mean(screen, found, as_json)
    _written(screen, [out], lines)


def _show_mean(screen: Screen, found: dict[str, Any], as_json: bool) -> None:
    if as_json:
        screen.json(found)
        return
    for doubt in found["doubts"]:
        screen.remark(doubt)
    many = f", {found['repeats']} repeats" if found["repeats"] else ""
    screen.result(f"{found['mean']:.6g} ± {found['se']:.3g} {found['unit']}".rstrip() + many)


def _written(screen: Screen, files: list[Path], lines: str) -> None:
    """Print which files were written, and what goes into the study."""
    for path in files:
        screen.result(f"wrote {path}")
    if lines:
        screen.hint(f"into the study, beside the table, and then '{CHECK}':\n")
        screen.result(lines)
