"""``fix ID GROUP diam/max``: the largest diameter of what the first distribution has."""

from __future__ import annotations

from typing import Self

from minidem.fixes.templates import DistributionFix
from minidem.record import record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.fix import FIXES, Fix
from minidem.world.world import World

__all__ = ["LargestDiameter"]


@FIXES.register("diam/max")
@record
class LargestDiameter(Fix):
    """Looks for the largest diameter when it is given and when a run begins.

    Attributes
    ----------
    diameter : float
        Of the templates of the first distribution, m, whether they are inserted or not; 0 without
        one. Further distributions and particles that are there do not count, as in LIGGGHTS.
    """

    diameter: float = 0.0

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Self:
        """Read no words."""
        del words
        return cls(*head, _largest(world))

    def value(self, world: World, index: int) -> float:
        """Return the diameter, m."""
        return self.diameter if index == 0 else super().value(world, index)

    def setup(self, world: World) -> None:
        """Look again, for what has been defined since."""
        self.diameter = _largest(world)


def _largest(world: World) -> float:
    first = next(iter(world.of_kind(DistributionFix)), None)
    return 2.0 * first.distribution.max_radius if first is not None else 0.0
