"""Which effects a few runs of each show to be worth more runs."""

from __future__ import annotations

from typing import Final

import numpy as np

from calibrate.causes.candidates import Board
from calibrate.causes.judging.straight import straight_at
from calibrate.causes.judging.visibility import visible_limits
from calibrate.causes.weighing.bases import best_mode

__all__ = ["worth_twins"]

DOUBTFUL: Final = 2.0
"""A cause that needs more than this many times its largest strength cannot be seen; one that needs
less may be seen with an answer that is better known."""


def worth_twins(board: Board, seed: int) -> tuple[str, ...]:
    """Return the effects that the data could show in one place or everywhere.

    Parameters
    ----------
    board : Board
        With the answers that a few twins tell, so that what just misses being visible is kept.
    seed : int
    """
    mode = best_mode(board.problem, np.random.default_rng(seed))
    limits = visible_limits(straight_at(board, mode.tangent))
    found = [
        one.effect
        for one, limit in zip(board.candidates, limits, strict=True)
        if one.scale * limit <= DOUBTFUL * one.limit
    ]
    return tuple(dict.fromkeys(found))
