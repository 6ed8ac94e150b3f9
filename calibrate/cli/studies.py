"""Commands for whole studies: calibrate, demo and diagnose.

What they do is imported late: smt, scipy and matplotlib cost seconds that `bulkcal --help` should
not.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import typer
from rich.table import Table

from calibrate.cli.arguments import (
    BOTH,
    JOINT,
    MODES,
    STAGED,
    AsJson,
    DryRun,
    ExecutorName,
    ExecutorPairs,
    ModeName,
    More,
    Quiet,
    RunTable,
    TimeLimit,
    Twins,
    Verbose,
    Workers,
    named_directory,
    one_of,
)
from calibrate.cli.ending import result_directory
from calibrate.cli.pairs import pairs_of
from calibrate.cli.show.output import Screen
from calibrate.cli.show.waiting import Waiting
from calibrate.errors import CalibrationError
from calibrate.executor_names import LOCAL
from calibrate.runs.executors.run_options import RunOptions
from calibrate.runs.stored import DIAGNOSIS, FIGURE, RECORD, REPORT
from calibrate.study.resources import bundled_study
from liggghts_io.files import shell_word

if TYPE_CHECKING:
    from calibrate.staged.calibration import Calibration
    from calibrate.study.data import StudyData

__all__ = ["calibrate_command", "demo", "diagnose"]

_LOADING: Final = "loading surrogates and figures"


def calibrate_command(
    study: Annotated[Path, typer.Argument(metavar="STUDY.toml", help="Study file.")],
    out: Annotated[
        str | None, typer.Option("--out", metavar="DIR", help="Default: the study's name.")
    ] = None,
    mode: ModeName = "",
    runs: RunTable = None,
    workers: Workers = 0,
    executor: ExecutorName = LOCAL,
    executor_option: ExecutorPairs = [],  # noqa: B006 - typer copies it
    time_limit: TimeLimit = None,
    dry_run: DryRun = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
    as_json: AsJson = False,
) -> None:
    """Calibrate a study: runs, emulators, values with intervals, check by the engine, report.

    By stages as in the paper, or jointly: all unknowns from all targets at once, with runs where
    the answer is uncertain until more of them would not change it or [design] runs are spent. Both
    share their runs. Started again, it goes on where it was. Limits of a study: points 8 to 2000,
    repeats 0 to points and infill 0 to 200 in a stage, which frees at most as many parameters as
    it has measured numbers; check_seeds 2 to 50.

    Example: bulkcal calibrate cases/proppants/hsp13_steel.toml --out hsp13
    """
    target = study.stem if out is None else str(named_directory("--out", out))
    how = _run_options(workers, executor, executor_option, time_limit)
    chosen = f" --mode {one_of('--mode', mode, MODES)}" if mode else ""
    command = f"bulkcal calibrate {shell_word(study)} --out {shell_word(target)}{chosen}{how.words}"
    screen = Screen(quiet, verbose)
    if runs is not None:
        mode = _mode_with_table(mode)
        command += f" --runs {shell_word(runs)}"
    if dry_run:
        _plan(study, target, mode, how, screen, as_json)
        return
    _finish(study, target, command, mode, how, screen, as_json, runs)


def demo(
    out: Annotated[str, typer.Option("--out", metavar="DIR", help="Where to work.")] = "demo",
    workers: Workers = 0,
    executor: ExecutorName = LOCAL,
    executor_option: ExecutorPairs = [],  # noqa: B006 - typer copies it
    time_limit: TimeLimit = None,
    dry_run: DryRun = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
    as_json: AsJson = False,
) -> None:
    """Calibrate the bundled study, Carbo HSP13 on steel, by stages and jointly, within minutes.

    Interrupted and started again, it goes on where it was.

    Example: bulkcal demo
    """
    screen = Screen(quiet, verbose)
    how = _run_options(workers, executor, executor_option, time_limit)
    named_directory("--out", out)
    if dry_run:
        _plan(bundled_study(), out, "", how, screen, as_json)
        return
    command = f"bulkcal demo --out {shell_word(out)}{how.words}"
    _finish(bundled_study(), out, command, "", how, screen, as_json)


def _mode_with_table(mode: str) -> str:
    """Return the mode of a fit to stored runs; stages decide themselves what they run."""
    if mode in (STAGED, BOTH):
        msg = f"--mode {mode}: stages make their own runs; with --runs use --mode {JOINT}"
        raise CalibrationError(msg)
    return JOINT


def _run_options(
    workers: int, executor: str, options: list[str], limit_s: float | None
) -> RunOptions:
    """Return how the runs are made; refuse what is unknown before anything is read."""
    return RunOptions(workers, executor, pairs_of("--executor-option", options), limit_s)


def _with_study(how: RunOptions, data: StudyData) -> RunOptions:
    """Return how the runs are made: what the command leaves open, the study says."""
    run = data.study.run
    return how.filled(RunOptions(run.workers, run.executor, limit_s=run.time_limit_s))


def _plan(study: Path, out: str, mode: str, how: RunOptions, screen: Screen, as_json: bool) -> None:
    data = _read(study, screen)
    with Waiting(screen.console, _LOADING) as wait:
        from calibrate.cli.plans.study import plan_of_study

        wait.tell("reading what is stored")
        facts = plan_of_study(data, Path(out), _with_study(how, data), _mode_of(mode, data))
    screen.plan(facts, as_json)


def _mode_of(mode: str, data: StudyData) -> str:
    """Return the mode that was asked for, or the study's own; refuse stages that are not there."""
    if mode in (STAGED, BOTH) and not data.study.stages:
        msg = f"--mode {mode}: {data.path} has no [[stage]]; use --mode {JOINT}, or describe stages"
        raise CalibrationError(msg)
    return mode or (BOTH if data.study.stages else JOINT)


