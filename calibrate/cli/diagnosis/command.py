"""The command `diagnose`. What it does is imported late: scipy and matplotlib cost seconds."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import typer

from calibrate.cli.arguments import (
    AsJson,
    DryRun,
    ExecutorName,
    ExecutorPairs,
    Further,
    More,
    Quiet,
    TimeLimit,
    Twins,
    Verbose,
    Workers,
    named_directory,
)
from calibrate.cli.ending import result_directory
from calibrate.cli.show.output import Screen
from calibrate.cli.show.study import LOADING, read_data, run_options, show_result, with_study
from calibrate.cli.show.waiting import Waiting
from calibrate.errors import CalibrationError
from calibrate.executor_names import LOCAL
from calibrate.report.ours import default_out
from calibrate.runs.executors.run_options import RunOptions
from calibrate.runs.stored import DIAGNOSIS, FIGURE, REPORT, SECTION
from liggghts_io.files import shell_word

if TYPE_CHECKING:
    from calibrate.causes.studies.suppose import Supposed
    from calibrate.study.data import StudyData

__all__ = ["diagnose"]

OPTION: Final = "--with"

Measured = Annotated[
    list[str],
    typer.Option(
        OPTION, metavar="NAME=VALUE+-ERROR",
        help="What if this had been measured? Repeatable; value and standard error of a cause's "
        "strength or of a free parameter, NAME:WHERE for one place. Costs no run.",
    ),
]  # fmt: skip

RunTables = Annotated[
    list[Path],
    typer.Option(
        "--runs", metavar="TABLE",
        help="Learn from the runs of tables that 'bulkcal runs' wrote, with and without causes, "
        "and run nothing; repeatable.",
    ),
]  # fmt: skip

Check = Annotated[
    bool,
    typer.Option(
        "--check",
        help="With --runs: run the engine at the best values all the same, without and with the "
        "cause.",
    ),
]


def diagnose(
    study: Annotated[Path, typer.Argument(metavar="STUDY.toml", help="Study file.")],
    out: Annotated[
        str | None,
        typer.Option("--out", metavar="DIR", help="Directory of its calibration; default: name."),
    ] = None,
    supposed: Measured = [],  # noqa: B006 - typer copies it
    runs: RunTables = [],  # noqa: B006 - typer copies it
    check: Check = False,
    twins: Twins = None,
    more: More = None,
    further: Further = None,
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
    study follow. Where the evidence of a leading cause is uncertain, runs are added. Where
    it stays open which cause it is, further experiments (a drum, another wall) are tried in the
    engine and ranked with what could be measured next. Started again, it goes on where it was.

    With --with it says what a measurement would make of that, as if it stood in the study under
    [known], from the runs that are there: verdict and probabilities before and after, kept beside
    the diagnosis in what_if/.

    With --runs it learns from the runs of tables, those with causes on among them, and runs
    nothing: no run is added and the engine is not asked, unless --check is given as well.

    Example: bulkcal diagnose cases/proppants/hsp13_steel.toml --out hsp13

    Example: bulkcal diagnose hsp13_steel.toml --out hsp13 --with "plate_period=0+-0.002"
    """
    screen = Screen(quiet, verbose)
    how = run_options(workers, executor, executor_option, time_limit)
    target = default_out(study) if out is None else named_directory("--out", out)
    given = _parsed(supposed, screen)
    data = read_data(study, screen)
    asked = _Asked(study, target, how, twins, more, further, given, runs, check)
    how = with_study(how, data)
    if runs:
        _from_tables(data, asked, how, screen, dry_run, as_json)
    elif check:
        msg = "--check goes with --runs; without it the engine is asked in any case"
        raise CalibrationError(msg)
    elif given:
        _what_if(data, asked, how, screen, dry_run, as_json)
    elif dry_run:
        _plan(data, asked, how, screen, as_json)
    else:
        _diagnosed(data, asked, how, screen, as_json)


@dataclass(frozen=True)
class _Asked:
    """What was asked for.

    Attributes
    ----------
    study, out : Path
    how : RunOptions
        As the command says.
    twins, more, further : int, optional
    given : list of Supposed
    tables : list of Path
    check : bool
    """

    study: Path
    out: Path
    how: RunOptions
    twins: int | None
    more: int | None
    further: int | None
    given: list[Supposed]
    tables: list[Path]
    check: bool

    @property
    def command(self) -> str:
        """The command that continues this work."""
        words = "".join(f" --with {shell_word(one.word)}" for one in self.given)
        words += f" --twins {self.twins}" if self.twins else ""
        words += "" if self.more is None else f" --more {self.more}"
        words += "" if self.further is None else f" --further {self.further}"
        words += "".join(f" --runs {shell_word(one)}" for one in self.tables)
        words += " --check" if self.check else ""
        place = f"{shell_word(self.study)} --out {shell_word(self.out)}"
        return f"bulkcal diagnose {place}{words}{self.how.words}"


