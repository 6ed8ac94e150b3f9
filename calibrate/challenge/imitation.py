"""How far hidden causes are from everything that other parameters can do, wherever they are.

And how strong a cause must be to be so far.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.candidates import Board, Candidate, acting
from calibrate.causes.judging.elsewhere import nearest_imitations

__all__ = ["distances", "strength_at", "unlike_any"]

STARTS: Final = 16
"""Parameter sets from which the best imitation is looked for."""
FEW: Final = 6
"""The same where a strength is looked for."""
STRENGTHS: Final = 9
"""Strengths at once, ends included."""
ROUNDS: Final = 3
"""How often as many are tried again between two of them."""


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
    hidden = [(known[h["name"]], h["strength"]) for h in truth["hidden"] if h["name"] in known]
    on = acting((one, strength / one.scale) for one, strength in hidden)
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
    each = [acting([(one, x)]) for x in strengths]
    return [found.distance for found in nearest_imitations(board.problem, values, each, rng, FEW)]


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
        Ordinary strengths between which it is looked for; at the first it is not so far.
    wanted : float
        Standard errors.

    Returns
    -------
    (float, float) or None
        None where it is nowhere so far.
    """
    low, high = span
    found = None
    for _ in range(ROUNDS):
        tried = np.linspace(low, high, STRENGTHS)[1:]
        far = distances(board, values, one, list(map(float, tried)), rng)
        k = next((k for k, distance in enumerate(far) if distance >= wanted), None)
        if k is None:  # with other starts what was so far no longer is
            break
        found = float(tried[k]), far[k]
        low, high = (low if k == 0 else float(tried[k - 1])), float(tried[k])
    return found
