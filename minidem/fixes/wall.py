"""``fix ID all wall/gran model MODEL ... mesh n_meshes N meshes ID ...``, or a primitive wall.

Primitive walls are ``primitive type T zplane Z`` and ``primitive type T zcylinder R X Y``, along
any axis, with ``shear AXIS SPEED``.
"""

from __future__ import annotations

import numpy as np

from minidem.contact.model import parse_model, parse_settings
from minidem.errors import InputError
from minidem.fixes.facets import facet_rows
from minidem.fixes.mesh import MeshSurface, known_mesh
from minidem.fixes.motions import moving_meshes
from minidem.fixes.move import MoveMesh
from minidem.kernels.columns import (
    BASIC_SWITCHES,
    COHESION,
    MESH_FACETS,
    MESH_GROUP,
    MESH_MOVES,
    MESH_ROW,
    SWITCHES,
    WALL,
    WALL_AXIS,
    WALL_GROUP,
    WALL_SHAPE,
    WALL_SPIN,
    WALL_SWITCHES,
    WALL_TURNS,
    WALL_TYPE,
    WALL_USUAL,
    WALL_VALUE,
    WALL_VELOCITY,
)
from minidem.kernels.models import EASO
from minidem.record import field, record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.fix import FIXES, Fix
from minidem.world.state import Floats, Ints
from minidem.world.world import World

__all__ = ["WallGran", "mesh_walls", "primitive_walls", "rest_meshes", "used_models", "wall_tables"]

_AXES = ("x", "y", "z")
_SHAPES = ("plane", "cylinder")
_KEPT_FOR_OTHERS = (
    "store_force", "store_force_contact", "store_force_contact_every",
    "store_force_contact_stress", "track_energy", "allow_special_domain_periodic", "contact_area",
)  # fmt: skip


