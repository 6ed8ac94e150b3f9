"""Forces that are added or set after contacts, in the order of their fixes.

Those that the kernels know are a row of `minidem.kernels.tables.Posts`. The others, of which a
script variable or a region is a part, are worked out in Python once per step.
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from minidem.errors import InputError
from minidem.fixes.wall import WallGran
from minidem.kernels.columns import (
    POSITION,
    POST,
    POST_AXES,
    POST_GROUP,
    POST_KIND,
    POST_VALUE,
    three,
)
from minidem.kernels.motion.post import POST_KINDS, apply_range
from minidem.kernels.tables import Posts
from minidem.record import field, record
from minidem.world.fix import Fix, all_fixes
from minidem.world.state import Floats, Ints
from minidem.world.world import World

__all__ = [
    "ENERGY",
    "FORCE_BEFORE",
    "BodyForce",
    "add_forces",
    "gravity_leads",
    "late_forces",
    "needs_python",
    "post_tables",
    "store_forces",
]


ENERGY, FORCE_BEFORE = 0, three(1)
"""Places in `BodyForce.before`."""


@record
class BodyForce(Fix):
    """A force that is added or set after contacts.

    A subclass names its kernel, or works the force out in `apply`, or does both by turns.

    Attributes
    ----------
    numbers : ndarray, shape (8,)
        Row of ``Posts.value`` for the kernel.
    components : int
        A bit per component of the force that is set.
    region : str
        Only particles in this region; empty for all.
    before : ndarray, shape (4,)
        Potential energy, J, and total force on the particles before it was changed, N.
    """

    numbers: Floats = field(default_factory=lambda: np.zeros(POST_VALUE))
    components: int = 7
    region: str = ""
    before: Floats = field(default_factory=lambda: np.zeros(4))

    kernel: ClassVar[str] = ""
    """One of `POST_KINDS`; empty for a force that only `apply` works out."""
    indices: ClassVar[tuple[int, ...]] = ()
    """Indices that ``f_ID[i]`` has: 0 potential energy, 1 to 3 total force before this fix."""
    extensive: ClassVar[tuple[bool, bool]] = (True, True)
    sets: ClassVar[bool] = False
    """Whether it takes the place of the forces that were there."""

    def check(self, world: World) -> None:
        """Refuse a force that is set between two walls, as all walls act together here.

        In LIGGGHTS the walls behind it push on.
        """
        fixes = all_fixes(world)
        walls = [at for at, fix in enumerate(fixes) if isinstance(fix, WallGran)]
        here = next(at for at, fix in enumerate(fixes) if fix is self)
        if self.sets and walls and walls[0] < here < walls[-1]:
            msg = (
                f"fix {self.name} ({self.style}) stands between two fix wall/gran, so that in "
                "LIGGGHTS the later wall still pushes; minidem cannot do that: move it before the "
                "first or behind the last wall"
            )
            raise InputError(msg)

    def in_python(self) -> bool:
        """Return True if the force must be worked out by `apply` in every step."""
        return not self.kernel

    def apply(self, world: World) -> None:
        """Change ``world.state.force`` of the particles that `affected` returns."""
        raise NotImplementedError

    def potential(self, world: World) -> float:
        """Return the potential energy of the particles in this force, J."""
        del world
        return float(self.before[ENERGY])

    def value(self, world: World, index: int) -> float:
        """Return the potential energy (0) or the total force before this fix (1-3)."""
        if index not in self.indices:
            return super().value(world, index)
        return self.potential(world) if index == 0 else float(self.before[index])

    def affected(self, world: World) -> Ints:
        """Return the particles that this force acts on, shape (m,)."""
        chosen = world.member(self.bit)
        if self.region:
            if self.region not in world.regions:
                msg = f"Region ID '{self.region}' for fix {self.style} does not exist"
                raise InputError(msg)
            position = world.state.row[: world.state.n, POSITION]
            chosen = chosen & world.regions[self.region].match(position)
        return np.flatnonzero(chosen)


def post_tables(world: World) -> Posts:
    """Return the rows of all body forces, in the order of their fixes."""
    forces = world.of_kind(BodyForce)
    spec = np.zeros((len(forces), POST), np.int64)
    value = np.zeros((len(forces), POST_VALUE))
    for i, force in enumerate(forces):
        kind = POST_KINDS.index(force.kernel) if force.kernel else 0
        spec[i, [POST_KIND, POST_GROUP, POST_AXES]] = kind, force.bit, force.components
        value[i] = force.numbers
    return Posts(spec, value, np.zeros((len(forces), 3)))


def needs_python(world: World) -> bool:
    """Return True if there is a force that kernels cannot work out."""
    return any(force.in_python() for force in world.of_kind(BodyForce))


def gravity_leads(world: World) -> bool:
    """Return True if the first force after contacts is gravity and comes before all walls."""
    for fix in all_fixes(world):
        if isinstance(fix, BodyForce):
            return fix.kernel == "gravity" and not fix.in_python()
        if isinstance(fix, WallGran):
            return False
    return False


def late_forces(world: World) -> int:
    """Return the number of forces that come before the first wall, in the order of the script."""
    fixes = all_fixes(world)
    first = min((at for at, fix in enumerate(fixes) if isinstance(fix, WallGran)), default=0)
    early = sum(isinstance(fix, BodyForce) for fix in fixes[:first])
    return max(early, int(gravity_leads(world)))


def add_forces(world: World, table: Posts, first: int, last: int | None = None) -> None:
    """Apply the body forces from number `first` to before `last`, in the order of their fixes.

    Contact forces are there already. A variable sees the forces of the fixes before its own.

    Raises
    ------
    InputError
        If a region is not there any more.
    """
    state = world.state
    forces = world.of_kind(BodyForce)
    for p in range(first, len(forces) if last is None else last):
        if forces[p].in_python():
            forces[p].apply(world)
        else:
            apply_range(state.n, state.table(), table, p, p + 1)
            forces[p].before[FORCE_BEFORE] = table.total[p]


def store_forces(world: World, table: Posts) -> None:
    """Keep the total forces that kernels have found in their fixes."""
    for total, force in zip(table.total, world.of_kind(BodyForce), strict=True):
        force.before[FORCE_BEFORE] = total
