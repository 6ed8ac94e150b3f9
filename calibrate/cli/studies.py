"""Commands for whole studies: calibrate, demo and diagnose.

What they do is imported late: smt, scipy and matplotlib cost seconds that `bulkcal --help` should
not.
"""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import typer

from calibrate.cli.arguments import (
    AsJson,
    DryRun,
    Quiet,
    Verbose,
    Workers,
    named_directory,
)
from calibrate.cli.ending import result_directory
from calibrate.cli.show.output import Screen, stdout
from calibrate.cli.show.waiting import Waiting
from calibrate.runs.stored import DIAGNOSIS, FIGURE, RECORD, REPORT
from calibrate.study.resources import bundled_study

if TYPE_CHECKING:
    from calibrate.study.data import StudyData

__all__ = ["calibrate_command", "demo", "diagnose"]

_LOADING: Final = "loading surrogates and figures"


def calibrate_command(
    study: Annotated[Path, typer.Argument(metavar="STUDY.toml", help="Study file.")],
    out: Annotated[
        str | None, typer.Option("--out", metavar="DIR", help="Default: the study's name.")
    ] = None,
    workers: Workers = 0,
    dry_run: DryRun = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
    as_json: AsJson = False,
) -> None:
    """Calibrate a study: runs, surrogates, parameters with intervals, check, report.

    Started again, it goes on where it was. Limits of a study: points 8 to 2000, repeats 0 to points
    and infill 0 to 200 in a stage, which frees two parameters for two targets or more; check_seeds
    2 to 50.

    Example: bulkcal calibrate cases/proppants/hsp13_steel.toml --out hsp13
    """
    target = study.stem if out is None else str(named_directory("--out", out))
    extra = f" --workers {workers}" if workers else ""
    command = f"bulkcal calibrate {study} --out {target}{extra}"
    screen = Screen(quiet, verbose)
    if dry_run:
        _plan(study, target, workers, screen, as_json)
        return
    _finish(study, target, command, workers, screen, as_json)


def demo(
    out: Annotated[str, typer.Option("--out", metavar="DIR", help="Where to work.")] = "demo",
    workers: Workers = 0,
    dry_run: DryRun = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
    as_json: AsJson = False,
) -> None:
    """Calibrate the bundled study, Carbo HSP13 on steel, within some minutes.

    Interrupted and started again, it goes on where it was.

    Example: bulkcal demo
    """
    screen = Screen(quiet, verbose)
    named_directory("--out", out)
    if dry_run:
        _plan(bundled_study(), out, workers, screen, as_json)
        return
    _finish(bundled_study(), out, f"bulkcal demo --out {out}", workers, screen, as_json)


def _plan(study: Path, out: str, workers: int, screen: Screen, as_json: bool) -> None:
    data = _read(study, screen)
    with Waiting(screen.console, _LOADING) as wait:
        from calibrate.cli.study_plans import plan_of_study

        wait.tell("reading what is stored")
        facts = plan_of_study(data, Path(out), _processes(data, workers))
    screen.plan(facts, as_json)


def _processes(data: StudyData, workers: int) -> int:
    """Return how many processes will run."""
    return _asked(data, workers) or os.cpu_count() or 1


def _asked(data: StudyData, workers: int) -> int:
    """Return the processes that the command or the study asks for, 0 for one per core."""
    return workers or data.study.run.workers


def _read(study: Path, screen: Screen) -> StudyData:
    """Read a study and its data."""
    with Waiting(screen.console, f"reading {study}"):
        from calibrate.study.data import load_data

        return load_data(study)


def _finish(
    study: Path, out: str, command: str, workers: int, screen: Screen, as_json: bool
) -> None:
    started = time.monotonic()
    data = _read(study, screen)
    target = Path(out)
    result_directory(target)
    with Waiting(screen.console, _LOADING):
        from calibrate.cli.calibrate_study import calibrate_study
        from calibrate.cli.study_plans import heading
        from calibrate.report.tables import result_tables
    if screen.verbose:
        screen.details(heading(data, target, _processes(data, workers)))
    result = calibrate_study(data, target, command, _asked(data, workers), console=screen.console)
    if as_json:
        screen.result((target / RECORD).read_text(encoding="utf-8").rstrip())
        return
    for shown in result_tables(result):
        screen.table(shown)
    for stage in result.stages:
        for sentence in result.sentences(stage):
            screen.result(f"{stage.stage.title}: {sentence}")
    minutes = (time.monotonic() - started) / 60.0
    cost = f"{len(result.runs)} runs, {minutes:.1f} min this time"
    screen.hint(f"report: {target / REPORT}   ({cost})")
    screen.hint(
        f"next: open {target / REPORT}, or look for what the model misses: bulkcal diagnose {study}"
    )


def diagnose(
    study: Annotated[Path, typer.Argument(metavar="STUDY.toml", help="Study file.")],
    out: Annotated[
        str | None,
        typer.Option("--out", metavar="DIR", help="Directory of its calibration; default: name."),
    ] = None,
    start: Annotated[
        Path | None,
        typer.Option("--start", metavar="JSON", help="Start from this record; no calibration."),
    ] = None,
    workers: Workers = 0,
    dry_run: DryRun = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
    as_json: AsJson = False,
) -> None:
    """Say what the calibrated simulation still gets wrong and which cause fits.

    Calibrates first if that has not been done. Finished runs are reused; missing ones are
    announced with their cost.

    Example: bulkcal diagnose cases/proppants/hsp13_steel.toml --out hsp13
    """
    screen = Screen(quiet, verbose)
    target = Path(study.stem) if out is None else named_directory("--out", out)
    data = _read(study, screen)
    if dry_run:
        with Waiting(screen.console, _LOADING) as wait:
            from calibrate.cli.study_plans import plan_of_diagnosis

            wait.tell("reading what is stored")
            facts = plan_of_diagnosis(data, target, _processes(data, workers), start)
        screen.plan(facts, as_json)
        return
    result_directory(target)
    with Waiting(screen.console, _LOADING):
        from calibrate.cli.diagnose_study import diagnose_study
        from calibrate.cli.study_plans import heading
        from calibrate.report.record import as_data
        from calibrate.report.tables import show_diagnosis
    if verbose:
        screen.details(heading(data, target, _processes(data, workers)))
    command = f"bulkcal diagnose {study} --out {target}"
    found = diagnose_study(
        data,
        target,
        command,
        start=start,
        workers=_asked(data, workers),
        console=screen.console,
    )
    if as_json:
        screen.json(as_data(found))
        return
    show_diagnosis(found, stdout())
    screen.hint(f"figure: {target / FIGURE}, record: {target / DIAGNOSIS}")
