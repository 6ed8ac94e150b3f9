"""The command `runs`: keep what the runs of a directory gave, as a table."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from calibrate.cli.show.output import Screen
from calibrate.cli.show.waiting import Waiting
from calibrate.errors import CalibrationError
from calibrate.runs.stored import RUNS
from liggghts_io.files import shell_word

__all__ = ["runs"]


def runs(
    directory: Annotated[
        Path, typer.Argument(metavar="DIR", help="Directory of a calibration, or of cases.")
    ],
    table: Annotated[Path, typer.Argument(metavar="TABLE", help="File to write, .csv or .csv.gz.")],
) -> None:
    """Keep the runs of a directory as a table: inputs, seeds, numbers, digests, no output.

    'bulkcal calibrate STUDY.toml --runs TABLE' fits to it in seconds, on any machine.

    Example: bulkcal runs hsp13 hsp13_runs.csv.gz
    """
    from calibrate.runs.table import finished_rows, is_table, write_rows

    if not directory.is_dir():
        msg = f"{directory}: no such directory; name the --out of a calibration"
        raise CalibrationError(msg)
    if not table.name.endswith((".csv", ".csv.gz")):
        msg = f"TABLE {table}: name a file that ends in .csv or .csv.gz"
        raise CalibrationError(msg)
    if table.exists() and not is_table(table):
        msg = f"TABLE {table}: is no table of runs and is not written over; name another file"
        raise CalibrationError(msg)
    screen = Screen()
    root = directory / RUNS if (directory / RUNS).is_dir() else directory
    with Waiting(screen.console, f"reading {root}"):
        rows = finished_rows(root)
    if not rows:
        command = f"bulkcal status {shell_word(directory)}"
        msg = f"{root}: holds no finished run; '{command}' says what is there"
        raise CalibrationError(msg)
    count = write_rows(
        table, rows, f"bulkcal runs {shell_word(directory.name)} {shell_word(table.name)}"
    )
    screen.result(f"{table}: {count} runs, {table.stat().st_size / 1000:.0f} kB")
    screen.hint(f"next: bulkcal calibrate STUDY.toml --runs {shell_word(table)}")
