"""How far hidden causes are from everything that other parameters can do, wherever they are.

And how strong a cause must be to be so far.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.candidates import Board, Candidate
from calibrate.causes.judging.elsewhere import nearest_imitations

__all__ = ["distances", "strength_at", "unlike_any"]

STARTS: Final = 16
"""Parameter sets from which the best imitation is looked for."""
FEW: Final = 6
"""The same where a strength is looked for."""
STRENGTHS: Final = 9
ROUNDS: Final = 3
"""Strengths that are tried between the last two, so often."""


def unlike_any(board: Board, truth: Mapping[str, Any], rng: np.random.Generator) -> float:
    """Return how many standard errors the causes of a study are from the base model anywhere.

    Parameters
    ----------
    board : Board
    truth : mapping
        As `calibrate.challenge.truths.Truth.plain` gives it.
    rng : Generator

    Returns
    -------
    float
        0 where nothing of it was measured; nan where something is foreign, which no emulator knows.
    """
    if truth["kind"] == "foreign":
        return float("nan")
    known = {one.name: one for one in board.candidates}
    on: dict[int, dict[int, float]] = {}
    for hidden in truth["hidden"]:
        candidate = known.get(hidden["name"])
        if candidate is None:
            continue
        for k, column in candidate.acts:
            on.setdefault(k, {})[column] = hidden["strength"] / candidate.scale
    values = np.array([truth["values"].get(name, 0.0) for name in board.problem.space.names])
    (found,) = nearest_imitations(board.problem, values, [on], rng, STARTS)
    return found.distance


def distances(
    board: Board, values: Array, one: Candidate, strengths: Sequence[float],
    rng: np.random.Generator,
) -> list[float]:  # fmt: skip
    """Return how far a cause is from the base model anywhere, at several strengths.

    Parameters
    ----------
    board : Board
    values : (K,) float64
        Parameters.
    one : Candidate
    strengths : sequence of float
        In ordinary ones.
    rng : Generator
    """
    acting = []
    for x in strengths:
        on: dict[int, dict[int, float]] = {}
        for k, column in one.acts:
            on.setdefault(k, {})[column] = float(x)
        acting.append(on)
    return [found.distance for found in nearest_imitations(board.problem, values, acting, rng, FEW)]


def strength_at(
    board: Board, values: Array, one: Candidate, span: tuple[float, float], wanted: float,
    rng: np.random.Generator,
) -> tuple[float, float] | None:  # fmt: skip
    """Return the least strength at which a cause is as far as wanted, and how far it is there.

    Parameters
    ----------
    board, values, one, rng
        As `distances`.
    span : (float, float)
        Ordinary strengths between which it is looked for, from the weaker one on.
    wanted : float
        Standard errors.

    Returns
    -------
    (float, float) or None
        None where it is nowhere so far.
    """
    low, high = span
    for _ in range(ROUNDS):
        tried = np.linspace(low, high, STRENGTHS)
        far = distances(board, values, one, list(tried), rng)
        beyond = [k for k, d in enumerate(far) if d >= wanted]
        if not beyond:
            return None
        k = beyond[0]
        if k == 0:
            break
        low, high = float(tried[k - 1]), float(tried[k])
    return float(tried[k]), far[k]
