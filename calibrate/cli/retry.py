"""The command `retry`: let stored failures run again."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from calibrate.cli.arguments import AsJson, names_of, one_of
from calibrate.cli.output import say, say_json
from calibrate.errors import CalibrationError
from calibrate.runs.stored import RUNS
from liggghts_io import Failure, set_aside

__all__ = ["retry"]

CLASSES = [str(one) for one in Failure if one != Failure.MISTAKE]
"""Classes that a stored failure can have; a mistake is refused before anything is stored."""


def retry(
    directory: Annotated[
        Path, typer.Argument(metavar="DIR", help="Directory of a calibration, or of one case.")
    ],
    failure: Annotated[
        str, typer.Option("--class", help=f"Only failures of this class: {names_of(CLASSES)}.")
    ] = "",
    as_json: AsJson = False,
) -> None:
    """Let failed runs run again the next time; their records are kept beside them.

    Runs that were killed, ran out of time or of disk are tried again anyway.

    Example: bulkcal retry hsp13 --class physics
    """
    if failure:
        one_of("--class", failure, CLASSES)
    if not directory.is_dir():
        msg = f"{directory}: no such directory; name the --out of a calibration, or a case"
        raise CalibrationError(msg)
    runs = directory / RUNS
    set_aside_runs = set_aside(runs if runs.is_dir() else directory, failure)
    if as_json:
        say_json({"runs": [str(path) for path in set_aside_runs]})
        return
    what = f"failed runs of class {failure}" if failure else "failed runs"
    say(f"{len(set_aside_runs)} {what} will run again")
