"""``displace_atoms GROUP STYLE ...``: particles are put elsewhere."""

from __future__ import annotations

from math import cos, pi, sin, sqrt

import numpy as np

from minidem.commands.command import COMMANDS
from minidem.errors import InputError
from minidem.insertion.seeds import drawn_at, read_seed
from minidem.kernels.columns import POSITION, X, Y, Z
from minidem.run.engine import Engine
from minidem.words import Words
from minidem.world.periodic import wrapped
from minidem.world.state import Floats

_AXES = ("x", "y", "z")
_STYLES = ("move", "ramp", "random", "rotate")


@COMMANDS.register("displace_atoms")
def _displace_atoms(engine: Engine, words: Words) -> None:
    words.need(4, "displace_atoms GROUP move X Y Z [units box]")
    world = engine.world
    box, state = world.need_box(), world.state
    who = np.flatnonzero(world.member(world.bit(words.take("a group"))))
    engine.report.screen("Displacing atoms ...")
    style = words.choice(_STYLES, "style")
    wanted = _Displacement(words, style)
    if not words.done():
        words.expect("units")
        if words.choice(("box", "lattice"), "units") == "lattice":
            wanted.scale = world.lattice.spacing
    points = state.row[who, POSITION]
    changed = wanted.applied(points)
    if not np.isfinite(changed).all():
        msg = "displace_atoms: a particle would be put nowhere; the numbers are too large"
        raise InputError(msg)
    state.row[who, POSITION], turns = wrapped(box, changed)
    state.image[who] += turns


class _Displacement:
    """What the words ask for.

    Parameters
    ----------
    words : Words
        After the style.
    style : str
        One of `_STYLES`.
    """

    def __init__(self, words: Words, style: str) -> None:
        self.scale = np.ones(3)
        self._style = style
        self._axes = [0, 0]
        self._seed = 0
        if style == "ramp":
            self._axes[0] = _AXES.index(words.choice(_AXES, "axis"))
            self._numbers = words.numbers(2)
            self._axes[1] = _AXES.index(words.choice(_AXES, "axis"))
            self._numbers += words.numbers(2)
        elif style == "rotate":
            self._numbers = words.numbers(7)
            if not 0.0 < sqrt(sum(c * c for c in self._numbers[3:6])) < np.inf:
                msg = "Zero length rotation vector with displace_atoms"
                raise InputError(msg)
        else:
            self._numbers = words.numbers(3)
            if style == "random":
                self._seed = read_seed(words.take("a seed"))

    def applied(self, points: Floats) -> Floats:
        """Return points (n, 3) after the displacement."""
        if self._style == "move":
            moved: Floats = points + self.scale * np.array(self._numbers)
            return moved
        if self._style == "ramp":
            return self._ramp(points)
        if self._style == "rotate":
            return self._turned(points)
        reach = self.scale * np.array(self._numbers)
        drawn = np.array([drawn_at(self._seed, point, 3) for point in points]).reshape(-1, 3)
        found: Floats = points + reach * 2.0 * (drawn - 0.5)
        return found

    def _ramp(self, points: Floats) -> Floats:
        axis, along = self._axes
        low, high = (self.scale[axis] * c for c in self._numbers[:2])
        start, end = (self.scale[along] * c for c in self._numbers[2:])
        if start == end:
            msg = f"displace_atoms ramp: both coordinates are {start:g}"
            raise InputError(msg)
        part = np.clip((points[:, along] - start) / (end - start), 0.0, 1.0)
        found = points.copy()
        found[:, axis] += low + part * (high - low)
        return found

    def _turned(self, points: Floats) -> Floats:
        """Turn points about an axis through a point, by the right-hand rule."""
        centre = self.scale * np.array(self._numbers[:3])
        x, y, z = self._numbers[3:6]
        axis = np.array([x, y, z]) / sqrt(x * x + y * y + z * z)
        angle = pi * self._numbers[6] / 180.0
        d = points - centre
        length = d[:, X] * axis[X] + d[:, Y] * axis[Y] + d[:, Z] * axis[Z]
        along = length[:, None] * axis
        out = d - along
        found: Floats = centre + along + (out * cos(angle) + np.cross(axis, out) * sin(angle))
        return found
