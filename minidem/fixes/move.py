"""``fix ID all move/mesh mesh MESH linear VX VY VZ``, or another of eight motions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import inf, pi, sqrt
from typing import Any

import numpy as np

from minidem.errors import InputError
from minidem.fixes.mesh import MeshSurface, known_mesh
from minidem.kernels.columns import (
    AXIS,
    LINEAR_VELOCITY,
    MOST_WAVES,
    MOTION_VALUE,
    ORIGIN,
    RIGGLE_AMPLITUDE,
    ROTATE_SPIN,
    WAVE,
    WAVES,
    WIGGLE_AMPLITUDE,
    WIGGLE_RATE,
    three,
)
from minidem.kernels.motion.motion import KINDS
from minidem.record import field, record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.fix import FIXES, Fix
from minidem.world.state import Floats
from minidem.world.values.named import need_names
from minidem.world.world import World

__all__ = ["MoveMesh", "Mover", "unit"]


class Mover:
    """A fix that moves a mesh, or lets it rest for a while."""

    def motion(self) -> MoveMesh | None:
        """Return how the mesh moves, None for not at all."""
        raise NotImplementedError


@FIXES.register("move/mesh", "move/mesh/gran")
@record
class MoveMesh(Fix, Mover):
    """A motion of a mesh.

    Attributes
    ----------
    mesh : str
        Mesh id.
    kind : int
        Place in `minidem.kernels.motion.motion.KINDS`.
    order : int
        Number of waves of a vibration.
    numbers : ndarray, shape (104,)
        Row of ``Motions.value``.
    clock : float
        Time since the fix was made, s.
    variables : list of str
        Variables that give the velocity, m/s or rad/s.
    given : ndarray or None, shape (3,)
        Velocity of a ``table`` without variables, m/s.
    """

    mesh: str
    kind: int = 0
    order: int = 0
    numbers: Floats = field(default_factory=lambda: np.zeros(MOTION_VALUE))
    clock: float = 0.0
    variables: list[str] = field(default_factory=list)
    given: Floats | None = None

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> MoveMesh:
        """Read the mesh and how it moves."""
        words.need(3, "fix ID all move/mesh mesh MESH linear VX VY VZ")
        words.expect("mesh")
        name = known_mesh(world, words.take("a mesh"))
        mesh = world.fixes[name]
        if isinstance(mesh, Mover):
            msg = f"mesh '{name}' is moved by its servo; move/mesh cannot be used on it"
            raise InputError(msg)
        if isinstance(mesh, MeshSurface) and mesh.slides:
            msg = "move/mesh cannot be used on a mesh with surface_vel or surface_ang_vel"
            raise InputError(msg)
        made = cls(*head, name)
        style = words.choice(tuple(_MOTIONS), "style")
        _MOTIONS[style](made, words)
        asked = [f"v_{name}" for name in made.variables]
        need_names(world, f"fix {head.style} {style}", asked, per_atom=False)
        return made

    def motion(self) -> MoveMesh:
        """Return this."""
        return self

    def variables_asked(self) -> tuple[str, ...]:
        """Return the names of the variables that it asks in a run."""
        return tuple(self.variables)

    def meshes_used(self) -> tuple[str, ...]:
        """Return the mesh that moves."""
        return (self.mesh,)

    def remove(self, world: World) -> None:
        """Let the mesh rest; of superposed motions the last one must go first."""
        motions = [move for move in world.of_kind(MoveMesh) if move.mesh == self.mesh]
        if motions[-1] is not self:
            msg = "superposed fix move/mesh commands must be unfixed in reverse order"
            raise InputError(msg)
        lo, hi = world.meshes.span(self.mesh)
        world.meshes.table.vel[lo:hi] = 0.0

    def state(self) -> dict[str, Any]:
        """Return clock and origin, which other motions of the mesh may have carried along."""
        return {"clock": self.clock, "origin": self.numbers[three(ORIGIN)].tolist()}

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Take clock and origin."""
        self.clock = float(saved["clock"])
        self.numbers[three(ORIGIN)] = saved.get("origin", self.numbers[three(ORIGIN)])


