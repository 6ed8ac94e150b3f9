"""`bulkcal post`: measure a case again, or somebody else's output."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from calibrate.cli.arguments import ApparatusPairs, AsJson, Quiet, Verbose
from calibrate.cli.output.options import (
    ALL,
    PLANES,
    AngleFlag,
    BoxWords,
    ColumnWords,
    CountFlag,
    Density,
    Diameter,
    DumpName,
    FramesWord,
    MassFlag,
    MeasuredFolder,
    OutFile,
    PlaneName,
    Request,
    SlopeFlag,
    SlowerThan,
    ThermoFlag,
    TimeStep,
    UnitsName,
)
from calibrate.cli.pairs import numbers_of
from calibrate.cli.plans.case import plan_of_run
from calibrate.cli.show.observables import show_result
from calibrate.cli.show.output import Screen
from calibrate.cli.show.waiting import Waiting
from calibrate.errors import CalibrationError
from liggghts_io import load_spec, post_case
from liggghts_io.case.directory import RECORD

__all__ = ["post"]


def post(
    directory: Annotated[
        Path,
        typer.Argument(metavar="DIR", help="Case directory, or any folder or file of dumps."),
    ],
    angle: AngleFlag = False,
    slope: SlopeFlag = False,
    column: ColumnWords = [],  # noqa: B006 - typer copies it
    count: CountFlag = False,
    mass: MassFlag = False,
    box: BoxWords = [],  # noqa: B006
    slower_than: SlowerThan = None,
    frames: FramesWord = ALL,
    plane: PlaneName = PLANES[0],
    dump: DumpName = "",
    thermo: ThermoFlag = False,
    folder: MeasuredFolder = "",
    apparatus: ApparatusPairs = [],  # noqa: B006
    units: UnitsName = "",
    timestep: TimeStep = None,
    density: Density = None,
    diameter: Diameter = None,
    out: OutFile = None,
    quiet: Quiet = False,
    verbose: Verbose = False,
    as_json: AsJson = False,
) -> None:
    """Measure what an engine wrote: a case again, or the output of any LIGGGHTS run.

    Without options, a case gives its observables, and another folder tells what it holds: dumps
    (dump custom, custom/vtk, atom/vtk; compressed by gzip or not), columns, thermo tables. What is
    measured is a table with a row for each frame, in SI units.

    Example: bulkcal post heap_steel --json

    Example: bulkcal post my_run --angle --box z=0: --frames 0.8:1 --out angles.csv
    """
    from calibrate.cli.output.foreign import look_at
    from liggghts_io.foreign import Grains

    screen = Screen(quiet, verbose)
    request = Request(
        angle, slope, count, mass, thermo, column, box, plane, frames, dump, folder, units,
        slower_than, timestep, Grains(density, diameter), numbers_of("-a", apparatus), out,
    )  # fmt: skip
    if not directory.exists():
        msg = f"{directory}: no such directory; make a case with 'bulkcal generate ... --out DIR'"
        raise CalibrationError(msg)
    if request.asks or not (directory / RECORD).exists():
        look_at(directory, request, screen, as_json)
        return
    spec = load_spec(directory)
    if verbose:
        screen.details(plan_of_run(directory, spec.engine))
    with Waiting(screen.console, "measuring"):
        result = post_case(directory, screen.remark)
    show_result(result, spec, screen, as_json)
