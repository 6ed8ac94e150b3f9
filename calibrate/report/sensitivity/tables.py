"""A sensitivity study in words, on the screen and in the page alike."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from rich.table import Table

from calibrate.questions.sensitivity.responses import Response
from calibrate.questions.sensitivity.result import SensitivityResult
from calibrate.questions.sensitivity.shares import Explained, Share

__all__ = ["Grid", "grids_of", "sensitivity_tables"]

MARK = " *"


@dataclass(frozen=True)
class Grid:
    """A table in words.

    Attributes
    ----------
    title : str
    head : tuple of str
    rows : tuple of tuple of str
    note : str
        What a reader has to know of it.
    """

    title: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str


def grids_of(result: SensitivityResult) -> list[Grid]:
    """Return the tables of a sensitivity study; those that are empty are left out."""
    found = [_single(result.responses), _whole(result.shares), _known(result.explained)]
    return [grid for grid in found if grid.rows]


def sensitivity_tables(result: SensitivityResult) -> list[Table]:
    """Return the same for a screen."""
    shown = []
    for grid in grids_of(result):
        table = Table(title=grid.title, title_justify="left", caption=grid.note)
        table.caption_justify = "left"
        for number, name in enumerate(grid.head):
            table.add_column(name, justify="left" if number < 2 else "right", overflow="fold")
        for row in grid.rows:
            table.add_row(*row)
        shown.append(table)
    return shown


def _parameters(rows: Sequence[Response] | Sequence[Share]) -> list[str]:
    return list(dict.fromkeys(one.parameter for one in rows))


def _outputs(rows: Sequence[Response] | Sequence[Share]) -> list[tuple[str, str]]:
    return list(dict.fromkeys((one.where, one.name) for one in rows))


def _single(responses: Sequence[Response]) -> Grid:
    names = _parameters(responses)
    cells = {(r.where, r.name, r.parameter): _moved(r) for r in responses}
    rows = []
    for where, name in _outputs(responses):
        first = next(r for r in responses if (r.where, r.name) == (where, name))
        row = [cells.get((where, name, parameter), "") for parameter in names]
        rows.append((where, f"{name} [{first.unit}]", *row, _number(_noise(responses, first))))
    return Grid(
        "One parameter at a time",
        ("place", "output", *names, "one run ±"),
        tuple(rows),
        "How far the mean moves over the range, + where it rises, - where it falls, ↕ where it "
        "does both; a dot where it moves no more than the luck of the seeds explains (F test, 5 % "
        "for all parameters of an output). One run: its standard deviation by the seed.",
    )


def _noise(responses: Sequence[Response], first: Response) -> float:
    """Return the standard deviation of a run of an output, all parameters together."""
    each = [r.noise for r in responses if (r.where, r.name) == (first.where, first.name)]
    good = [one for one in each if math.isfinite(one)]
    return math.sqrt(sum(one**2 for one in good) / len(good)) if good else math.nan


def _moved(one: Response) -> str:
    """Return by how much an output moves, with its direction."""
    if one.direction == "not seen":
        return "·"
    sign = {"rises": "+", "falls": "-", "both ways": "↕"}[one.direction]
    return f"{sign}{one.span:.3g}"


def _whole(shares: Sequence[Share]) -> Grid:
    names = _parameters(shares)
    cells = {(s.where, s.name, s.parameter): _share(s) for s in shares}
    rows = tuple(
        (where, name, *(cells.get((where, name, parameter), "") for parameter in names))
        for where, name in _outputs(shares)
    )
    return Grid(
        "Sobol indices over the ranges: first, total and its 90 % interval",
        ("place", "output", *names),
        rows,
        "Share of the variance that a parameter causes by itself, and together with others. The "
        "interval holds the errors of sampling and of the emulator; *: no more than what the "
        "emulator's error makes by itself.",
    )


def _share(one: Share) -> str:
    low, high = one.total_span
    text = f"{one.first:.2f}, {one.total:.2f} ({low:.2f} to {high:.2f})"
    return text if one.seen else text + MARK


def _known(explained: Sequence[Explained]) -> Grid:
    return Grid(
        "How well the emulators know the outputs over the ranges",
        ("place", "output", "runs", "Q2", "error", "seed noise"),
        tuple(
            (
                one.where, one.name, str(one.runs), f"{one.q2:.2f}",
                f"{100.0 * one.error_share:.1f} %", f"{100.0 * one.noise:.1f} %",
            )
            for one in explained
        ),
        "Q2: share of the variance of left-out runs that is predicted. Error: variance of the "
        "emulator's error over that of what it emulates. Seed noise: variance of a run by its "
        "seed over the variance that the parameters cause.",
    )  # fmt: skip


def _number(value: float) -> str:
    return f"{value:.2g}" if math.isfinite(value) else "n/a"
