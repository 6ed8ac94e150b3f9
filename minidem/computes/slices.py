"""``compute ID GROUP slice FIRST END STEP INPUT ...``: some elements of other values."""

from __future__ import annotations

from minidem.errors import InputError
from minidem.output.columns import split_indices
from minidem.output.quantities import Quantities
from minidem.record import record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.compute import COMPUTES, Compute
from minidem.world.world import World

__all__ = ["Slice"]


@COMPUTES.register("slice")
@record
class Slice(Compute):
    """Every so manieth element of computes and fixes.

    Attributes
    ----------
    first, end, step : int
        Elements from `first`, from 1, to before `end`.
    names : tuple of str
        Inputs: ``c_ID`` or ``f_ID`` for elements, ``c_ID[j]`` for a column.
    """

    first: int = 1
    end: int = 2
    step: int = 1
    names: tuple[str, ...] = ()

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Slice:
        """Read the range and the inputs."""
        words.need(4, f"compute ID GROUP {head.style} FIRST END STEP c_ID ...")
        first, end, step = words.interval(), words.integer(), words.interval()
        if end < first:
            msg = f"compute slice: the end {end} comes before {first}"
            raise InputError(msg)
        names = words.rest()
        for name in names:
            table = {"c_": world.computes, "f_": world.fixes}.get(name[:2], {})
            if split_indices(name)[0][2:] not in table:
                msg = f"compute slice: there is no '{name[:40]}'; expected c_ID or f_ID"
                raise InputError(msg)
        return cls(*head, first, end, step, tuple(names))

    def adds_up(self, world: World, indices: tuple[int, ...]) -> bool:
        """Tell whether an input sums up: of a single one the element, of several any."""
        del indices
        return any(Quantities(world).adds_up(name, (self.first,)) for name in self.names)

    def value(self, world: World, indices: tuple[int, ...]) -> float:
        """Return element i of the only input, or [i][j] of several."""
        several = len(self.names) > 1
        fits = len(indices) == 1 + several and indices[0] <= (self.end - self.first) // self.step
        if not fits or (several and indices[1] > len(self.names)):
            return super().value(world, indices)
        name = self.names[indices[1] - 1 if several else 0]
        base, column = split_indices(name)
        ask = Quantities(world)
        at = (self.first + (indices[0] - 1) * self.step, *column)
        values = ask.compute_value if base.startswith("c_") else ask.fix_value
        return values(base[2:], at)
