"""The command `retry`: let stored failures run again."""

from __future__ import annotations

import json
import os
import shlex
from pathlib import Path
from typing import Annotated

import typer

from calibrate.cli.arguments import JOINT, AsJson, names_of, one_of
from calibrate.cli.show.output import Screen
from calibrate.errors import CalibrationError
from calibrate.report.record_file import FROM_HERE
from calibrate.runs.stored import RECORD, RUNS
from liggghts_io import Failure
from liggghts_io.files import shell_word

__all__ = ["retry"]

CLASSES = [str(one) for one in Failure if one != Failure.MISTAKE]
"""Classes that a stored failure can have; a mistake is refused before anything is stored."""


def retry(
    directory: Annotated[
        Path, typer.Argument(metavar="DIR", help="Directory of a calibration, or of one case.")
    ],
    failure: Annotated[
        str, typer.Option("--class", help=f"Only failures of one class: {names_of(CLASSES)}.")
    ] = "",
    as_json: AsJson = False,
) -> None:
    """Let failed runs run again the next time; what is known of them is kept in failed-N/.

    Runs that were killed or ran out of disk are tried again without this, and those that ran out
    of time with a longer --time-limit.

    Example: bulkcal retry hsp13 --class physics
    """
    from calibrate.runs.retry import set_aside  # numpy and more, which --help does not need

    if failure:
        one_of("--class", failure, CLASSES)
    if not directory.is_dir():
        msg = f"{directory}: no such directory; name the --out of a calibration, or a case"
        raise CalibrationError(msg)
    root = directory / RUNS
    screen = Screen()
    moved = set_aside(root if root.is_dir() else directory, failure)
    if as_json:
        screen.json({"runs": [str(path) for path in moved]})
        return
    of_class = f" of class {failure}" if failure else ""
    screen.result(
        f"{len(moved)} failed {'run' if len(moved) == 1 else 'runs'}{of_class} will run again"
    )
    if moved:
        screen.hint(f"next: {_next(directory, alone=moved == [directory])}")


def _next(directory: Path, *, alone: bool) -> str:
    """Return the command that runs what was set aside, also where the directory was moved."""
    if alone:
        return f"bulkcal run {shell_word(directory)}"
    try:
        record = json.loads((directory / RECORD).read_text(encoding="utf-8"))
        made = record.get("provenance") or record[JOINT]["provenance"]
        words = shlex.split(made["command"])
        words[words.index("--out") + 1] = str(directory)
        study = directory / record.get(FROM_HERE, "")
        if words[1] == "calibrate" and not Path(words[2]).is_file() and study.is_file():
            words[2] = os.path.normpath(study)
        # A path that begins with a minus sign has its folder before it in the command already.
        return " ".join(word if word.startswith("-") else shell_word(word) for word in words)
    except (OSError, ValueError, LookupError, TypeError, AttributeError):
        return f"the command that made {directory}, once more"
