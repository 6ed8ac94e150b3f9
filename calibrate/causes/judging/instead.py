"""Which causes other parameters imitate, and with what values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.candidates import Board, Candidate, acting
from calibrate.causes.judging.elsewhere import Imitation, nearest_imitations

__all__ = ["POWER80", "TRIED", "Instead", "imitated"]

POWER80: Final = 2.80
"""Two-sided 5 % test with 80 % power: 1.96 + 0.84 standard deviations."""
TRIED: Final = np.array([1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
"""Ordinary strengths at which imagined studies are made."""
STARTS: Final = 4
"""Parameter sets from which imitations are looked for."""


@dataclass(frozen=True)
class Instead:
    """A parameter that does what a cause does, with the others where they help it.

    Attributes
    ----------
    parameter : str
        That which moves most on its range.
    now, then : float
        Its value where the base model fits best, and where it imitates the cause.
    """

    parameter: str
    now: float
    then: float


def imitated(
    board: Board, z: Array, reached: list[float], rng: np.random.Generator
) -> dict[int, Instead]:
    """Return what does the same as causes, by their number, to less than is seen in 80 % of cases.

    Parameters
    ----------
    board : Board
    z : (K,) float64
        Where the base model fits best, in coordinates of the prior.
    reached : list of float
        Smallest ordinary strength of each cause that is told, were parameters near. Becomes the
        smallest of `TRIED` from which nothing imitates it; infinite where something always does.
    rng : numpy Generator
    """
    space = board.problem.space
    now = space.from_normal(z[None])[0]

    def nearest(asked: Sequence[tuple[int, float]]) -> list[Imitation]:
        each = [acting([(board.candidates[k], _signed(board.candidates[k], x))]) for k, x in asked]
        return nearest_imitations(board.problem, now, each, rng, STARTS)

    first = [(k, x) for k, x in enumerate(reached) if np.isfinite(x)]
    same = [k for (k, _), one in zip(first, nearest(first), strict=True) if _imitates(one)]
    asked = [(k, x) for k in same for x in _strengths(board.candidates[k], reached[k])]
    found: dict[int, Instead] = {}
    for (k, x), one in zip(asked, nearest(asked), strict=True):
        if not _imitates(one):
            reached[k] = min(reached[k], x)
            continue
        reached[k] = float("inf")
        units = space.units(np.vstack([now, one.parameters]))
        most = int(np.argmax(np.abs(units[1] - units[0])))
        found[k] = Instead(space.names[most], float(now[most]), float(one.parameters[most]))
    return found


def _imitates(one: Imitation) -> bool:
    return one.distance < POWER80


def _strengths(one: Candidate, least: float) -> list[float]:
    """Return the strengths to be tried, from the least on."""
    return [float(x) for x in TRIED if least <= x <= one.limit / one.scale] or [least]


def _signed(one: Candidate, x: float) -> float:
    """Return a strength of a size to the side on which imagined studies have it."""
    return x if one.high > 0.0 else -x
