"""The command `challenge forecast`."""

from __future__ import annotations

import os
from concurrent.futures import ProcessPoolExecutor, as_completed
from functools import cache
from multiprocessing import get_context
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer

from calibrate.cli.arguments import Quiet, Workers, one_of
from calibrate.cli.show.output import Screen
from calibrate.cli.show.waiting import Waiting
from calibrate.errors import CalibrationError
from liggghts_io.files import shell_word

if TYPE_CHECKING:
    from calibrate.challenge.learnt import Learnt

__all__ = ["METHODS", "forecast"]

METHODS: Final = (
    "ours", "known", "no_curves", "one_material", "frozen", "ties_fixed", "certain", "prior",
    "signature", "rule_31a2ed1", "oracle", "limit",
)  # fmt: skip


def forecast(
    suite: Annotated[Path, typer.Argument(metavar="SUITE", help="Folder of the suite.")],
    rules: Annotated[Path, typer.Option("--rules", metavar="RULES.toml", help="Its rules.")],
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Default: forecasts in the suite.")
    ] = None,
    method: Annotated[
        str, typer.Option("--method", metavar="|".join(METHODS), help="What judges.")
    ] = METHODS[0],
    studies: Annotated[
        int, typer.Option("--studies", metavar="N", min=0, help="The first N only; 0: all.")
    ] = 0,
    workers: Workers = 0,
    quiet: Quiet = False,
) -> None:
    """Say of every study what is hidden in it, with probabilities, before anybody looks.

    Learns from the runs that the rules name, and reads nothing of the suite but its studies. Only
    two methods, which show what could be known, read the truth: the oracle, which knows the
    parameters, and the limit, for which the diagnosis judges data of its own emulators. One file
    per study and method; started again, it goes on where it was.

    Example: bulkcal challenge forecast suite_1 --rules cases/challenge/suite_1.toml
    """
    screen = Screen(quiet)
    one_of("--method", method, METHODS)
    with Waiting(screen.console, "reading the suite") as wait:
        from calibrate.challenge.folders import Suite
        from calibrate.challenge.forecasts import FORECASTS, NEED_TRUTH, forecast_path
        from calibrate.challenge.rules import load_rules

        load_rules(rules)  # a mistake in them is told before processes start
        folder = Suite(suite)
        folder.seals()
        target = out or suite / FORECASTS
        here = folder.studies()[: studies or None]
        todo = [one for one in here if not forecast_path(target, method, one).exists()]
        truths = folder.truths() if method in NEED_TRUTH else {}
        if not here:
            msg = f"{suite}: holds no study yet; 'bulkcal challenge make' goes on with it"
            raise CalibrationError(msg)
        count = min(workers or os.cpu_count() or 1, max(len(todo), 1))
        with ProcessPoolExecutor(count, get_context("spawn"), initializer=_prepare) as pool:
            asked = [
                pool.submit(_forecast, rules, one, target, method, truths.get(one.name))
                for one in todo
            ]
            wait.tell(f"{method}: learning from the runs, then {len(todo)} studies")
            for done, task in enumerate(as_completed(asked), 1):
                task.result()
                wait.tell(f"{method}: {done} of {len(todo)} studies")
    screen.result(f"{target / method}: {len(here)} forecasts")
    screen.hint(f"next: bulkcal challenge score {shell_word(suite)} --rules {shell_word(rules)}")


def _prepare() -> None:
    # Every process has a core; threads of a process would only wait for those of the others.
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from calibrate.runs.executors.workers import end_with_parent  # loads NumPy, which looks there

    end_with_parent()


@cache
def _learnt(rules: Path) -> Learnt:
    """Return what the design teaches; a process learns once."""
    from calibrate.challenge.learnt import learnt_of
    from calibrate.challenge.rules import load_rules

    return learnt_of(load_rules(rules), rules.parent)[1]


def _forecast(
    rules: Path, study: Path, out: Path, method: str, truth: dict[str, Any] | None
) -> bool:
    # learning is part of a task: what fails while a process starts reaches nobody
    from calibrate.challenge.forecasts import forecast as made

    return made(_learnt(rules), study, out, method, truth)
