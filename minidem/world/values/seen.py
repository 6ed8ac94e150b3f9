"""What the forces of a step saw, for output that tells of contacts inside of it."""

from __future__ import annotations

from typing import Self

from minidem.kernels.columns import INVERSE, LENGTH, three
from minidem.kernels.tables import Control
from minidem.record import record
from minidem.world.state import Floats, Ints, State

__all__ = ["Seen"]


@record
class Seen:
    """Particles as the forces of a step saw them; what comes later in it moves and slows them.

    Attributes
    ----------
    step : int
        The step.
    ids : ndarray of int64, shape (n,)
        Whose rows they are.
    row, spin : ndarray, shape (n, columns)
        See `minidem.kernels.columns`.
    period, inverse : ndarray, shape (3,)
        Periods, m, and their inverses, 1/m; 0 in directions without.
    """

    step: int
    ids: Ints
    row: Floats
    spin: Floats
    period: Floats
    inverse: Floats

    @classmethod
    def now(cls, step: int, state: State, control: Control) -> Self:
        """Return a copy of the particles, between the move and the forces of a step."""
        n, real = state.n, control.real
        return cls(
            step, state.ids[:n].copy(), state.row[:n].copy(), state.spin[:n].copy(),
            real[three(LENGTH)].copy(), real[three(INVERSE)].copy(),
        )  # fmt: skip