def _parsed(words: list[str], screen: Screen) -> list[Supposed]:
    """Read what is supposed to have been measured."""
    if not words:
        return []
    with Waiting(screen.console, LOADING):
        from calibrate.cli.diagnosis.supposed import supposed_of

        return supposed_of(OPTION, words)


def _diagnosed(
    data: StudyData, asked: _Asked, how: RunOptions, screen: Screen, as_json: bool
) -> None:
    """Diagnose, with runs."""
    result_directory(asked.out)
    with Waiting(screen.console, LOADING):
        from calibrate.cli.diagnose_study import diagnose_study
        from calibrate.cli.plans.study import heading
    if screen.verbose:
        screen.details(heading(data, asked.out, how))
    diagnose_study(
        data, asked.out, asked.command, how, twins=asked.twins, more=asked.more,
        further=asked.further, console=screen.console,
    )  # fmt: skip
    _show_diagnosis(asked.out, screen, as_json)


def _plan(data: StudyData, asked: _Asked, how: RunOptions, screen: Screen, as_json: bool) -> None:
    """Say what a diagnosis would take."""
    with Waiting(screen.console, LOADING) as wait:
        from calibrate.cli.plans.diagnosis import plan_of_diagnosis

        wait.tell("reading what is stored")
        counts = asked.twins, asked.more, asked.further
        facts = plan_of_diagnosis(data, asked.out, how, *counts)
    screen.plan(facts, as_json)


def _from_tables(
    data: StudyData,
    asked: _Asked,
    how: RunOptions,
    screen: Screen,
    dry_run: bool,
    as_json: bool,
) -> None:
    """Diagnose from the runs of tables, or say what that takes."""
    if asked.given or any(x is not None for x in (asked.twins, asked.more, asked.further)):
        msg = (
            "--runs runs nothing, so that --twins, --more and --further say nothing; what was "
            "measured besides, write into the study under [known] in place of --with"
        )
        raise CalibrationError(msg)
    with Waiting(screen.console, LOADING):
        from calibrate.cli.diagnose_study import diagnose_tables
        from calibrate.cli.plans.diagnosis import plan_of_tables
    if dry_run:
        facts = plan_of_tables(data, asked.out, asked.tables, how, check=asked.check)
        screen.plan(facts, as_json)
        return
    engine = how if asked.check else None
    diagnose_tables(data, asked.tables, asked.out, asked.command, engine, console=screen.console)
    _show_diagnosis(asked.out, screen, as_json)


def _what_if(
    data: StudyData, asked: _Asked, how: RunOptions, screen: Screen, dry_run: bool, as_json: bool
) -> None:
    """Say what measurements would make of a diagnosis, or what that takes."""
    with Waiting(screen.console, LOADING):
        from calibrate.causes.studies.suppose import suppose
        from calibrate.cli.diagnosis.what_if import plan_of_what_if, what_if_study

        wanted, replaced = suppose(data, asked.given, OPTION)
    for line in replaced:
        screen.remark(f"{OPTION} replaces what the study says under [known]: {line}")
    place, counts = asked.out, (asked.twins, asked.more, asked.further)
    if dry_run:
        facts = plan_of_what_if(data, asked.given, place, how, *counts)
        screen.plan(facts, as_json)
        return
    folder = what_if_study(
        data, wanted, asked.given, place, asked.command, how,
        twins=asked.twins, more=asked.more, further=asked.further, console=screen.console,
    )  # fmt: skip
    _show_what_if(folder, screen, as_json)


def _show_what_if(folder: Path, screen: Screen, as_json: bool) -> None:
    """Print verdict and probabilities before and after, from the record."""
    from calibrate.report.diagnosis.tables import what_if_tables
    from calibrate.report.record_file import read_record

    if as_json:
        screen.result((folder / DIAGNOSIS).read_text(encoding="utf-8").rstrip())
        return
    record = read_record(folder / DIAGNOSIS)
    show_result(screen, what_if_tables(record), record["sentences"])
    screen.hint(f"page: {folder / SECTION}, figure: {folder / FIGURE}")


def _show_diagnosis(out: Path, screen: Screen, as_json: bool) -> None:
    """Print what a diagnosis found, from its record."""
    from calibrate.report.diagnosis.tables import diagnosis_tables
    from calibrate.report.record_file import read_record

    if as_json:
        screen.result((out / DIAGNOSIS).read_text(encoding="utf-8").rstrip())
        return
    record = read_record(out / DIAGNOSIS)
    show_result(screen, diagnosis_tables(record), record["sentences"])
    page = REPORT if (out / REPORT).exists() else SECTION
    screen.hint(f"report: {out / page}, figure: {out / FIGURE}")
    if record["next"]:
        screen.hint(f"next: {record['next']}")
