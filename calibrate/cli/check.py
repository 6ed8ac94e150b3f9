"""The command `check`: whether a study is right, and what it will cost on this machine.

What it does is imported late: running cases needs modules that `bulkcal --help` can do
without.
"""

from __future__ import annotations

import math
import os
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.table import Table

from calibrate.cli.arguments import AsJson, Quiet, Workers
from calibrate.cli.show.output import Screen, table
from calibrate.cli.show.waiting import Waiting
from calibrate.errors import CalibrationError, StudyError

if TYPE_CHECKING:
    from calibrate.runs.cost import Cost

__all__ = ["check"]

USER_MISTAKE = 2


def check(
    study: Annotated[Path, typer.Argument(metavar="STUDY.toml", help="Study file.")],
    workers: Workers = 0,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> None:
    """Check a study and its data, all mistakes at once, and say runs, time and disk needed.

    Nothing is calibrated and nothing is kept: one case per experiment is run at the smallest
    scale in a temporary folder, to know how fast this machine is.

    Example: bulkcal check cases/proppants/hsp13_steel.toml
    """
    screen = Screen(quiet)
    try:
        with Waiting(screen.console, f"reading {study}"):
            from calibrate.runs.cost import cost_of
            from calibrate.study.data import load_data

            data = load_data(study)
    except CalibrationError as err:
        if not as_json:
            raise
        mistakes = list(err.mistakes) if isinstance(err, StudyError) else [str(err)]
        screen.json({"study": str(study), "ok": False, "mistakes": mistakes})
        raise typer.Exit(USER_MISTAKE) from None
    asked = workers or data.study.run.workers or os.cpu_count() or 1
    with Waiting(screen.console, "running one small case per experiment") as wait:
        cost = cost_of(data.study, asked, tell=wait.say)
    if as_json:
        screen.json(_as_data(study, cost))
        return
    screen.result(f"{study}: no mistake found")
    screen.table(_table(cost))
    for line in _sentences(cost):
        screen.result(line)
    screen.hint(f"next: bulkcal calibrate {study}")


def _as_data(study: Path, cost: Cost) -> dict[str, Any]:
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
        }
    )
    return data


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


def _sentences(cost: Cost) -> list[str]:
    said = [f"The probe failed, so time and disk are not known: {why}" for why in cost.failed]
    if math.isfinite(cost.wall_s):
        low, high = cost.wall_s / cost.factor, cost.wall_s * cost.factor
        said.append(
            f"{cost.runs} runs: about {_duration(cost.wall_s)} on {cost.workers} processes (from "
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
    return f"{seconds:.2g} s"


def _size(megabytes: float) -> str:
    """Return a size with about two digits."""
    if not math.isfinite(megabytes):
        return "?"
    if megabytes >= 2000.0:
        return f"{megabytes / 1000.0:.0f} GB"
    return f"{megabytes:.2g} MB" if megabytes < 100.0 else f"{megabytes:.0f} MB"