@FIXES.register("wall/gran")
@record
class WallGran(Fix):
    """A wall of meshes or one primitive wall.

    Attributes
    ----------
    switches : list of int
        Model, see `minidem.kernels.contact.records.Switches`.
    meshes : list of str
        Mesh ids, empty for a primitive wall.
    shape, axis : int
        0 plane 1 cylinder; direction.
    kind : int
        Atom type, from 1.
    numbers : ndarray, shape (8,)
        Row of ``Walls.value``.
    turning : bool
        True if a cylinder turns about its axis.
    """

    switches: list[int]
    meshes: list[str] = field(default_factory=list)
    shape: int = 0
    axis: int = 2
    kind: int = 1
    numbers: Floats = field(default_factory=lambda: np.zeros(WALL_VALUE))
    turning: bool = False

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> WallGran:
        """Read the model, the wall and the settings of the model, in this order."""
        switches, rest = parse_model(words.rest())
        words = Words(rest, "fix wall/gran")
        if switches[COHESION] == EASO:
            msg = (
                "'cohesion easo/capillary/viscous' is for pairs only, as the manual has it; "
                "LIGGGHTS 3.8.0 takes the velocity of such a wall from memory that is not its own: "
                "leave it out of the wall, or take washino/capillary/viscous"
            )
            raise InputError(msg)
        made = cls(*head, switches)
        made.read_options(words)
        if words.done():
            msg = "expected 'mesh' or 'primitive' after the model"
            raise InputError(msg)
        if words.peek() == "mesh":
            made.read_meshes(world, words)
        elif words.peek() == "primitive":
            made.read_primitive(words)
        else:
            first = words.peek()
            parse_settings(rest[:2], list(switches))
            msg = f"Unknown argument or wrong keyword order: '{first}'; settings come last"
            raise InputError(msg)
        made.read_options(words)
        parse_settings(words.rest(), switches)
        if not 1 <= made.kind <= world.types:
            msg = f"wall type {made.kind} is not between 1 and {world.types}"
            raise InputError(msg)
        return made

    def read_options(self, words: Words) -> None:
        """Read what LIGGGHTS keeps for other fixes, and what makes no difference on one core."""
        while words.peek() in _KEPT_FOR_OTHERS:
            key = words.choice(_KEPT_FOR_OTHERS)
            if key == "track_energy":
                continue
            if key == "store_force_contact_every":
                words.interval()
            elif key == "contact_area":  # for the conduction of heat
                if words.choice(("overlap", "projection", "constant"), key) == "constant":
                    words.positive()
            elif words.yes_no() and key == "store_force":
                msg = (
                    "fix wall/gran: 'store_force yes' is not supported; put 'fix a all "
                    "store/force' before the walls and 'fix b all store/force' behind them: the "
                    "force of the walls on a particle is f_b[1]-f_a[1] and so on"
                )
                raise InputError(msg)

    def read_meshes(self, world: World, words: Words) -> None:
        """Read ``mesh n_meshes N meshes ID ...``."""
        words.need(5, "mesh n_meshes N meshes ID ...")
        words.expect("mesh", "n_meshes")
        count = words.integer()
        words.expect("meshes")
        words.need(count, f"mesh n_meshes {count} meshes " + "ID " * count)
        self.meshes = [known_mesh(world, words.take("a mesh")) for _ in range(count)]
        self._check_groups(world)
        if any(other.meshes for other in world.of_kind(WallGran)):
            msg = "only one wall/gran of type mesh is allowed; list all meshes in it with n_meshes"
            raise InputError(msg)

    @property
    def number(self) -> int:
        """Number of its group, 0 for all."""
        return self.bit.bit_length() - 1

    def _check_groups(self, world: World) -> None:
        """Refuse a mesh that particles of other groups touch, but which is told of its own only."""
        for name in self.meshes:
            fix = world.fixes[name]
            others = self.number & ~fix.bit if fix.bit != world.bit("all") else 0
            if others and isinstance(fix, MeshSurface) and (fix.stress or fix.wears):
                msg = (
                    f"mesh '{name}' and its wall are of groups other than all; in LIGGGHTS others "
                    "touch it, too, and force, stress and wear count its own group only: give the "
                    "wall group all"
                )
                raise InputError(msg)

    def read_primitive(self, words: Words) -> None:
        """Read ``primitive type T SHAPE VALUES [shear AXIS SPEED]``."""
        words.need(5, "primitive type T zplane Z")
        words.expect("primitive", "type")
        self.kind = words.integer()
        shapes = [axis + shape for axis in _AXES for shape in _SHAPES]
        shape = words.choice(shapes, "primitive")
        self.axis, self.shape = divmod(shapes.index(shape), len(_SHAPES))
        count = 3 if self.shape else 1
        across = " ".join(axis.upper() for k, axis in enumerate(_AXES) if k != self.axis)
        usage = f"RADIUS {across}" if self.shape else _AXES[self.axis].upper()
        words.need(count, f"primitive type T {shape} {usage}")
        self.numbers[:count] = words.numbers(count)
        if words.peek() == "shear":
            words.expect("shear")
            axis = _AXES.index(words.choice(_AXES, "shear direction"))
            speed = words.number()
            self.turning = self.shape == 1 and axis != self.axis
            if self.turning:
                self.numbers[WALL_SPIN] = speed  # LIGGGHTS takes the number as spin, rad/s
            else:
                self.numbers[WALL_VELOCITY + axis] = speed

    def meshes_used(self) -> tuple[str, ...]:
        """Return the meshes that particles touch."""
        return tuple(self.meshes)

    def material_types(self) -> tuple[int, ...]:
        """Return the type of a primitive wall; meshes have types of their own."""
        return () if self.meshes else (self.kind,)

    def remove(self, world: World) -> None:
        """Let contacts with this wall end, and those with other primitive walls follow them."""
        if self.meshes:
            world.lists.renumber(np.full(len(world.meshes.table.node), -1, np.int64), None)
            return
        walls = primitive_walls(world)
        gone = next(i for i, wall in enumerate(walls) if wall is self)
        new = np.arange(len(walls))
        new[gone:] -= 1
        new[gone] = -1
        world.lists.renumber(None, new)


