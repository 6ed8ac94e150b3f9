"""How far hidden causes are from everything that other parameters can do, wherever they are."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from calibrate.causes.candidates import Board
from calibrate.causes.judging.elsewhere import nearest_imitations

__all__ = ["unlike_any"]

STARTS: Final = 16
"""Parameter sets from which the best imitation is looked for."""


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
