"""What the verbs of a study share: reading it, how its runs are made, showing what came out."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from rich.table import Table

from calibrate.cli.pairs import pairs_of
from calibrate.cli.show.output import Screen
from calibrate.cli.show.waiting import Waiting
from calibrate.runs.executors.run_options import RunOptions

if TYPE_CHECKING:
    from calibrate.study.data import StudyData

__all__ = ["LOADING", "read_data", "remark_unheeded", "run_options", "show_result", "with_study"]

LOADING: Final = "loading surrogates and figures"


def run_options(
    workers: int, executor: str, options: list[str], limit_s: float | None
) -> RunOptions:
    """Return how the runs are made; refuse what is unknown before anything is read."""
    return RunOptions(workers, executor, pairs_of("--executor-option", options), limit_s)


def with_study(how: RunOptions, data: StudyData) -> RunOptions:
    """Return how the runs are made: what the command leaves open, the study says."""
    run = data.study.run
    return how.filled(RunOptions(run.workers, run.executor, limit_s=run.time_limit_s))


def read_data(study: Path, screen: Screen) -> StudyData:
    """Read a study and its data."""
    with Waiting(screen.console, f"reading {study}"):
        from calibrate.study.data import load_data

        data = load_data(study)
    for line in data.doubts:
        screen.remark(f"{study}: {line}")
    return data


def remark_unheeded(data: StudyData, screen: Screen) -> None:
    """Say what was measured and a calibration does not use."""
    from calibrate.study.checks.known import unheeded

    for line in unheeded(data.study):
        screen.remark(f"{data.path}: {line}")


def show_result(screen: Screen, tables: Sequence[Table], sentences: Sequence[str]) -> None:
    """Print the result of one mode."""
    for shown in tables:
        screen.table(shown)
    for sentence in sentences:
        screen.result(sentence)