def _read(study: Path, screen: Screen) -> StudyData:
    """Read a study and its data."""
    with Waiting(screen.console, f"reading {study}"):
        from calibrate.study.data import load_data

        return load_data(study)


def _finish(
    study: Path, out: str, command: str, mode: str, how: RunOptions, screen: Screen, as_json: bool,
    table: Path | None = None,
) -> None:  # fmt: skip
    started = time.monotonic()
    data = _read(study, screen)
    how = _with_study(how, data)
    mode = _mode_of(mode, data)
    target = Path(out)
    with Waiting(screen.console, _LOADING):
        from calibrate.cli.calibrate_study import calibrate_study
        from calibrate.cli.joint.study import calibrate_jointly_into, fit_jointly_into
        from calibrate.cli.plans.study import heading
        from calibrate.report.diagnosis.section import keep_diagnosis
        from calibrate.report.joint.tables import joint_tables
        from calibrate.report.tables import result_tables
    if screen.verbose:
        screen.details(heading(data, target, how))
    console = screen.console
    staged = joint = None
    if mode != JOINT:
        staged = calibrate_study(data, target, command, how, console=console)
    if table is not None:
        joint = fit_jointly_into(data, table, target, command, console=console)
    elif mode != STAGED:
        after = staged is not None
        joint = calibrate_jointly_into(
            data, target, command, how, after_stages=after, console=console
        )
    keep_diagnosis(target, data.sha256)
    if as_json:
        screen.result((target / RECORD).read_text(encoding="utf-8").rstrip())
        return
    names: set[str] = set()
    if staged is not None:
        names |= set(staged.runs["case_id"])
        _show(screen, result_tables(staged), _stage_sentences(staged))
    if joint is not None:
        names |= set(joint.runs.table["case_id"])
        _show(screen, joint_tables(joint), joint.sentences)
    minutes, place = (time.monotonic() - started) / 60.0, shell_word(target)
    screen.hint(f"report: {target / REPORT}   ({len(names)} runs, {minutes:.1f} min this time)")
    screen.hint(
        f"next: open {target / REPORT}, write the values for a script: bulkcal export {place}, or "
        f"look for what the model misses: bulkcal diagnose {shell_word(study)} --out {place}"
    )


def _stage_sentences(staged: Calibration) -> list[str]:
    return [
        f"{stage.stage.title}: {sentence}"
        for stage in staged.stages
        for sentence in staged.sentences(stage)
    ]


def _show(screen: Screen, tables: Sequence[Table], sentences: Sequence[str]) -> None:
    """Print the result of one mode."""
    for shown in tables:
        screen.table(shown)
    for sentence in sentences:
        screen.result(sentence)


def diagnose(
    study: Annotated[Path, typer.Argument(metavar="STUDY.toml", help="Study file.")],
    out: Annotated[
        str | None,
        typer.Option("--out", metavar="DIR", help="Directory of its calibration; default: name."),
    ] = None,
    twins: Twins = None,
    more: More = None,
    workers: Workers = 0,
    executor: ExecutorName = LOCAL,
    executor_option: ExecutorPairs = [],  # noqa: B006 - typer copies it
    time_limit: TimeLimit = None,
    dry_run: DryRun = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
    as_json: AsJson = False,
) -> None:
    """Say what the calibrated simulation still gets wrong and which cause fits.

    Starts from the joint calibration of the directory and makes it first where it is not there.
    Runs of the calibration are repeated with one effect on each, a few at first; probabilities
    of all causes, what the data could show, residuals, a check by the engine and an extended
    study follow. Where the evidence of a leading cause is uncertain, runs are added. Started
    again, it goes on where it was.

    Example: bulkcal diagnose cases/proppants/hsp13_steel.toml --out hsp13
    """
    screen = Screen(quiet, verbose)
    how = _run_options(workers, executor, executor_option, time_limit)
    target = Path(study.stem) if out is None else named_directory("--out", out)
    data = _read(study, screen)
    how = _with_study(how, data)
    if dry_run:
        with Waiting(screen.console, _LOADING) as wait:
            from calibrate.cli.plans.diagnosis import plan_of_diagnosis

            wait.tell("reading what is stored")
            facts = plan_of_diagnosis(data, target, how, twins, more)
        screen.plan(facts, as_json)
        return
    result_directory(target)
    with Waiting(screen.console, _LOADING):
        from calibrate.cli.diagnose_study import diagnose_study
        from calibrate.cli.plans.study import heading
    if verbose:
        screen.details(heading(data, target, how))
    asked = (f" --twins {twins}" if twins else "") + ("" if more is None else f" --more {more}")
    command = f"bulkcal diagnose {shell_word(study)} --out {shell_word(target)}{asked}{how.words}"
    diagnose_study(data, target, command, how, twins=twins, more=more, console=screen.console)
    _show_diagnosis(target, screen, as_json)


def _show_diagnosis(out: Path, screen: Screen, as_json: bool) -> None:
    """Print what a diagnosis found, from its record."""
    from calibrate.report.diagnosis.tables import diagnosis_tables
    from calibrate.report.record_file import read_record

    if as_json:
        screen.result((out / DIAGNOSIS).read_text(encoding="utf-8").rstrip())
        return
    record = read_record(out / DIAGNOSIS)
    _show(screen, diagnosis_tables(record), record["sentences"])
    screen.hint(f"report: {out / REPORT}, figure: {out / FIGURE}")
    if record["next"]:
        screen.hint(f"next: {record['next']}")