def primitive_walls(world: World) -> list[WallGran]:
    """Return the primitive walls in the order of the script."""
    return [wall for wall in world.of_kind(WallGran) if not wall.meshes]


def mesh_walls(world: World) -> list[WallGran]:
    """Return the walls of meshes in the order of the script."""
    return [wall for wall in world.of_kind(WallGran) if wall.meshes]


def meshes_of_the_last_wall(world: World) -> tuple[str, ...]:
    """Return the meshes of the wall of meshes that came last; none without one."""
    walls = mesh_walls(world)
    return tuple(walls[-1].meshes) if walls else ()


def used_models(world: World) -> list[list[int]]:
    """Return the switches of the pair style and of all walls."""
    found = [world.pair.switches] if world.pair.switches is not None else []
    return found + [wall.switches for wall in world.of_kind(WallGran)]


def wall_tables(world: World, base: tuple[int, ...]) -> tuple[Ints, Floats, Ints, Floats]:
    """Return the tables of primitive walls and of meshes, see `minidem.kernels.tables.Walls`.

    `base` are the basic switches of the model that the loop is compiled for.
    """
    usual = (*base, *(0,) * (SWITCHES - BASIC_SWITCHES))
    walls = primitive_walls(world)
    prim = np.zeros((len(walls), WALL), np.int64)
    value = np.zeros((len(walls), WALL_VALUE))
    for i, wall in enumerate(walls):
        prim[i, WALL_SHAPE] = wall.shape
        prim[i, WALL_AXIS] = wall.axis
        prim[i, WALL_TYPE] = wall.kind - 1
        prim[i, WALL_GROUP] = wall.bit
        prim[i, WALL_TURNS] = wall.turning
        prim[i, WALL_SWITCHES] = wall.switches
        prim[i, WALL_USUAL] = int(tuple(wall.switches) == usual)
        value[i] = wall.numbers
    names = world.meshes.names
    mesh = np.zeros((len(names), WALL), np.int64)
    moving = moving_meshes(world)
    rows = facet_rows(world)
    for i, name in enumerate(names):
        fix = world.fixes[name]
        if isinstance(fix, MeshSurface):
            mesh[i, WALL_TYPE] = fix.kind - 1
            mesh[i, MESH_MOVES] = int(fix.slides or name in moving)
            mesh[i, MESH_FACETS] = int(fix.facets is not None)
            mesh[i, MESH_ROW] = rows.get(name, 0)
    for wall in world.of_kind(WallGran):
        for name in wall.meshes:
            at = names.index(name)
            # As in LIGGGHTS: bits of the mesh's group, but the number of the wall's group.
            mesh[at, MESH_GROUP] = world.fixes[name].bit | wall.number
            mesh[at, WALL_SWITCHES] = wall.switches
            mesh[at, WALL_USUAL] = int(tuple(wall.switches) == usual)
    return prim, value, mesh, np.array(world.meshes.limits, np.float64)


def rest_meshes(world: World, *, before_walls: bool) -> None:
    """Zero the velocity that meshes still have from the run before, at the start of a run.

    LIGGGHTS does so in the order of the fixes, and walls work out forces in that order.

    Parameters
    ----------
    world : World
        Meshes, motions and walls.
    before_walls : bool
        Only those whose motion was defined before their wall; otherwise all that have a motion.
    """
    order = {name: i for i, name in enumerate(world.fixes)}
    table = world.meshes.table
    for move in world.of_kind(MoveMesh):
        first = any(
            move.mesh in wall.meshes and order[move.name] < order[wall.name]
            for wall in world.of_kind(WallGran)
        )
        if first or not before_walls:
            table.vel[table.owner == world.meshes.names.index(move.mesh)] = 0.0
