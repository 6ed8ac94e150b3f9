"""The command `check`: whether a study is right, and what it will cost on this machine.

What it does is imported late: running cases needs modules that `bulkcal --help` can do
without.
"""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.table import Table

from calibrate.cli.arguments import (
    AsJson,
    ExecutorName,
    ExecutorPairs,
    Quiet,
    TimeLimit,
    Workers,
    named_directory,
)
from calibrate.cli.pairs import pairs_of
from calibrate.cli.show.output import Screen, table
from calibrate.cli.show.waiting import Waiting
from calibrate.errors import CalibrationError, StudyError
from calibrate.executor_names import LOCAL
from calibrate.report.ours import default_out
from calibrate.runs.executors.run_options import RunOptions
from liggghts_io.files import shell_word

if TYPE_CHECKING:
    from calibrate.questions.identify import Identification
    from calibrate.runs.cost import Cost
    from calibrate.study.data import StudyData
    from calibrate.study.model import Study
    from liggghts_io import CaseSpec

__all__ = ["check"]

USER_MISTAKE = 2
TWO_DIGITS = 10.0


def check(
    study: Annotated[Path, typer.Argument(metavar="STUDY.toml", help="Study file.")],
    pilot: Annotated[
        bool, typer.Option("--pilot", help="Run a few cases to see what the data can determine.")
    ] = False,
    out: Annotated[
        str | None,
        typer.Option("--out", metavar="DIR", help="Where a pilot runs; default: the study's name."),
    ] = None,
    workers: Workers = 0,
    executor: ExecutorName = LOCAL,
    executor_option: ExecutorPairs = [],  # noqa: B006 - typer copies it
    time_limit: TimeLimit = None,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> None:
    """Check a study and its data, all mistakes at once, and say runs, time and disk needed.

    Nothing is calibrated: one case per experiment is run at the smallest scale in a temporary
    folder, to know how fast this machine is. A pilot says, before anything dear, which unknowns
    the data can determine and which measured values no parameters explain; its runs are kept, and
    used again by 'bulkcal calibrate' with the same --out.

    Example: bulkcal check cases/proppants/hsp13_steel.toml
    """
    screen = Screen(quiet)
    how = RunOptions(workers, executor, pairs_of("--executor-option", executor_option), time_limit)
    target = str(default_out(study) if out is None else named_directory("--out", out))
    data = _read(study, Path(target), screen, as_json)
    run = data.study.run
    how = how.filled(RunOptions(run.workers, run.executor, limit_s=run.time_limit_s))
    with Waiting(screen.console, "running one small case per experiment") as wait:
        from calibrate.runs.cost import cost_of

        cost = cost_of(data.study, how.workers or os.cpu_count() or 1, tell=wait.say)
        from calibrate.cli.joint.pilot import cases_of_pilot, run_pilot
        from calibrate.study.checks.known import unheeded
        from calibrate.study.checks.plausible import guessed_walls

        planned = cases_of_pilot(data)
    seconds = _pilot_s(data.study, cost, planned)
    found = None
    if pilot:
        screen.remark(f"pilot: {len(planned)} runs, about {_duration(seconds)} on {how.place}")
        command = f"bulkcal check {shell_word(study)} --pilot --out {shell_word(target)}{how.words}"
        found = run_pilot(data, Path(target), command, how, console=screen.console)
    doubts = [*unheeded(data.study), *data.doubts, *guessed_walls(data.study)]
    if as_json:
        screen.json({**_as_data(study, cost, len(planned), seconds, found), "doubts": doubts})
        return
    screen.result(f"{study}: no mistake found")
    for line in doubts:
        screen.result(line)
    screen.table(_table(cost))
    for line in _sentences(cost, how.place):
        screen.result(line)
    _show_pilot(screen, found, f"{len(planned)} runs, about {_duration(seconds)}", study)
    screen.hint(f"next: bulkcal calibrate {shell_word(study)} --out {shell_word(target)}")


def _read(study: Path, out: Path, screen: Screen, as_json: bool) -> StudyData:
    """Read a study and its data; with --json its mistakes are the result."""
    try:
        with Waiting(screen.console, f"reading {study}"):
            from calibrate.cli.joint.first import check_design
            from calibrate.study.data import load_data

            data = load_data(study)
            check_design(data, out)
            return data
    except CalibrationError as err:
        if not as_json:
            raise
        mistakes = list(err.mistakes) if isinstance(err, StudyError) else [str(err)]
        screen.json({"study": str(study), "ok": False, "mistakes": mistakes})
        raise typer.Exit(USER_MISTAKE) from None


def _show_pilot(screen: Screen, found: Identification | None, cost: str, study: Path) -> None:
    """Print what a pilot said, or what one would cost and give."""
    if found is None:
        screen.result(
            f"A pilot of {cost}, would say what these data can determine and what no parameters "
            f"explain: bulkcal check {shell_word(study)} --pilot"
        )
        return
    screen.table(_width_table(found))
    for line in found.sentences or ("Every unknown is determined by these data.",):
        screen.result(line)


def _pilot_s(study: Study, cost: Cost, cases: Sequence[CaseSpec]) -> float:
    """Return about how long a pilot takes on the processes of the estimate [s]."""
    one: dict[tuple[str, str, str], float] = {
        (
            study.material_named(place.material).bulk.name,
            study.surface_named(place.surface).kind,
            place.experiment,
        ): place.run_s
        for place in cost.places
    }
    return sum(one[case.particle.name, case.surface, case.experiment] for case in cases) / (
        cost.workers
    )


def _width_table(found: Identification) -> Table:
    title = f"What these data can determine, from {found.runs} runs"
    shown = table(["unknown", "left of its range", "mostly from"], ["left of its range"], title)
    for name, row in found.widths.iterrows():
        share = min(float(row["width"]), 1.0)
        shown.add_row(str(name), f"{100 * share:.0f} %", str(row["target"]))
    return shown


def _as_data(
    study: Path, cost: Cost, pilot_runs: int, pilot_s: float, found: Identification | None
) -> dict[str, Any]:
    from calibrate.report.record import plain

    data: dict[str, Any] = plain(
        {
            "study": str(study),
            "ok": True,
            "mistakes": [],
            "runs": cost.runs,
            "workers": cost.workers,
            "wall_s": cost.wall_s,
            "factor": cost.factor,
            "disk_mb": cost.disk_mb,
            "places": [asdict(one) for one in cost.places],
            "failed_probes": list(cost.failed),
            "pilot_runs": pilot_runs,
            "pilot_s": pilot_s,
            "pilot": None if found is None else _pilot_data(found),
        }
    )
    return data


def _pilot_data(found: Identification) -> dict[str, Any]:
    return {
        "runs": found.runs,
        "unknowns": found.widths.reset_index().to_dict(orient="records"),
        "outside": [asdict(one) for one in found.outside],
        "sentences": list(found.sentences),
    }


def _table(cost: Cost) -> Table:
    numbers = ["runs", "steps", "grains", "time of one", "memory", "disk of one"]
    shown = table(["experiment", *numbers], numbers, "What a calibration runs")
    several = len({one.material for one in cost.places}) > 1
    for one in cost.places:
        shown.add_row(
            f"{one.experiment} on {one.surface}{f', {one.material}' if several else ''}",
            str(one.runs),
            f"{one.steps:.3g}",
            f"{one.grains:.0f}",
            _duration(one.run_s),
            _size(one.memory_mb),
            _size(one.disk_mb),
        )
    return shown


def _sentences(cost: Cost, where: str) -> list[str]:
    said = [f"The probe failed, so time and disk are not known: {why}" for why in cost.failed]
    if math.isfinite(cost.wall_s):
        low, high = cost.wall_s / cost.factor, cost.wall_s * cost.factor
        said.append(
            f"{cost.runs} runs at most: about {_duration(cost.wall_s)} on {where} (from "
            f"{_duration(low)} to {_duration(high)}: steps times grains, measured on one small run "
            f"per experiment), {_size(cost.disk_mb)} on disk"
        )
    return said


def _duration(seconds: float) -> str:
    """Return a duration with about two digits."""
    if not math.isfinite(seconds):
        return "?"
    for unit, length in (("days", 86400.0), ("h", 3600.0), ("min", 60.0)):
        if seconds >= 2.0 * length:
            return f"{seconds / length:.2g} {unit}"
    return f"{seconds:.0f} s" if seconds >= TWO_DIGITS else f"{seconds:.2g} s"


def _size(megabytes: float) -> str:
    """Return a size with about two digits."""
    if not math.isfinite(megabytes):
        return "?"
    if megabytes >= 2000.0:
        return f"{megabytes / 1000.0:.0f} GB"
    return f"{megabytes:.2g} MB" if megabytes < 100.0 else f"{megabytes:.0f} MB"
