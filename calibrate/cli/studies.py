"""Commands for whole studies: calibrate and demo.

What they do is imported late: smt, scipy and matplotlib cost seconds that `bulkcal --help` should
not.
"""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

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
    Quiet,
    RunTable,
    TimeLimit,
    Verbose,
    Workers,
    named_directory,
    one_of,
)
from calibrate.cli.show.output import Screen
from calibrate.cli.show.study import (
    LOADING,
    read_data,
    remark_unheeded,
    run_options,
    show_result,
    with_study,
)
from calibrate.cli.show.waiting import Waiting
from calibrate.errors import CalibrationError
from calibrate.executor_names import LOCAL
from calibrate.report.ours import default_out
from calibrate.runs.executors.run_options import RunOptions
from calibrate.runs.stored import DIAGNOSIS, RECORD, REPORT
from calibrate.study.resources import bundled_study
from liggghts_io.files import shell_word

if TYPE_CHECKING:
    from calibrate.staged.calibration import Calibration
    from calibrate.study.data import StudyData

__all__ = ["calibrate_command", "demo"]


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
    target = str(default_out(study) if out is None else named_directory("--out", out))
    how = run_options(workers, executor, executor_option, time_limit)
    chosen = f" --mode {one_of('--mode', mode, MODES)}" if mode else ""
    command = f"bulkcal calibrate {shell_word(study)} --out {shell_word(target)}{chosen}{how.words}"
    screen = Screen(quiet, verbose)
    if runs is not None:
        mode = _mode_with_table(mode)
        command += f" --runs {shell_word(runs)}"
    if dry_run:
        _plan(study, target, mode, how, screen, as_json, runs)
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
    how = run_options(workers, executor, executor_option, time_limit)
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


def _plan(
    study: Path, out: str, mode: str, how: RunOptions, screen: Screen, as_json: bool,
    table: Path | None = None,
) -> None:  # fmt: skip
    data = read_data(study, screen)
    with Waiting(screen.console, LOADING) as wait:
        from calibrate.cli.plans.study import plan_of_fit, plan_of_study

        wait.tell("reading what is stored")
        how = with_study(how, data)
        if table is not None:
            facts = plan_of_fit(data, Path(out), how, table)
        else:
            facts = plan_of_study(data, Path(out), how, _mode_of(mode, data))
    remark_unheeded(data, screen)
    screen.plan(facts, as_json)


def _mode_of(mode: str, data: StudyData) -> str:
    """Return the mode that was asked for, or the study's own; refuse stages that are not there."""
    if mode in (STAGED, BOTH) and not data.study.stages:
        msg = f"--mode {mode}: {data.path} has no [[stage]]; use --mode {JOINT}, or describe stages"
        raise CalibrationError(msg)
    return mode or (BOTH if data.study.stages else JOINT)


def _finish(
    study: Path, out: str, command: str, mode: str, how: RunOptions, screen: Screen, as_json: bool,
    table: Path | None = None,
) -> None:  # fmt: skip
    started = time.monotonic()
    data = read_data(study, screen)
    how = with_study(how, data)
    mode = _mode_of(mode, data)
    target = Path(out)
    with Waiting(screen.console, LOADING):
        from calibrate.cli.calibrate_study import calibrate_study
        from calibrate.cli.joint.study import calibrate_jointly_into, fit_jointly_into
        from calibrate.cli.plans.study import heading
        from calibrate.report.joint.tables import joint_tables
        from calibrate.report.tables import result_tables
    if screen.verbose:
        screen.details(heading(data, target, how))
    _tell_before(data, target, screen)
    remark_unheeded(data, screen)
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
    _keep_diagnosis(data, target, screen)
    if as_json:
        screen.result((target / RECORD).read_text(encoding="utf-8").rstrip())
        return
    names: set[str] = set()
    if staged is not None:
        names |= set(staged.runs["case_id"])
        show_result(screen, result_tables(staged), _stage_sentences(staged))
    if joint is not None:
        names |= set(joint.runs.table["case_id"])
        show_result(screen, joint_tables(joint), joint.sentences)
    minutes, place = (time.monotonic() - started) / 60.0, shell_word(target)
    screen.hint(f"report: {target / REPORT}   ({len(names)} runs, {minutes:.1f} min this time)")
    screen.hint(
        f"next: open {target / REPORT}, write the values for a script: bulkcal export {place}, or "
        f"look for what the model misses: bulkcal diagnose {shell_word(study)} --out {place}"
    )


def _tell_before(data: StudyData, out: Path, screen: Screen) -> None:
    """Say what results a directory holds that are not kept, before anything is done."""
    from calibrate.cli.kept import outdated_in, replaced_in

    if other := replaced_in(out, data.study.name):
        screen.remark(
            f"{out} has the results of the study '{other}', which are replaced; to keep them, "
            "stop and give another --out"
        )
    if why := outdated_in(out, data):
        screen.remark(
            f"{out} has results of other data ({why}): they are made anew or left out; finished "
            "runs are used again"
        )


def _keep_diagnosis(data: StudyData, out: Path, screen: Screen) -> None:
    """Put the diagnosis back into the report, or say why it is not."""
    from calibrate.report.diagnosis.section import keep_diagnosis

    if not keep_diagnosis(out, data.sha256):
        screen.remark(
            f"{out / DIAGNOSIS}: is of other data and is left out of the report; make it anew "
            f"with: bulkcal diagnose {shell_word(data.path)} --out {shell_word(out)}"
        )


def _stage_sentences(staged: Calibration) -> list[str]:
    return [
        f"{stage.stage.title}: {sentence}"
        for stage in staged.stages
        for sentence in staged.sentences(stage)
    ]
