"""``fix ID all mesh/surface/stress/servo file FILE type T com X Y Z ctrlPV force ...``.

A mesh that a controller moves along an axis until the particles push it with a given force, or
turns about an axis until they turn it back with a given torque. The controller sees the force at
the end of a step and sets the velocity of the next one.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import copysign
from typing import Any, ClassVar, cast

import numpy as np

from minidem.errors import InputError
from minidem.fixes.mesh import MeshSurface
from minidem.fixes.move import MoveMesh, Mover, unit
from minidem.fixes.servo.steering import along, automatic_velocity, inverse, limited, target_of
from minidem.fixes.wall import WallGran
from minidem.kernels.columns import AXIS, FX, ORIGIN, RADIUS, TX, three
from minidem.kernels.motion.motion import KINDS
from minidem.record import field, record
from minidem.words import Words
from minidem.world.fix import FIXES
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["Servo"]

_CENTRE = (7, 10)  # index of the first coordinate of the reference point, as in LIGGGHTS twice
_GAINS = ("kp", "ki", "kd")
_FAR = 1e20
"""Smallest radius where there are no particles, as LIGGGHTS has it."""


@FIXES.register("mesh/surface/stress/servo")
@record
class Servo(MeshSurface, Mover):
    """A mesh under a force or a torque.

    Attributes
    ----------
    centre : ndarray or None, shape (3,)
        Reference point, m, which moves with the mesh.
    axis : ndarray, shape (3,)
        Direction in which it moves, or about which it turns; without one it rests.
    target : float or str
        Force wanted from the particles, N, or torque, N m, or a variable for it; at 0 it rests.
    fastest : float
        Largest speed of a node, m/s.
    gains : list of float
        Of the error, 1, its integral, 1/s, and the change of the force, s.
    controlled : str
        What the particles shall do: ``force`` or ``torque``.
    speed : ndarray, shape (3,)
        Velocity of the step to come, m/s, or its angular velocity, rad/s.
    given : ndarray, shape (3,)
        What the motion gets: the velocity, or the angular velocity about the axis in front.
    limit, least : float
        Largest component of `speed` along the axis; with ``mode auto`` that near particles.
    automatic : bool
        Whether the gain follows the error instead of `gains`: ``mode auto``.
    ratio : float
        Part of the smallest radius that it then moves at most in a step, near particles.
    summed, before : float
        Integral of the error, N s or N m s, and force or torque along the axis one step ago.
    moves : bool
        False after ``fix_modify ID integrate stop``.
    """

    centre: Floats | None = None
    axis: Floats = field(default_factory=lambda: np.zeros(3))
    target: float | str = 0.0
    fastest: float = 0.0
    gains: list[float] = field(default_factory=lambda: [0.01, 0.0, 0.0])
    controlled: str = ""
    speed: Floats = field(default_factory=lambda: np.zeros(3))
    given: Floats = field(default_factory=lambda: np.zeros(3))
    limit: float = 0.0
    least: float = 0.0
    automatic: bool = False
    ratio: float = 0.0
    summed: float = 0.0
    before: float = 0.0
    moves: bool = True

    keywords: ClassVar[tuple[str, ...]] = (
        "com", "ctrlPV", "axis", "target_val", "vel_max", "kp", "ki", "kd", "mode", "ratio",
    )  # fmt: skip

    def __post_init__(self) -> None:
        """Provide for its motion."""
        self._motion = MoveMesh(self.name, self.style, self.bit, self.name, KINDS.index("table"))
        self._motion.given = self.given
        self._looked = -1, False  # rebuild of the lists, and whether a particle was near then

    @classmethod
    def read(cls, world: World, head: Any, words: Words) -> Servo:
        """Read mesh and controller."""
        made = cast("Servo", super().read(world, head, words))
        missing = {
            "ctrlPV": not made.controlled, "com": made.centre is None,
            "vel_max": made.fastest == 0.0,
        }  # fmt: skip
        for word, is_missing in missing.items():
            if is_missing:
                msg = f"please define '{word}' for the mesh"
                raise InputError(msg)
        if made.automatic:
            if made.ratio == 0.0:
                msg = "please define 'ratio' for the mesh, since you use the auto mode"
                raise InputError(msg)
        elif min(made.gains) < 0.0 or not any(made.gains):
            msg = "kp, ki and kd must not be negative, nor all zero"
            raise InputError(msg)
        if not made.axis.any():
            world.warn(f"servo '{made.name}' has no axis; it rests, as in LIGGGHTS")
        elif made.target == 0.0:
            world.warn(
                f"servo '{made.name}' has no target_val; it rests, as in LIGGGHTS, until "
                f"'fix_modify {made.name} target_val ...' gives one"
            )
        if made.turns:
            made._motion.kind = KINDS.index("turn table")
            made._motion.numbers[three(ORIGIN)] = made.centre
            made._motion.numbers[three(AXIS)] = made.axis
        made.place(world)
        return made

    def read_own(self, key: str, words: Words) -> None:
        """Read a keyword of the controller."""
        if key == "com":
            self.centre = np.array(words.numbers(3))
        elif key == "ctrlPV":
            self.controlled = words.choice(("force", "torque"), key)
        elif key == "axis":
            self.axis = unit(words.numbers(3))
        elif key == "target_val":
            self.target = target_of(words)
        elif key == "vel_max":
            self.fastest = words.positive()
        elif key in _GAINS:
            self.gains[_GAINS.index(key)] = words.number()
        elif key == "mode":
            words.choice(("auto",), key)
            self.automatic = True
        else:
            self.ratio = words.number()

    @property
    def turns(self) -> bool:
        """Whether it turns instead of moving."""
        return self.controlled == "torque"

    def place(self, world: World) -> None:
        """Let torques refer to where the reference point will be."""
        ahead = self.speed * world.dt if self.moves and not self.turns else 0.0
        at = world.meshes.names.index(self.name)
        world.meshes.table.origin[at] = self._centre() + ahead

    def _centre(self) -> Floats:
        return np.zeros(3) if self.centre is None else self.centre

    def motion(self) -> MoveMesh | None:
        """Return its motion of this step; None while it rests."""
        return self._motion if self.moves else None

    def value(self, world: World, index: int) -> float:
        """Return force (1-3), torque (4-6) and reference point (7-9, 10-12)."""
        for first in _CENTRE:
            if first <= index < first + 3:
                return float(self._centre()[index - first])
        return super().value(world, index)

    def modify(self, world: World, words: Words) -> None:
        """Read what `fix_modify` changes: the target, the controller, and whether it moves."""
        known = ("integrate", "target_val", "ctrlParam", "vel_max", "ratio")
        both = [*known, *(f"servo/{word}" for word in known)]
        key = words.choice(both).removeprefix("servo/")
        if key == "integrate":
            self.moves = words.choice(("start", "stop"), key) == "start"
            self.slides = not self.moves  # as in LIGGGHTS it rubs on with its last velocity
            self.place(world)
        elif key == "target_val":
            self.target, self.summed = target_of(words), 0.0
        elif key == "vel_max":
            self.fastest = words.positive()
        elif key == "ratio":
            self.ratio = words.number()
        else:
            self.gains, self.summed = words.numbers(3), 0.0

    # -- a run -----------------------------------------------------------------------------------

    def check(self, world: World) -> None:
        """Refuse a servo without a wall, or one that is too fast for the lists."""
        if not any(self.name in wall.meshes for wall in world.of_kind(WallGran)):
            msg = f"the servo-wall '{self.name}' requires a contact model; use it in a wall/gran"
            raise InputError(msg)
        if self.fastest >= world.neighbor.skin / (2.0 * world.dt):
            msg = f"servo '{self.name}': vel_max < skin/(2.*dt) required; it is {self.fastest:g}"
            raise InputError(msg)

    def setup(self, world: World) -> None:
        """Work out how fast it may turn: where the mesh is now, so after a restart file is read."""
        super().setup(world)
        radii = world.state.row[: world.state.n, RADIUS]
        self.limit = self.fastest
        self.least = self.ratio * float(radii.min(initial=_FAR)) / world.dt
        if self.turns:
            arms = np.cross(self.axis, self._nodes(world) - self._centre())
            longest = float(np.linalg.norm(arms, axis=-1).max())
            if longest > 0.0:
                self.limit, self.least = self.limit / longest, self.least / longest

    def _nodes(self, world: World) -> Floats:
        """Return the nodes of the mesh, (n, 3, 3), m."""
        found: Floats = world.meshes.table.node[slice(*world.meshes.span(self.name))]
        return found

    def next_step(self, step: int) -> int:
        """Return the next step."""
        return step + 1

    def act(self, world: World) -> None:
        """Look at the force of this step and set the velocity of the next one."""
        if not self.moves:
            return
        if not self.turns:
            self.centre = self._centre() + world.dt * self.speed
        wanted = self.target
        if isinstance(wanted, str):
            wanted = -float(world.interpreter.value(wanted))
            if wanted == 0.0:
                msg = f"servo '{self.name}': target_val is zero"
                raise InputError(msg)
        force = self.load[three(TX if self.turns else FX)]
        if self.automatic:
            least = self.least if self._has_neighbours(world) else None
            self.speed[:] = automatic_velocity(self.axis, force, wanted, self.limit, least)
        else:
            self._control(self.axis, force, wanted, world.dt)
        self._pass_on()
        self.place(world)
        speed = self.speed
        if self.turns:
            speed = np.cross(speed, self._nodes(world) - self._centre())
        world.meshes.table.vel[slice(*world.meshes.span(self.name))] = speed

    def _control(self, axis: Floats, force: Floats, wanted: float, dt: float) -> None:
        """Work out the velocity; LIGGGHTS' order of operations."""
        kp, ki, kd = self.gains
        push = along(axis, force)
        error = wanted - push
        self.summed += error * dt
        change = -(push - self.before) / dt
        speed = -self.limit * (error * kp + self.summed * ki + change * kd) * inverse(wanted)
        self.before = push
        velocity, cut = limited(axis, speed, self.limit)
        self.speed[:] = velocity
        if cut and ki > 0.0:  # the integral does not wind up while the speed is limited
            self.summed = (-copysign(1.0, along(axis, velocity)) * wanted - error * kp) / ki

    def _has_neighbours(self, world: World) -> bool:
        """Whether the lists hold a particle near the mesh."""
        lists = world.lists
        if self._looked[0] != lists.builds:
            lo, hi = world.meshes.span(self.name)
            used = int(lists.walls.start[world.state.n])
            code = lists.walls.code[:used]
            own = world.meshes.table.base[code[code >= 0]]
            self._looked = lists.builds, bool(((own >= lo) & (own < hi)).any())
        return self._looked[1]

    def _pass_on(self) -> None:
        """Tell the motion the velocity of the next step."""
        if self.turns:
            self.given[0] = float(self.speed @ self.axis)
        else:
            self.given[:] = self.speed

    def variables_asked(self) -> tuple[str, ...]:
        """Return the names of the variables that it asks in a run."""
        return (self.target,) if isinstance(self.target, str) else ()

    def state(self) -> dict[str, Any]:
        """Return what the controller remembers."""
        return {
            "centre": self._centre().tolist(), "speed": self.speed.tolist(),
            "summed": self.summed, "before": self.before, "moves": self.moves,
        }  # fmt: skip

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Take what a controller remembered."""
        self.centre = np.array(saved["centre"])
        self.speed[:] = saved["speed"]
        self._pass_on()
        self.summed, self.before = float(saved["summed"]), float(saved["before"])
        self.moves, self.slides = bool(saved["moves"]), not saved["moves"]
