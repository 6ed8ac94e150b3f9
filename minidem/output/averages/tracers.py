"""``fix property/atom/tracer`` and ``regiontracer/time``: where particles have been."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, Final

import numpy as np

from minidem.errors import InputError
from minidem.kernels.columns import POSITION
from minidem.output.averages.stored import StoredFix
from minidem.record import record
from minidem.registry import Head
from minidem.words import Words, one_of
from minidem.world.event import next_multiple
from minidem.world.fix import FIXES
from minidem.world.state import Bools, Ints
from minidem.world.values.by_id import ById
from minidem.world.world import World

__all__ = ["Marks", "ResidenceTime", "Tracer", "in_region"]

_STYLES: Final = ("heaviside", "dirac", "none")
_MOST: Final = 53  # regions, as in LIGGGHTS
_EVERY: Final = 10  # steps
_MARK = _IN_ALL = 0  # columns


def in_region(world: World, region: str, fix: str) -> Bools:
    """Return which particles are in a region.

    Raises
    ------
    InputError
        If there is no such region any more.
    """
    if region not in world.regions:
        msg = f"{fix}: region '{region[:40]}' is not there any more"
        raise InputError(msg)
    found: Bools = world.regions[region].match(world.state.row[: world.state.n, POSITION])
    return found


@record
class Marks(StoredFix):
    """Marks of particles: ``f_ID`` is 1 for marked ones, and how many were marked.

    Attributes
    ----------
    marked, told : int
        Particles marked so far, and until the number was asked for last.
    """

    marked: int = 0
    told: int = 0

    def mark(self, world: World, who: Ints) -> None:
        """Mark the particles of some rows, which are not marked yet."""
        rows = self.kept.rows(world)
        rows[who] = 1.0
        self.kept.keep(world, rows)
        self.marked += len(who)

    def assign(self, world: World, name: str, who: Ints, words: Words) -> bool:
        """Read a new mark for some particles if `name` is the fix."""
        if name != self.name:
            return False
        rows = self.kept.rows(world)
        rows[who] = words.number()
        self.kept.keep(world, rows)
        return True

    def value(self, world: World, index: int) -> float:
        """Return how many particles were marked since this was last asked for."""
        if index:
            return super().value(world, index)
        found, self.told = self.marked - self.told, self.marked
        return float(found)


@FIXES.register("property/atom/tracer")
@record
class Tracer(Marks):
    """Marks the particles in a region, once or from a step on; ``f_ID`` is 1 for marked ones.

    Attributes
    ----------
    region : str
        Where particles are marked.
    first : int
        Step from which on.
    marks : str
        ``dirac`` for once, ``heaviside`` for ever, ``none``.
    every : int
        Interval in steps.
    waits : bool
        Whether none was marked yet.
    """

    region: str = ""
    first: int = 0
    marks: str = "dirac"
    every: int = _EVERY
    waits: bool = True

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Tracer:
        """Read region, step and options."""
        words.need(4, "fix ID GROUP property/atom/tracer region_mark REGION mark_step STEP")
        made = cls(*head, ById((0.0,)))
        given = set()
        while not words.done():
            key = words.choice(("region_mark", "mark_step", "marker_style", "check_mark_every"))
            given.add(key)
            if key == "region_mark":
                made.region = one_of(words.take("a region"), tuple(world.regions), "region")
            elif key == "mark_step":
                made.first = words.interval(least=0)
                made.waits = made.first >= world.step
            elif key == "marker_style":
                made.marks = words.choice(_STYLES, key)
            else:
                made.every = words.interval()
        for key in ("region_mark", "mark_step"):
            if key not in given:
                msg = f"fix {head.style}: expected '{key}'"
                raise InputError(msg)
        return made

    def next_step(self, step: int) -> int:
        """Return the next multiple of the interval."""
        return next_multiple(step, self.every)

    def act(self, world: World) -> None:
        """Mark particles."""
        over = self.marks == "none" or (self.marks == "dirac" and not self.waits)
        if world.step < self.first or over:
            return
        new = world.member(self.bit) & (self.kept.rows(world)[:, _MARK] != 1.0)
        new &= in_region(world, self.region, f"fix {self.name}")
        self.mark(world, np.flatnonzero(new))
        self.waits = False

    def state(self) -> dict[str, Any]:
        """Return the marks; the count begins anew, as in LIGGGHTS."""
        return super().state() | {"waits": self.waits}

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Take the marks from a restart file."""
        super().restore(saved)
        self.waits = bool(saved.get("waits", self.waits))


@FIXES.register("property/atom/regiontracer/time")
@record
class ResidenceTime(StoredFix):
    """Adds up how long particles are there, and how long in each of some regions, s.

    Attributes
    ----------
    regions : tuple of str
        The regions.
    every : int
        After how many steps it is looked who is where.
    """

    regions: tuple[str, ...] = ()
    every: int = _EVERY

    extensive: ClassVar[tuple[bool, bool]] = (False, True)  # so has LIGGGHTS, though they are means

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> ResidenceTime:
        """Read regions and interval."""
        regions: list[str] = []
        every = _EVERY
        while not words.done():
            if words.choice(("add_region", "check_region_every")) == "add_region":
                name = words.take("a region")
                regions.append(one_of(name, tuple(world.regions), "region"))
            else:
                every = words.interval()
        if len(regions) > _MOST:
            msg = f"fix {head.style}: at most {_MOST} regions are possible, found {len(regions)}"
            raise InputError(msg)
        # times in all, in the regions, and whether they were in each of them
        count = 1 + 2 * len(regions)
        return cls(*head, ById((0.0,) * count), tuple(regions), every)

    def value(self, world: World, index: int) -> float:
        """Return the mean time of all particles, in all (1) or in a region, from 2."""
        if not 1 <= index <= 1 + len(self.regions):
            return super().value(world, index)
        member, column = world.member(self.bit), index - 1
        total = float(self.kept.rows(world)[member, column].sum())
        return total / world.state.n if total > 0.0 else 0.0

    def next_step(self, step: int) -> int:
        """Return the next step."""
        return step + 1

    def act(self, world: World) -> None:
        """Add a time step."""
        rows = self.kept.rows(world)
        member = world.member(self.bit)
        rows[member, _IN_ALL] += world.dt
        first = 1 + len(self.regions)
        for k, region in enumerate(self.regions):
            if world.step % self.every == 0:
                rows[member, first + k] = in_region(world, region, f"fix {self.name}")[member]
            there = first + k
            column = there - len(self.regions)
            rows[member & (rows[:, there] != 0.0), column] += world.dt
        self.kept.keep(world, rows)
