"""Commands for whole studies: calibrate and demo."""

from __future__ import annotations

import json
import os
import sys
import time
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from calibrate.calibration import Calibration, calibrate, write_record
from calibrate.campaign import Campaign
from calibrate.cli_cases import AsJson, say
from calibrate.errors import CalibrationError
from calibrate.resources import bundled_study
from calibrate.screen import StudyBar, planned_runs, result_tables
from calibrate.study import load_study
from liggghts_io import CaseError, CaseResult, CaseSpec, case_id, execute, load_result

__all__ = ["calibrate_command", "demo", "run_study", "stored_case"]

RUNS = "runs"
REPORT = "report.html"
RECORD = "calibration.json"

Workers = Annotated[int, typer.Option(help="Processes; 0: one per core.")]


def stored_case(spec: CaseSpec, root: Path) -> CaseResult | None:
    """Return the stored result of a case under `root`, or None when it has to run."""
    try:
        return load_result(root / case_id(spec))
    except CaseError:
        return None


def run_study(study_path: Path, out: Path, command: str, workers: int = 0) -> Calibration:
    """Calibrate a study into a directory: cases, table of runs, record and report.

    Parameters
    ----------
    study_path : Path
        Study file.
    out : Path
        Directory of the result; what it holds already is continued, nothing is deleted.
    command : str
        Command that continues this work, shown on Ctrl-C and noted in the report.
    workers : int
        Processes, 0 for one per core.

    Raises
    ------
    CalibrationError, liggghts_io.CaseError
        For mistakes in the study or its data.
    """
    from calibrate.report import write_report  # matplotlib takes a second to import
    from liggghts_io import render_case

    study = load_study(study_path)
    if out.exists() and not out.is_dir():
        msg = f"--out {out}: is a file; name a directory"
        raise CalibrationError(msg)
    out.mkdir(parents=True, exist_ok=True)
    console = Console(stderr=True)
    console.print(
        f"{study.title}: {planned_runs(study)} runs at scale '{study.scale}' on "
        f"{workers or os.cpu_count()} processes; finished runs in {out / RUNS} are reused",
        highlight=False, markup=False,
    )  # fmt: skip
    try:
        with (
            StudyBar(study, console) as bar,
            Campaign(
                out / RUNS, execute, stored=stored_case, workers=workers, progress=bar
            ) as campaign,
        ):
            result = calibrate(study_path, campaign, bar.stage_done)
    except KeyboardInterrupt:
        console.print(f"\nstopped; finished runs are kept. Continue with: {command}", markup=False)
        raise
    result.runs.to_csv(out / "runs.csv", index=False)
    write_record(result, out / RECORD, command)
    write_report(result, out / REPORT, command=command, render=render_case)
    return result


def calibrate_command(
    study: Annotated[Path, typer.Argument(metavar="STUDY.toml", help="Study file.")],
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Default: the study's name.")
    ] = None,
    workers: Workers = 0,
    as_json: AsJson = False,
) -> None:
    """Calibrate a study: runs, surrogates, parameters with intervals, check, report.

    Started again, it goes on where it was.

    Example: bulkcal calibrate cases/proppants/hsp13_steel.toml --out hsp13
    """
    target = out or Path(study.stem)
    extra = f" --workers {workers}" if workers else ""
    _finish(study, target, f"bulkcal calibrate {study} --out {target}{extra}", workers, as_json)


def demo(
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Where to work.")] = Path(
        "demo"
    ),
    workers: Workers = 0,
    as_json: AsJson = False,
) -> None:
    """Calibrate the bundled study, Carbo HSP13 on steel, within some minutes.

    Interrupted and started again, it goes on where it was.

    Example: bulkcal demo
    """
    _finish(bundled_study(), out, f"bulkcal demo --out {out}", workers, as_json)


def _finish(study: Path, out: Path, command: str, workers: int, as_json: bool) -> None:
    started = time.monotonic()
    result = run_study(study, out, command, workers)
    if as_json:
        say(json.dumps(json.loads((out / RECORD).read_text(encoding="utf-8")), indent=1))
        return
    console = Console(file=sys.stdout)
    for table in result_tables(result):
        console.print(table)
    for stage in result.stages:
        for sentence in stage.verdict.sentences:
            say(f"{stage.stage.title}: {sentence}")
    minutes = (time.monotonic() - started) / 60.0
    say(f"report: {out / REPORT}   ({len(result.runs)} runs, {minutes:.1f} min this time)")
    say(f"next: open {out / REPORT}, or look for what the model misses: bulkcal diagnose {study}")