# -- the words of the motions ----------------------------------------------------------------------


def _given(words: Words, key: str, count: int) -> list[float]:
    """Read ``key v1 .. vn``."""
    words.expect(key)
    words.need(count, f"{key} " + "VALUE " * count)
    return words.numbers(count)


def _turns(words: Words, count: int) -> list[float]:
    """Read ``period T1 .. Tn``; return angular frequencies, rad/s."""
    periods = _given(words, "period", count)
    if not all(abs(period) > 1e-100 for period in periods):
        msg = f"period must not be zero, found {' '.join(f'{period:g}' for period in periods)}"
        raise InputError(msg)
    return [2.0 * pi / period for period in periods]


def unit(values: list[float]) -> Floats:
    """Return a unit vector; the order of operations is LIGGGHTS'."""
    x, y, z = values
    size = sqrt(x * x + y * y + z * z)
    if not 0.0 < size < inf:
        msg = f"axis {x:g} {y:g} {z:g} has no direction"
        raise InputError(msg)
    found: Floats = np.array(values) * (1.0 / size)
    return found


def _linear(move: MoveMesh, words: Words) -> None:
    move.kind = KINDS.index("linear")
    words.need(3, "linear VX VY VZ")
    move.numbers[three(LINEAR_VELOCITY)] = words.numbers(3)


def _linear_variable(move: MoveMesh, words: Words) -> None:
    move.kind = KINDS.index("table")
    words.need(3, "linear/variable v_VX v_VY v_VZ")
    move.variables = [words.variable() for _ in range(3)]


def _wiggle(move: MoveMesh, words: Words) -> None:
    move.kind = KINDS.index("wiggle")
    move.numbers[three(WIGGLE_AMPLITUDE)] = _given(words, "amplitude", 3)
    (move.numbers[WIGGLE_RATE],) = _turns(words, 1)


def _axis(move: MoveMesh, words: Words) -> None:
    move.numbers[three(ORIGIN)] = _given(words, "origin", 3)
    move.numbers[three(AXIS)] = unit(_given(words, "axis", 3))


def _rotate(move: MoveMesh, words: Words) -> None:
    move.kind = KINDS.index("rotate")
    _axis(move, words)
    (move.numbers[ROTATE_SPIN],) = _turns(words, 1)


def _rotate_variable(move: MoveMesh, words: Words) -> None:
    move.kind = KINDS.index("spin table")
    _axis(move, words)
    words.expect("omega")
    move.variables = [words.variable()]


def _riggle(move: MoveMesh, words: Words) -> None:
    _rotate(move, words)
    move.kind = KINDS.index("riggle")
    (degrees,) = _given(words, "amplitude", 1)
    move.numbers[RIGGLE_AMPLITUDE] = pi * degrees / 180.0


def _waves(move: MoveMesh, words: Words) -> None:
    """Read ``order n amplitude .. phase .. period ..``."""
    move.order = int(_given(words, "order", 1)[0])
    if not 1 <= move.order <= MOST_WAVES:
        msg = f"order {move.order} is not between 1 and {MOST_WAVES}"
        raise InputError(msg)
    for column, key in enumerate(("amplitude", "phase", "period")):
        read = _turns(words, move.order) if key == "period" else _given(words, key, move.order)
        move.numbers[WAVES + column : WAVES + WAVE * move.order : WAVE] = read


def _viblin(move: MoveMesh, words: Words) -> None:
    move.kind = KINDS.index("viblin")
    move.numbers[three(AXIS)] = unit(_given(words, "axis", 3))
    _waves(move, words)


def _vibrot(move: MoveMesh, words: Words) -> None:
    move.kind = KINDS.index("vibrot")
    _axis(move, words)
    _waves(move, words)


_MOTIONS: dict[str, Callable[[MoveMesh, Words], None]] = {
    "linear": _linear,
    "linear/variable": _linear_variable,
    "wiggle": _wiggle,
    "rotate": _rotate,
    "rotate/variable": _rotate_variable,
    "riggle": _riggle,
    "viblin": _viblin,
    "vibrot": _vibrot,
}
