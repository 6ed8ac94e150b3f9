"""Calibrate a study into a directory: cases, table of runs, record and report."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console
from threadpoolctl import threadpool_limits

from calibrate.cli.ending import result_directory, said_how_to_continue
from calibrate.cli.kept import kept_in
from calibrate.cli.running import running
from calibrate.cli.show.progress import StudyBar, planned_runs
from calibrate.cli.show.streams import Terminal
from calibrate.cli.show.waiting import Waiting
from calibrate.report.gallery import Drawings
from calibrate.report.page import write_report
from calibrate.report.record import write_calibration
from calibrate.report.tables import stage_line
from calibrate.runs.executors.run_options import RunOptions
from calibrate.runs.failures import failure_lines
from calibrate.runs.others import older_runs
from calibrate.runs.stored import RECORD, REPORT, RUNS, TABLE
from calibrate.staged.calibration import Calibration, calibrate
from calibrate.study.data import StudyData
from liggghts_io import render_case, scene_of_case
from liggghts_io.files import write_text

__all__ = ["calibrate_study"]

_HERE = RunOptions()


def calibrate_study(
    data: StudyData,
    out: Path,
    command: str,
    how: RunOptions = _HERE,
    *,
    console: Console | None = None,
) -> Calibration:
    """Calibrate a study into a directory: cases, table of runs, record and report.

    Parameters
    ----------
    data : StudyData
        The study and what was measured.
    out : Path
        Directory of the result; what it holds already is continued, nothing is deleted. Joint
        part and further sections of a report on the same study file and data stay.
    command : str
        Command that continues this work, shown on Ctrl-C and noted in the report.
    how : RunOptions
        What runs the cases, how many at once and for how long.
    console : Console, optional
        Where progress and remarks go, stderr by default.

    Raises
    ------
    CalibrationError, liggghts_io.CaseError
        For mistakes in the study or its data, and for a full or read-only disk.
    BugError
        For a fault of this program.
    """
    study = data.study
    result_directory(out)
    console = console or Terminal(stderr=True)

    def say(line: str) -> None:
        console.print(line, highlight=False, markup=False, soft_wrap=True)

    say(
        f"{study.title}: {planned_runs(study)} runs at scale '{study.run.scale}' on "
        f"{how.place}; finished runs in {out / RUNS} are reused"
    )
    if older := older_runs(out / RUNS):
        say(older)
    with said_how_to_continue(out, command, say):
        bar = StudyBar(study, console)
        # Matrices are small and many: threads of the linear algebra only get in the way.
        with running(out, how, bar) as campaign, threadpool_limits(limits=1):
            result = calibrate(data, campaign, lambda stage: bar.say(stage_line(stage)))
        _write(result, out, command, console)
    for line in failure_lines(result.runs):
        say(line)
    return result


def _write(result: Calibration, out: Path, command: str, console: Console) -> None:
    """Write table of runs, record and report; what a joint calibration left stays."""
    kept = kept_in(out, result.data.sha256)
    table = kept.with_runs_of_joint(result.runs.drop(columns="log_tail"))
    write_text(out / TABLE, table.to_csv(index=False))
    write_calibration(result, out / RECORD, command)
    with Waiting(console, "writing the report, with a picture of every experiment"):
        drawings = Drawings(render_case, scene_of_case)
        write_report(result, out / REPORT, command=command, drawings=drawings)
        kept.put_sections_back()
