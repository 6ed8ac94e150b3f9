"""The command `challenge score`."""

from __future__ import annotations

import json
import zipfile
from pathlib import Path
from typing import Annotated

import typer
from threadpoolctl import threadpool_limits

from calibrate.cli.arguments import AsJson, Quiet
from calibrate.cli.challenge.forecast import METHODS
from calibrate.cli.show.output import Screen
from calibrate.cli.show.waiting import Waiting
from calibrate.errors import CalibrationError
from liggghts_io.files import shell_word, write_text

__all__ = ["score"]


def score(
    suite: Annotated[Path, typer.Argument(metavar="SUITE", help="Folder of the suite.")],
    rules: Annotated[Path, typer.Option("--rules", metavar="RULES.toml", help="Its rules.")],
    forecasts: Annotated[
        Path | None,
        typer.Option("--forecasts", metavar="DIR|ZIP", help="Default: forecasts in the suite."),
    ] = None,
    studies: Annotated[
        int, typer.Option("--studies", metavar="N", min=0, help="The first N only; 0: all.")
    ] = 0,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> None:
    """Open the truths, and say how right every method was.

    A truth that is not the one that was sealed is refused. Figures that fail what is required are
    marked; each names how many studies are behind it. With --studies N the files that are written
    are scores_first_N.

    Example: bulkcal challenge score suite_1 --rules cases/challenge/suite_1.toml
    """
    screen = Screen(quiet)
    with Waiting(screen.console, "opening the truths") as wait:
        from calibrate.challenge.folders import Suite
        from calibrate.challenge.forecasts import FORECASTS
        from calibrate.challenge.learnt import learnt_of
        from calibrate.challenge.opening import cases_of
        from calibrate.challenge.rules import load_rules
        from calibrate.challenge.scores import cause_table, reliability_table, score_table
        from calibrate.report.record import plain

        folder = Suite(suite)
        asked = forecasts or suite / FORECASTS
        source = _packed(asked) if asked.suffix == ".zip" else asked
        methods = _methods(source, asked, suite, rules)
        folder.truths()  # what is missing is said before learning takes a minute
        sealed = len(folder.seals()["digests"])
        wait.tell("learning from the runs of the design")
        # Matrices are small and many: threads of the linear algebra get in each other's way.
        with threadpool_limits(limits=1):
            learnt = learnt_of(load_rules(rules), rules.parent)[1]
            cases = cases_of(folder, source, methods, learnt, studies, wait.tell)
        table, ours = score_table(cases), cases[methods[0]]
        reliability, causes = reliability_table(ours), cause_table(ours)
        tables = {"scores": table.reset_index(), "reliability": reliability,
                  "causes": causes.reset_index()}  # fmt: skip
        record = plain({name: one.to_dict("records") for name, one in tables.items()})
        text = json.dumps(record, indent=1)
        stem = suite / (f"scores_first_{studies}" if studies else "scores")
        write_text(stem.with_suffix(".json"), text + "\n")
        write_text(stem.with_suffix(".csv"), table.to_csv(float_format="%.4g"))
    if as_json:
        screen.result(text)
        return
    screen.result(table.to_string(float_format=lambda x: f"{x:.3f}", na_rep="-"))
    screen.result(reliability.to_string(index=False, float_format=lambda x: f"{x:.3f}"))
    screen.result(causes.to_string(float_format=lambda x: f"{x:.2f}"))
    if (made := len(folder.tried())) < sealed:
        screen.hint(f"{made} of {sealed} studies are made; 'bulkcal challenge make' goes on")
    screen.hint(f"written: {stem}.csv, {stem}.json")


def _methods(source: Path | zipfile.Path, asked: Path, suite: Path, rules: Path) -> list[str]:
    """Return the methods that forecast.

    Raises
    ------
    CalibrationError
        If there are none.
    """
    methods = [name for name in METHODS if (source / name).is_dir()]
    if not methods:
        command = f"bulkcal challenge forecast {shell_word(suite)} --rules {shell_word(rules)}"
        msg = f"{asked}: holds no forecasts; '{command}' makes them"
        raise CalibrationError(msg)
    return methods


def _packed(path: Path) -> zipfile.Path:
    """Return the folder at the top of an archive.

    Raises
    ------
    CalibrationError
        If it is none.
    """
    try:
        return zipfile.Path(path)
    except (OSError, zipfile.BadZipFile) as err:
        msg = f"{path}: no archive of forecasts ({err}); give the folder of 'challenge forecast'"
        raise CalibrationError(msg) from err
