"""Base of fixes that act in every step outside of the kernels."""

from __future__ import annotations

from minidem.kernels.tables import Control
from minidem.world.fix import Fix
from minidem.world.world import World

__all__ = ["Carrier"]


class Carrier(Fix):
    """A fix that puts things somewhere in every step."""

    def before(self, world: World) -> None:
        """Act at the beginning of a step; ``world.step`` is that of the step before."""

    def after(self, world: World, control: Control) -> None:
        """Act at the end of a step, when all forces are known."""

    def lists_made(self, world: World, control: Control) -> None:
        """Act when neighbour lists are new."""
