"""Calibrate a study into a directory: cases, table of runs, record and report."""

from __future__ import annotations

import os
from pathlib import Path

from rich.console import Console

from calibrate.cli.progress import StudyBar, planned_runs
from calibrate.cli.waiting import Waiting
from calibrate.errors import CalibrationError
from calibrate.report.page import write_report
from calibrate.report.record import write_calibration
from calibrate.report.tables import stage_line
from calibrate.runs.campaign import Campaign
from calibrate.runs.stored import RECORD, REPORT, RUNS, TABLE, stored_case
from calibrate.staged.calibration import Calibration, calibrate
from calibrate.study.data import StudyData
from liggghts_io import execute, render_case

__all__ = ["calibrate_study"]


def calibrate_study(
    data: StudyData, out: Path, command: str, workers: int = 0, *, console: Console | None = None
) -> Calibration:
    """Calibrate a study into a directory: cases, table of runs, record and report.

    Parameters
    ----------
    data : StudyData
        The study and what was measured.
    out : Path
        Directory of the result; what it holds already is continued, nothing is deleted.
    command : str
        Command that continues this work, shown on Ctrl-C and noted in the report.
    workers : int
        Processes, 0 for one per core.
    console : Console, optional
        Where progress and remarks go, stderr by default.

    Raises
    ------
    CalibrationError, liggghts_io.CaseError
        For mistakes in the study or its data.
    """
    study = data.study
    if out.exists() and not out.is_dir():
        msg = f"--out {out}: is a file; name a directory"
        raise CalibrationError(msg)
    out.mkdir(parents=True, exist_ok=True)
    console = console or Console(stderr=True)
    console.print(
        f"{study.title}: {planned_runs(study)} runs at scale '{study.scale}' on "
        f"{workers or os.cpu_count()} processes; finished runs in {out / RUNS} are reused",
        highlight=False, markup=False, soft_wrap=True,
    )  # fmt: skip
    try:
        with (
            StudyBar(study, console) as bar,
            Campaign(
                out / RUNS, execute, stored=stored_case, workers=workers, progress=bar
            ) as campaign,
        ):
            result = calibrate(data, campaign, lambda stage: bar.say(stage_line(stage)))
    except KeyboardInterrupt:
        console.print(
            f"\nstopped; finished runs are kept. Continue with: {command}",
            markup=False,
            soft_wrap=True,
        )
        raise
    result.runs.to_csv(out / TABLE, index=False)
    write_calibration(result, out / RECORD, command)
    with Waiting(console, "writing the report, with a picture of every experiment"):
        write_report(result, out / REPORT, command=command, render=render_case)
    return result
