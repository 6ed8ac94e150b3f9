"""``fix ID GROUP move STYLE ...``: particles that move as told, whatever pushes them.

Styles are ``linear VX VY VZ``, ``wiggle AX AY AZ PERIOD``, ``rotate PX PY PZ RX RY RZ PERIOD`` and
``variable X Y Z VX VY VZ``; a component may be NULL, and then follows from the forces.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import cos, pi, sin
from typing import Any

import numpy as np

from minidem.errors import InputError, SimulationError
from minidem.fixes.carrier import Carrier
from minidem.fixes.integrate import Integrate
from minidem.fixes.move import unit
from minidem.kernels.columns import MASS, OMEGA, POSITION, TOTAL_FORCE, VELOCITY, X, Y, Z
from minidem.kernels.tables import Control
from minidem.record import field, record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.fix import FIXES
from minidem.world.state import Bools, Floats, Ints
from minidem.world.values.by_id import ById, places, warn_of_joined
from minidem.world.world import World

__all__ = ["MoveParticles"]

_STYLES = ("linear", "wiggle", "rotate", "variable")
_UNKNOWN = (np.nan, np.nan, np.nan)
_USUAL = {
    "linear": (3, "linear VX VY VZ"),
    "wiggle": (4, "wiggle AX AY AZ PERIOD"),
    "rotate": (7, "rotate PX PY PZ RX RY RZ PERIOD"),
    "variable": (6, "variable v_X v_Y v_Z v_VX v_VY v_VZ"),
}


@FIXES.register("move")
@record
class MoveParticles(Carrier):
    """Motion of the particles of a group.

    Attributes
    ----------
    motion : str
        One of `_STYLES`.
    given : ndarray, shape (3,)
        Velocity, m/s, amplitude or point on the axis, m.
    held : ndarray of bool, shape (3,)
        Which components the fix gives; the others follow from the forces.
    axis : ndarray, shape (3,)
        Direction of the axis, of length one.
    rate : float
        Angular frequency, rad/s.
    places, speeds : list of str or None
        Variables of displacements and velocities.
    begun : int
        Step at which the motion has begun.
    origin : ById
        Places then, without wrapping, m.
    """

    motion: str = "linear"
    given: Floats = field(default_factory=lambda: np.zeros(3))
    held: Bools = field(default_factory=lambda: np.ones(3, bool))
    axis: Floats = field(default_factory=lambda: np.zeros(3))
    rate: float = 0.0
    places: list[str | None] = field(default_factory=lambda: [None] * 3)
    speeds: list[str | None] = field(default_factory=lambda: [None] * 3)
    begun: int = 0
    origin: ById = field(default_factory=lambda: ById(_UNKNOWN))

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> MoveParticles:
        """Read the motion, and note where the particles are."""
        made = cls(*head, motion=words.choice(_STYLES, "style"), begun=world.step)
        count, usage = _USUAL[made.motion]
        words.need(count, f"fix ID GROUP move {usage}")
        if made.motion == "variable":
            made.places = [_name(words, world) for _ in range(3)]
            made.speeds = [_name(words, world) for _ in range(3)]
            pairs = zip(made.places, made.speeds, strict=True)
            made.held = np.array([bool(place or speed) for place, speed in pairs])
        elif made.motion == "rotate":
            made.given = np.array(words.numbers(3))
            made.axis = unit(words.numbers(3))
        else:
            for d in range(3):
                made.held[d] = words.peek() != "NULL"
                made.given[d] = words.number() if made.held[d] else _null(words)
        if made.motion in ("wiggle", "rotate"):
            made.rate = 2.0 * pi / _period(words)
        if not words.done():
            words.expect("units")
            if words.choice(("box", "lattice"), "units") == "lattice":
                made.given = made.given * world.lattice.spacing
        made.origin.keep(world, places(world, made.bit))
        return made

    def check(self, world: World) -> None:
        """Refuse particles that another fix moves too, but for an integrator that comes later.

        LIGGGHTS lets that one kick them from where they are put, in every step anew.
        """
        mine = world.member(self.bit)
        order = list(world.fixes)
        earlier = [
            one
            for one in world.of_kind(Integrate)
            if order.index(one.name) < order.index(self.name)
        ]
        for other in (*earlier, *world.of_kind(MoveParticles)):
            both = mine & world.member(other.bit)
            if other is not self and both.any():
                who = int(world.state.ids[int(np.argmax(both))])
                msg = (
                    f"particle {who} is in the groups of fix {self.name} (move) and of fix "
                    f"{other.name} ({other.style}), and would move twice a step; use groups that "
                    "do not overlap"
                )
                raise InputError(msg)

    def setup(self, world: World) -> None:
        """Warn of particles that have come into the group since."""
        warn_of_joined(world, f"fix {self.name} (move)", self.bit, self.origin)

    def before(self, world: World) -> None:
        """Put the particles where they belong in the coming step."""
        who, state = np.flatnonzero(world.member(self.bit)), world.state
        origin = self._origins(world, who)
        world.step += 1  # variables and times are those of the coming step
        place, speed = self._wanted(world, who, origin)
        world.step -= 1
        row, old = state.row, state.row[who, POSITION]
        if self.motion == "variable" or not self.held.all():
            before = row[who, VELOCITY]
            free = before + self._kick(world, who)
            speed = np.where(self.held, np.where(np.isnan(speed), before, speed), free)
            place = np.where(np.isnan(place), old + world.dt * speed, place)
        row[who, VELOCITY] = speed
        row[who, POSITION] = _near(place, old, world.need_box().period())
        if self.motion == "rotate":
            state.spin[who, OMEGA] = self.rate * self.axis

    def after(self, world: World, control: Control) -> None:
        """Make the second half kick of the components that follow from forces."""
        del control
        if not self.held.all():
            who = np.flatnonzero(world.member(self.bit))
            kick = np.where(self.held, 0.0, self._kick(world, who))
            world.state.row[who, VELOCITY] += kick

    def _kick(self, world: World, who: Ints) -> Floats:
        """Return half a step's change of velocity by the forces, m/s."""
        rate: Floats = 0.5 * world.dt / world.state.row[who, MASS]
        return rate[:, None] * world.state.force[who, TOTAL_FORCE]

    def _origins(self, world: World, who: Ints) -> Floats:
        """Return where particles were at the beginning; later ones are taken back in time."""
        rows = self.origin.seen(world)
        unknown = np.asarray(np.isnan(rows).any(axis=1))
        new = who[unknown[who]]
        if len(new) and self.motion == "variable":
            raise SimulationError(
                world.step, int(world.state.ids[new[0]]),
                f"came into the group of fix {self.name} (move variable) later; use another "
                "style, or define the fix behind it",
            )  # fmt: skip
        if unknown.any():
            rows = np.where(unknown[:, None], 0.0, rows)
            rows[new] = self._shifted(world, world.unwrapped()[new], -1.0)
            self.origin.keep(world, rows)
        return rows[who]

    def _shifted(self, world: World, points: Floats, sign: float) -> Floats:
        """Return points moved by the motion since its beginning, with sign -1 back."""
        time = (world.step - self.begun) * world.dt
        if self.motion == "linear":
            found: Floats = points + sign * (np.where(self.held, self.given, 0.0) * time)
        elif self.motion == "wiggle":
            found = points + sign * (np.where(self.held, self.given, 0.0) * sin(self.rate * time))
        else:
            along, out = self._split(points, sign * (self.rate * time))
            found = self.given + along + out
        return found

    def _split(self, points: Floats, angle: float) -> tuple[Floats, Floats]:
        """Return the parts along and across the axis of points that are turned about it."""
        d = points - self.given
        part = d[:, X] * self.axis[X] + d[:, Y] * self.axis[Y] + d[:, Z] * self.axis[Z]
        along = part[:, None] * self.axis
        out = d - along
        return along, out * cos(angle) + np.cross(self.axis, out) * sin(angle)

    def _wanted(self, world: World, who: Ints, origin: Floats) -> tuple[Floats, Floats]:
        """Return positions and velocities, not a number where forces give them."""
        if self.motion == "variable":
            places, speeds = (
                np.stack([self._column(world, who, name) for name in names], axis=1)
                for names in (self.places, self.speeds)
            )
            return origin + places, speeds
        time = (world.step - self.begun) * world.dt
        velocity = np.broadcast_to(self.given, origin.shape)
        if self.motion == "wiggle":
            velocity = self.given * self.rate * cos(self.rate * time) + np.zeros_like(origin)
        elif self.motion == "rotate":
            _, out = self._split(origin, self.rate * time)
            velocity = self.rate * np.cross(self.axis, out)
        place = self._shifted(world, origin, 1.0)
        return np.where(self.held, place, np.nan), velocity

    def _column(self, world: World, who: Ints, name: str | None) -> Floats:
        """Return a variable for some particles, not a number if there is none."""
        if name is None:
            return np.full(len(who), np.nan)
        if world.interpreter.variable_style(name) in ("atom", "atomfile"):
            values: Floats = world.interpreter.atom_values(name)[who]
            return values
        return np.full(len(who), float(world.interpreter.value(name)))

    def per_atom(self, world: World, name: str) -> Floats | None:
        """Return a coordinate of where the particles were at the beginning."""
        for column in range(3):
            if name == f"{self.name}[{column + 1}]":
                return np.nan_to_num(self.origin.rows(world)[:, column])
        return None

    def ids_changed(self, new: Mapping[int, int]) -> None:
        """Follow particles that have got new ids."""
        self.origin.ids_changed(new)

    def particles_copied(self, steps: Sequence[int]) -> None:
        """Give copies of particles the same values."""
        self.origin.copied(steps)

    def state(self) -> dict[str, Any]:
        """Return the beginning, and where the particles were then."""
        known = ~np.isnan(self.origin.values).any(axis=1)
        ids, values = self.origin.ids[known], self.origin.values[known]
        return {"begun": self.begun, "ids": ids.tolist(), "values": values.tolist()}

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Take them from a restart file."""
        self.begun = int(saved["begun"])
        self.origin.restore(saved)

    def steps_shifted(self, world: World, shift: int) -> None:
        """Say that as in LIGGGHTS it goes on counting from where it began."""
        if not shift:
            return
        world.warn(
            f"fix {self.name} (move) goes on counting from step {self.begun}; as in LIGGGHTS its "
            f"particles jump to where they are at step {world.step + shift}"
        )


def _name(words: Words, world: World) -> str | None:
    """Read ``v_NAME`` or NULL."""
    if words.peek() == "NULL":
        words.take("NULL")
        return None
    name = words.variable()
    if world.interpreter.variable_style(name) is None:
        msg = f"fix move: there is no variable '{name[:40]}'; define it before the fix"
        raise InputError(msg)
    return name


def _null(words: Words) -> float:
    """Read NULL."""
    words.take("NULL")
    return 0.0


def _period(words: Words) -> float:
    """Read a period that is not zero."""
    value = words.number()
    if value == 0.0:
        msg = "fix move: the period must not be zero"
        raise InputError(msg)
    return value


def _near(points: Floats, old: Floats, period: Floats) -> Floats:
    """Return the images of points that are nearest to where they were."""
    if not period.any():
        return points
    length = np.where(period > 0.0, period, np.inf)
    whole = np.trunc((points - old) / length)
    found = np.where(period > 0.0, points - whole * period, points)
    over = np.where(found - old > 0.5 * length, -period, 0.0)
    under = np.where(old - found > 0.5 * length, period, 0.0)
    near: Floats = found + over + under
    return near
