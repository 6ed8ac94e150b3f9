"""``fix ID GROUP deform N x|y|z STYLE ... [remap x|none]``: the box changes its size in a run."""

from __future__ import annotations

from math import exp, pi, sin, sqrt
from typing import ClassVar

import numpy as np

from minidem.errors import InputError, SimulationError, UnknownWordError
from minidem.fixes.carrier import Carrier
from minidem.kernels.columns import INVERSE, LENGTH, POSITION, TRIGGER2, three
from minidem.kernels.tables import Control
from minidem.record import field, record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.fix import FIXES
from minidem.world.state import Box, Floats
from minidem.world.world import World

__all__ = ["Deform"]

_AXES = ("x", "y", "z")
_COUNTS = {
    "final": 2, "delta": 2, "scale": 1, "vel": 1, "erate": 1, "trate": 1, "volume": 0, "wiggle": 2,
    "variable": 0,
}  # fmt: skip


@record
class _Change:
    """How one direction changes.

    Attributes
    ----------
    style : str
        A key of `_COUNTS`.
    given : list of float
        Its numbers.
    variable : str
        Gives the change of length, m.
    """

    style: str
    given: list[float]
    variable: str = ""

    def ends(self, lo: float, hi: float, time: float) -> tuple[float, float]:
        """Return the bounds after the time of a run that began with `lo` and `hi`, m."""
        given, length, middle = [*self.given, 0.0], hi - lo, 0.5 * (lo + hi)
        if self.style == "final":
            return given[0], given[1]
        if self.style == "delta":
            return lo + given[0], hi + given[1]
        if self.style == "vel":
            return lo - 0.5 * time * given[0], hi + 0.5 * time * given[0]
        if self.style == "erate":
            return lo - 0.5 * time * given[0] * length, hi + 0.5 * time * given[0] * length
        if self.style == "trate":
            half = 0.5 * (length * exp(given[0] * time))
            return middle - half, middle + half
        if self.style == "scale":
            return middle - 0.5 * given[0] * length, middle + 0.5 * given[0] * length
        if self.style == "wiggle":
            half = 0.5 * given[0] * sin(2.0 * pi * time / given[1])
            return lo - half, hi + half
        return lo, hi


