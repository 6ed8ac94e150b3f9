"""``compute ID GROUP nparticles/tracer/region``: marked particles in a region."""

from __future__ import annotations

from typing import ClassVar, Final

import numpy as np

from minidem.errors import InputError
from minidem.kernels.columns import MASS
from minidem.output.averages.tracers import in_region
from minidem.record import field, record
from minidem.registry import Head
from minidem.words import Words, integer, one_of
from minidem.world.compute import COMPUTES, Compute
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["TracersInRegion"]

_TRACERS: Final = ("property/atom/tracer", "property/atom/tracer/stream")
_KEYS: Final = ("tracer", "region_count", "reset_marker", "periodic")


@COMPUTES.register("nparticles/tracer/region")
@record
class TracersInRegion(Compute):
    """Numbers of particles and of marked ones, and their masses, kg.

    Attributes
    ----------
    tracer, region : str
        Fix that marks, and where is counted.
    resets : bool
        Whether counted particles lose their mark.
    periodic : tuple of (int, int) or None
        Direction, and how often particles must have crossed its faces.
    counted : tuple
        When was counted last: step and first step of the run; and the four numbers.
    """

    tracer: str = ""
    region: str = ""
    resets: bool = True
    periodic: tuple[int, int] | None = None
    counted: tuple[tuple[int, int | None], Floats] = field(
        default_factory=lambda: ((-1, None), np.zeros(4))
    )

    extensive: ClassVar[tuple[bool, bool]] = (False, True)

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> TracersInRegion:
        """Read fix, region and options."""
        words.need(4, f"compute ID GROUP {head.style} tracer FIX region_count REGION")
        made = cls(*head)
        while not words.done():
            key = words.choice(_KEYS)
            if key == "tracer":
                made.tracer = words.take("a fix")
            elif key == "region_count":
                made.region = one_of(words.take("a region"), tuple(world.regions), "region")
            elif key == "reset_marker":
                made.resets = words.yes_no()
            else:
                made.periodic = _crossings(world, words)
        for key, given in (("tracer", made.tracer), ("region_count", made.region)):
            if not given:
                msg = f"compute {head.style}: expected '{key}'"
                raise InputError(msg)
        return made

    def value(self, world: World, indices: tuple[int, ...]) -> float:
        """Return particles (1), marked ones (2), and their masses (3, 4); once a step."""
        if len(indices) != 1 or indices[0] > 4:
            return super().value(world, indices)
        now = world.step, world.begin_step
        if self.counted[0] != now:
            self.counted = now, self._count(world)
        return float(self.counted[1][indices[0] - 1])

    def _count(self, world: World) -> Floats:
        fix = world.fixes.get(self.tracer)
        if fix is None or fix.style not in _TRACERS:
            msg = f"compute {self.name}: '{self.tracer[:40]}' is no fix property/atom/tracer"
            raise InputError(msg)
        here = world.member(self.bit) & in_region(world, self.region, f"compute {self.name}")
        if self.periodic is not None:
            axis, crossings = self.periodic
            here &= world.state.image[: world.state.n, axis] == crossings
        mass = world.state.row[: world.state.n, MASS]
        marked = here & (fix.per_atom(world, self.tracer) == 1.0)
        found = np.array(
            [np.count_nonzero(here), np.count_nonzero(marked), mass[here].sum(), mass[marked].sum()]
        )
        if self.resets:
            fix.assign(world, self.tracer, np.flatnonzero(marked), Words(["0"], "reset_marker"))
        return found


def _crossings(world: World, words: Words) -> tuple[int, int]:
    """Read direction and number of crossings."""
    name = words.choice(("x", "y", "z"), "direction")
    axis = "xyz".index(name)
    if world.need_box().boundary[axis] != "pp":
        msg = f"periodic {name}: the box is not periodic in {name}"
        raise InputError(msg)
    word = words.take("a number of crossings")
    # as in LIGGGHTS `all` are those that crossed the lower face once
    return axis, -1 if word == "all" else integer(word, "periodic")
