"""Run cases, and keep them as a table: what the programs here share."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from calibrate.cli.running import running
from calibrate.cli.show.progress import RunsBar
from calibrate.runs.executors.run_options import RunOptions
from calibrate.runs.stored import RUNS
from calibrate.runs.table import finished_rows, write_rows
from liggghts_io import CaseSpec


def words_of(about: str | None) -> argparse.ArgumentParser:
    """Return the words that all of them know."""
    words = argparse.ArgumentParser(
        description=about, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    words.add_argument("out", type=Path, help="table that is written")
    words.add_argument("--of", nargs="+", type=Path, required=True, help="tables of runs")
    words.add_argument("--folder", type=Path, required=True, help="where the runs lie meanwhile")
    words.add_argument("--workers", type=int, default=0)
    return words


def make_table(specs: Sequence[CaseSpec], asked: argparse.Namespace, command: str) -> None:
    """Run cases and write the table; what the folder has already is not run again."""
    asked.folder.mkdir(parents=True, exist_ok=True)
    bar = RunsBar("runs", Console(stderr=True))
    with running(asked.folder, RunOptions(workers=asked.workers), bar) as campaign:
        campaign(specs, "runs")
    made = finished_rows(asked.folder / RUNS)
    write_rows(asked.out, made, command)
    print(f"{asked.out}: {len(made)} of {len(specs)} runs")