@FIXES.register("deform")
@record
class Deform(Carrier):
    """A box that changes its size.

    Attributes
    ----------
    every : int
        Interval in steps.
    changes : dict
        Direction to how it changes.
    remap : bool
        Whether particles of the group move with the box.
    first, held : ndarray, shape (2, 3)
        Corners of the box when the run began, and when lists were made, m.
    """

    every: int = 1
    changes: dict[int, _Change] = field(default_factory=dict)
    remap: bool = True
    first: Floats = field(default_factory=lambda: np.zeros((2, 3)))
    held: Floats = field(default_factory=lambda: np.zeros((2, 3)))

    begins_with_run: ClassVar[bool] = True

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Deform:
        """Read interval, changes and options."""
        words.need(3, "fix ID GROUP deform N x vel V")
        made = cls(*head, every=words.interval())
        scale = np.ones(3)
        while not words.done():
            key = words.choice((*_AXES, "xy", "xz", "yz", "remap", "units", "flip"))
            if key in _AXES:
                made._read_change(words, _AXES.index(key))
            elif key == "remap":
                made.remap = _remap(words)
            elif key == "flip":
                words.yes_no()
            elif key == "units":
                lattice = words.choice(("box", "lattice"), "units") == "lattice"
                scale = world.lattice.spacing if lattice else scale
            else:
                msg = f"fix deform {key}: a box that is tilted is not supported; use x, y and z"
                raise UnknownWordError(msg)
        made._finish(world.need_box(), scale)
        return made

    def variables_asked(self) -> tuple[str, ...]:
        """Return the names of the variables that it asks in a run."""
        return tuple(one.variable for one in self.changes.values() if one.variable)

    def _read_change(self, words: Words, axis: int) -> None:
        """Read style and numbers of one direction."""
        style = words.choice(tuple(_COUNTS), "style")
        given = words.numbers(_COUNTS[style])
        change = _Change(style, given)
        if style == "variable":
            change.variable = words.variable()
            words.variable()  # the rate, which matters for 'remap v' only
        if style == "wiggle" and not given[-1] > 0.0:
            msg = f"fix deform wiggle: the period {given[-1]:g} is not above zero"
            raise InputError(msg)
        self.changes[axis] = change

    def _finish(self, box: Box, scale: Floats) -> None:
        """Check the whole, and bring it to box units."""
        for axis, change in self.changes.items():
            if change.style in ("final", "delta", "vel", "wiggle"):
                lengths = 1 if change.style in ("vel", "wiggle") else len(change.given)
                given = change.given[:lengths]
                change.given[:lengths] = [float(scale[axis]) * number for number in given]
            if set(box.boundary[axis]) & set("sm"):
                msg = f"fix deform {_AXES[axis]}: the box is wrapped around particles there"
                raise InputError(msg)
            others = [d for d in range(3) if d != axis]
            kinds = [self.changes[d].style if d in self.changes else "" for d in others]
            if change.style == "volume" and not any(kind not in ("", "volume") for kind in kinds):
                msg = "fix deform volume: another direction must change by itself"
                raise InputError(msg)

    def check(self, world: World) -> None:
        """Refuse two such fixes, and moving meshes or walls that follow nothing."""
        if len(world.of_kind(Deform)) > 1:
            msg = "More than one fix deform; give all directions in one of them"
            raise InputError(msg)

    def setup(self, world: World) -> None:
        """Note the box at the beginning of the run."""
        box = world.need_box()
        self.first = np.array([box.lo, box.hi])
        self.held = self.first.copy()
        for axis, change in self.changes.items():
            duration = ((world.end_step or world.step) - world.step) * world.dt
            start, stop = self.first[:, axis].tolist()
            low, high = change.ends(start, stop, duration)
            if not low < high:
                msg = (
                    f"Final box dimension due to fix deform is < 0.0: {_AXES[axis]} from {low:g} "
                    f"to {high:g} m"
                )
                raise InputError(msg)

    def lists_made(self, world: World, control: Control) -> None:
        """Note the box for which lists are made."""
        box = world.need_box()
        self.held = np.array([box.lo, box.hi])
        self._tell(world, control)

    def after(self, world: World, control: Control) -> None:
        """Change the box, and put the particles into it as they were."""
        if world.step % self.every == 0:
            box, target = world.need_box(), self._target(world)
            if not (target[0] < target[1]).all():
                raise SimulationError(
                    world.step, None, "the box has no length any more; change fix deform"
                )
            state, who = world.state, np.flatnonzero(world.member(self.bit))
            if self.remap:
                part = (1.0 / (box.hi - box.lo)) * (state.row[who, POSITION] - box.lo)
            box.lo, box.hi = target
            if self.remap:
                state.row[who, POSITION] = (box.hi - box.lo) * part + box.lo
        self._tell(world, control)

    def _tell(self, world: World, control: Control) -> None:
        """Tell the kernels the period, and how far particles may go until new lists."""
        box = world.need_box()
        period = box.period()
        control.real[three(LENGTH)] = period
        control.real[three(INVERSE)] = np.where(period > 0.0, 1.0 / (box.hi - box.lo), 0.0)
        if not period.any():
            return
        moved = np.array([box.lo, box.hi]) - self.held
        far = float(np.sqrt((moved * moved).sum(axis=1)).sum())
        reach = 0.5 * (world.neighbor.skin - far)
        control.real[TRIGGER2] = reach * reach

    def _target(self, world: World) -> Floats:
        """Return the corners of the box now, m."""
        box = world.need_box()
        found = np.array([box.lo, box.hi])
        begin, end = world.begin_step or 0, world.end_step or world.step
        passed = (world.step - begin) * world.dt
        for axis, change in self.changes.items():
            low, high = self.first[:, axis].tolist()
            if change.style in ("trate", "wiggle"):
                found[:, axis] = change.ends(low, high, passed)
            elif change.style == "variable":
                half = 0.5 * float(world.interpreter.value(change.variable))
                found[:, axis] = low - half, high + half
            elif change.style != "volume":
                part = (world.step - begin) / (end - begin) if end > begin else 0.0
                last = change.ends(low, high, (end - begin) * world.dt)
                found[:, axis] = low + part * (last[0] - low), high + part * (last[1] - high)
        for axis, change in self.changes.items():
            if change.style == "volume":
                self._keep_volume(axis, found)
        return found

    def _keep_volume(self, axis: int, found: Floats) -> None:
        """Set the bounds of a direction so that the volume stays."""
        start = self.first[1] - self.first[0]
        low, high = found
        now = high - low
        one, other = (axis + 1) % 3, (axis + 2) % 3
        kinds = [self.changes[d].style if d in self.changes else "" for d in (one, other)]
        volume = float(start[0] * start[1] * start[2])
        if "" in kinds:
            still, free = (one, other) if kinds[0] == "" else (other, one)
            length = volume / now[free] / start[still]
        elif "volume" in kinds:
            linked, free = (one, other) if kinds[0] == "volume" else (other, one)
            length = sqrt(volume / now[free] / start[linked] * start[axis])
        else:
            length = volume / now[one] / now[other]
        middle = 0.5 * (self.first[0, axis] + self.first[1, axis])
        found[:, axis] = middle - 0.5 * length, middle + 0.5 * length


def _remap(words: Words) -> bool:
    """Read whether particles move with the box."""
    word = words.choice(("x", "none", "v"), "remap")
    if word == "v":
        msg = "fix deform remap v: velocities of images are not changed; use 'remap x'"
        raise UnknownWordError(msg)
    return word == "x"
