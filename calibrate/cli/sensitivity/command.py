"""The command `sensitivity`. What it does is imported late: scipy and matplotlib cost seconds."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import typer

from calibrate.cli.arguments import (
    AsJson,
    DryRun,
    ExecutorName,
    ExecutorPairs,
    Quiet,
    TimeLimit,
    Verbose,
    Workers,
    named_directory,
)
from calibrate.cli.pairs import pairs_of
from calibrate.cli.show.output import Screen
from calibrate.cli.show.waiting import Waiting
from calibrate.executor_names import LOCAL
from calibrate.report.ours import default_out
from calibrate.runs.executors.run_options import RunOptions
from calibrate.runs.stored import RECORD, SENSITIVITY, SENSITIVITY_PAGE
from liggghts_io.files import shell_word

if TYPE_CHECKING:
    from calibrate.questions.sensitivity.result import SensitivityResult

__all__ = ["sensitivity"]

MOST: Final = 1000

Levels = Annotated[
    int, typer.Option(metavar="N", min=0, max=MOST, help="Values over each range; 0: Sobol only.")
]
Seeds = Annotated[int, typer.Option(metavar="N", min=2, max=MOST, help="Runs of each value.")]
Design = Annotated[
    int | None,
    typer.Option(
        metavar="N", min=0, max=10_000,
        help="Points of the design behind the Sobol indices; 0: none; as 'calibrate' by default.",
    ),
]  # fmt: skip
Baseline = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        help="Table quantity,value,unit; default: baseline.csv beside the study, if it is there.",
    ),
]


def sensitivity(
    study: Annotated[Path, typer.Argument(metavar="STUDY.toml", help="Study file.")],
    out: Annotated[
        str | None, typer.Option("--out", metavar="DIR", help="Default: the study's name.")
    ] = None,
    levels: Levels = 5,
    seeds: Seeds = 3,
    points: Design = None,
    baseline: Baseline = None,
    workers: Workers = 0,
    executor: ExecutorName = LOCAL,
    executor_option: ExecutorPairs = [],  # noqa: B006 - typer copies it
    time_limit: TimeLimit = None,
    dry_run: DryRun = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
    as_json: AsJson = False,
) -> None:
    """Say which parameter moves which observable.

    One parameter at a time around a baseline, Young's modulus and Poisson's ratio too, with several
    seeds, so that luck is told from an influence; and Sobol indices over all ranges together, from
    an emulator, with what its error makes. Runs of a calibration in the same directory are used,
    and a later calibration uses these. The baseline is a table, else the values of the study, else
    the middle of a range.

    Example: bulkcal sensitivity cases/proppants/hsp13_steel.toml --out hsp13 --dry-run
    """
    screen = Screen(quiet, verbose)
    pairs = pairs_of("--executor-option", executor_option)
    target = default_out(study) if out is None else named_directory("--out", out)
    asked_how = RunOptions(workers, executor, pairs, time_limit)
    with Waiting(screen.console, f"reading {study}") as wait:
        from calibrate.cli.sensitivity.plan import plan_of_sensitivity
        from calibrate.cli.sensitivity.study import study_sensitivity
        from calibrate.questions.sensitivity.study import Asked
        from calibrate.study.data import load_data

        data = load_data(study)
        run = data.study.run
        how = asked_how.filled(RunOptions(run.workers, run.executor, limit_s=run.time_limit_s))
        asked = Asked(levels, seeds, points, baseline)
        wait.tell("counting runs")
        facts = plan_of_sensitivity(data, target, how, asked, wait.say) if dry_run else {}
    if dry_run:
        screen.plan(facts, as_json)
        return
    command = (
        f"bulkcal sensitivity {shell_word(study)} --out {shell_word(target)}"
        f"{asked.words}{asked_how.words}"
    )
    found = study_sensitivity(data, target, command, how, asked=asked, console=screen.console)
    if as_json:
        screen.result((target / SENSITIVITY).read_text(encoding="utf-8").rstrip())
        return
    _show(found, study, target, screen)


def _show(found: SensitivityResult, study: Path, target: Path, screen: Screen) -> None:
    """Print what was found, and what comes next."""
    from calibrate.report.sensitivity.tables import sensitivity_tables

    for shown in sensitivity_tables(found):
        screen.table(shown)
    for sentence in found.sentences:
        screen.result(sentence)
    page = target / SENSITIVITY_PAGE
    follows = "diagnose" if (target / RECORD).exists() else "calibrate"
    screen.hint(f"page: {page}   ({found.runs} runs, {found.failed} failed)")
    words = f"{shell_word(study)} --out {shell_word(target)}"
    screen.hint(f"next: open {page}, or: bulkcal {follows} {words}")
