"""The command `export`: what a calibration found, for a LIGGGHTS script or another program."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Final

import typer

from calibrate.cli import completion
from calibrate.cli.arguments import JOINT, STAGED, one_of
from calibrate.cli.show.output import Screen
from calibrate.errors import CalibrationError, unknown_name
from calibrate.runs.stored import RECORD
from liggghts_io.files import write_text

__all__ = ["export"]

FORMATS: Final = ("liggghts", "json", "csv")
PARTS: Final = (JOINT, STAGED)
DIGITS: Final = "%.8g"
"""Of numbers in CSV: more than any of them means."""


def export(
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="Directory of a calibration.")],
    form: Annotated[
        str,
        typer.Option(
            "--format", metavar="|".join(FORMATS), autocompletion=completion.offer(FORMATS),
            help="Lines of a LIGGGHTS script, the whole record, or the table of values.",
        ),
    ] = FORMATS[0],
    mode: Annotated[
        str,
        typer.Option(
            "--mode", metavar="|".join(PARTS), autocompletion=completion.offer(PARTS),
            help="Which result; default: joint where there is one.",
        ),
    ] = "",
    material: Annotated[
        str, typer.Option(help="Material of the lines, where the study has several.")
    ] = "",
    out: Annotated[
        Path | None, typer.Option("--out", metavar="FILE", help="Write there, not on the screen.")
    ] = None,
) -> None:  # fmt: skip
    """Write what a calibration found: property/global lines of LIGGGHTS, JSON or CSV.

    Comments tell intervals, what the study gave, and what the data do not determine.

    Example: bulkcal export hsp13 --out contact.in
    """
    one_of("--format", form, FORMATS)
    part = one_of("--mode", mode, PARTS) if mode else ""
    if out is not None and out.exists():
        msg = f"--out {out}: exists already; name another file, nothing is written over"
        raise CalibrationError(msg)
    from calibrate.report.record_file import of_this_version, outdated, read_record

    if not (directory / RECORD).is_file():
        msg = f"{directory}: holds no calibration; name the --out of a finished 'bulkcal calibrate'"
        raise CalibrationError(msg)
    record = read_record(directory / RECORD)
    found = part or (JOINT if JOINT in record else STAGED)
    if (JOINT if found == JOINT else "stages") not in record:
        msg = f"{directory}: holds no {found} result; run 'bulkcal calibrate STUDY --mode {found}'"
        raise CalibrationError(msg)
    with of_this_version(directory / RECORD):
        text = _text(record, found, form, material)
        doubt = outdated(directory / RECORD, record)
    screen = Screen()
    if doubt:
        screen.remark(doubt)
    if out is None:
        screen.result(text.rstrip())
        return
    write_text(out, text)
    screen.hint(f"wrote {out}")
    if form == FORMATS[0]:
        screen.hint(f"next: put 'include {out.name}' into your script, or these lines")


def _text(record: Mapping[str, Any], part: str, form: str, material: str) -> str:
    import json

    if form == "json":
        return json.dumps(record, indent=1) + "\n"
    if form == "csv":
        return _csv(_rows(record, part))
    from calibrate.questions.script_lines import script_from, script_lines

    scripts = record[JOINT]["scripts"] if part == JOINT else record.get("scripts", {})
    return script_lines(script_from(scripts[_material(list(scripts), material)]))


def _material(known: Sequence[str], asked: str) -> str:
    """Return the material whose lines are asked for."""
    if asked and asked not in known:
        msg = f"--material {asked}: {unknown_name(asked, known)}"
        raise CalibrationError(msg)
    if not asked and len(known) > 1:
        msg = f"the study has {len(known)} materials; add --material, one of {', '.join(known)}"
        raise CalibrationError(msg)
    if not known:
        msg = "the record holds no numbers of a script; run 'bulkcal calibrate' again"
        raise CalibrationError(msg)
    return asked or known[0]


def _rows(record: Mapping[str, Any], part: str) -> list[dict[str, Any]]:
    """Return a row per unknown."""
    if part == JOINT:
        return list(record[JOINT]["unknowns"])
    return [
        {
            "name": name,
            "best": value,
            **{
                f"{end}_{round(100 * float(level))}": interval[end]
                for level, interval in stage["intervals"][name].items()
                for end in ("low", "high", "open_low", "open_high")
            },
        }
        for stage in record["stages"]
        for name, value in stage["values"].items()
    ]


def _csv(rows: Sequence[Mapping[str, Any]]) -> str:
    import pandas as pd

    return str(pd.DataFrame(rows).to_csv(index=False, lineterminator="\n", float_format=DIGITS))
