"""A sensitivity study into a directory: runs, record, page."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console
from threadpoolctl import threadpool_limits

from calibrate.cli.ending import result_directory, said_how_to_continue
from calibrate.cli.running import running
from calibrate.cli.show.progress import RunsBar
from calibrate.cli.show.streams import Terminal
from calibrate.cli.show.waiting import Waiting
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.stored import stored_runs
from calibrate.questions.sensitivity.result import SensitivityResult
from calibrate.questions.sensitivity.study import Asked, plan_of, result_of
from calibrate.report.sensitivity.page import write_sensitivity
from calibrate.runs.executors.run_options import RunOptions
from calibrate.runs.failures import failure_lines
from calibrate.runs.stored import RUNS
from calibrate.study.data import StudyData

__all__ = ["study_sensitivity"]

_HERE = RunOptions()
_ALL = Asked()


def study_sensitivity(
    data: StudyData,
    out: Path,
    command: str,
    how: RunOptions = _HERE,
    *,
    asked: Asked = _ALL,
    console: Console | None = None,
) -> SensitivityResult:
    """Say what moves what, from runs in a directory.

    Runs of a calibration that are there are used for the Sobol indices, and a later calibration
    uses those that are made here.

    Parameters
    ----------
    data : StudyData
        The study and what was measured.
    out : Path
        Directory of its results; what it holds already is continued, nothing is deleted.
    command : str
        Command that continues this work.
    how : RunOptions
        What runs the cases, how many at once and for how long.
    asked : Asked
    console : Console, optional
        Where progress and remarks go, stderr by default.

    Raises
    ------
    CalibrationError, liggghts_io.CaseError
        For a baseline that cannot be used, and for a full or read-only disk.
    BugError
        For a fault of this program.
    """
    plan = plan_of(data, asked, alone=not (out / RUNS).is_dir())
    result_directory(out)
    console = console or Terminal(stderr=True)
    bar = RunsBar("sensitivity", console)
    with said_how_to_continue(out, command, bar.say):
        with running(out, how, bar) as campaign:
            table = campaign(plan.specs, "Sensitivity")
        with Waiting(console, "looking through the runs that are there") as wait:
            stored = stored_runs(data, forms_of(data), out / RUNS) if plan.design else None
            wait.tell("indices from emulators, and their errors")
            # Matrices are small: threads of the linear algebra only get in each other's way.
            with threadpool_limits(limits=1):
                found = result_of(plan, table, stored)
            wait.tell("writing the page")
            write_sensitivity(found, out, command)
    for line in failure_lines(table):
        bar.say(line)
    return found
