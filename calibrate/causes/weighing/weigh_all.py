"""Weigh all hypotheses of a board: on a cloud of draws, by modes where unknowns are many."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from calibrate.causes.candidates import Board
from calibrate.causes.weighing.by_modes import ByModes
from calibrate.causes.weighing.evidences import Effort, Evidences
from calibrate.causes.weighing.on_cloud import OnCloud

__all__ = ["weigh_all"]

Progress = Callable[[str, float], None]

MANY: Final = 12
"""Unknowns above which draws miss a posterior: of 2000 around its mode one to three counted with 30
unknowns of two materials on three walls; with 6 all do that have to."""


def _silent(_part: float) -> None:
    """Tell nobody."""


def weigh_all(
    board: Board,
    rng: np.random.Generator,
    progress: Progress | None = None,
    effort: Effort | None = None,
) -> Evidences:
    """Weigh all hypotheses of a board.

    Parameters
    ----------
    board : Board
    rng : numpy Generator
    progress : callable, optional
        Told what is done, and the fraction.
    effort : Effort, optional
    """
    tell = progress or (lambda _what, _share: None)
    many = board.problem.space.size > MANY
    kind = ByModes if many else OnCloud
    work = kind(board, np.random.default_rng(rng.integers(2**31)), effort or Effort())
    tell("where the base model lies", 0.0)
    work.find_base()
    tell("all causes", 0.2)
    work.tell = lambda part: tell("all causes", 0.2 + 0.3 * part)
    work.refine()
    work.tell = _silent  # what is refined later has other fractions
    work.look_closer()
    tell("pairs", 0.6)
    work.find_pairs()
    tell("leading hypotheses", 0.8)
    work.settle()
    tell("all hypotheses", 0.9)
    return work.finished()
