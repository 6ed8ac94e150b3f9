"""From the fixes of a world to the tables of the kernels."""

from __future__ import annotations

import numpy as np

from minidem.fixes.body import Integrate, Post
from minidem.fixes.variable_forces import needs_python, varies
from minidem.fixes.wall import MassFlow, MeshSurface, MoveMesh, WallGran
from minidem.kernels.control import REALS, WHOLES
from minidem.kernels.tables import Control, Motions, Posts
from minidem.world.state import Floats, Ints
from minidem.world.world import World

__all__ = [
    "fill_control",
    "flow_ranges",
    "flow_tables",
    "frozen_bit",
    "gravity_leads",
    "late_posts",
    "motion_tables",
    "nve_bit",
    "post_tables",
    "used_models",
    "wall_tables",
]

_W = {name: i for i, name in enumerate(WHOLES)}
_R = {name: i for i, name in enumerate(REALS)}
FREEZE = 4  # kind of a Post


def used_models(world: World) -> list[list[int]]:
    """Return the switches of the pair style and of all walls."""
    found = [world.pair.switches] if world.pair.switches is not None else []
    return found + [wall.switches for wall in world.of_kind(WallGran)]


def primitive_walls(world: World) -> list[WallGran]:
    """Return the primitive walls in the order of the script."""
    return [wall for wall in world.of_kind(WallGran) if not wall.meshes]


def wall_tables(world: World, base: tuple[int, ...]) -> tuple[Ints, Floats, Ints, Floats]:
    """Return the tables of primitive walls and of meshes, see `minidem.kernels.tables.Walls`.

    `base` are the nine switches of the model that the loop is compiled for.
    """
    usual = (*base, 0, 0)
    walls = primitive_walls(world)
    prim = np.zeros((len(walls), 17), np.int64)
    value = np.zeros((len(walls), 8))
    for i, wall in enumerate(walls):
        prim[i, :5] = wall.shape, wall.axis, wall.kind - 1, wall.bit, int(wall.turning)
        prim[i, 5:16] = wall.switches
        prim[i, 16] = int(tuple(wall.switches) == usual)
        value[i] = wall.value
    names = world.meshes.names
    mesh = np.zeros((len(names), 17), np.int64)
    curve = np.ones(len(names))
    moving = {move.mesh for move in world.of_kind(MoveMesh)}
    for i, name in enumerate(names):
        fix = world.fixes[name]
        if isinstance(fix, MeshSurface):
            mesh[i, 2] = fix.kind - 1
            mesh[i, 4] = int(fix.slides or name in moving)
            curve[i] = fix.limit
    for wall in world.of_kind(WallGran):
        for name in wall.meshes:
            at = names.index(name)
            mesh[at, 0] = 1
            mesh[at, 5:16] = wall.switches
            mesh[at, 16] = int(tuple(wall.switches) == usual)
    return prim, value, mesh, curve


def motion_tables(world: World) -> Motions:
    """Return the motions in the order of their fixes; clocks are copies."""
    moves = world.of_kind(MoveMesh)
    spec = np.zeros((len(moves), 8), np.int64)
    value = np.zeros((len(moves), 104))
    clock = np.zeros(len(moves))
    seen: set[str] = set()
    for i, move in enumerate(moves):
        lo, hi = world.meshes.span(move.mesh)
        spec[i, :5] = move.kind, lo, hi, int(move.mesh not in seen), move.order
        value[i] = move.value
        clock[i] = move.clock
        seen.add(move.mesh)
    return Motions(spec, value, clock, np.zeros((1, len(moves), 3)), np.zeros(1, np.int64))


def post_tables(world: World) -> Posts:
    """Return forces added after contacts, in the order of their fixes."""
    posts = world.of_kind(Post)
    spec = np.zeros((len(posts), 4), np.int64)
    value = np.zeros((len(posts), 8))
    for i, post in enumerate(posts):
        spec[i, :3] = post.kind, post.bit, post.flags
        value[i, : len(post.value)] = post.value
    return Posts(spec, value, np.zeros((len(posts), 3)))


def gravity_leads(world: World) -> bool:
    """Return True if the first force after contacts is gravity and comes before all walls."""
    for fix in world.fixes.values():
        if isinstance(fix, Post):
            return fix.kind == 0 and not varies(fix)
        if isinstance(fix, WallGran):
            return False
    return False


def late_posts(world: World) -> int:
    """Return the number of forces that come before the first wall, in the order of the script."""
    walls = [at for at, fix in enumerate(world.fixes.values()) if isinstance(fix, WallGran)]
    first = min(walls, default=0)
    early = sum(isinstance(fix, Post) for fix in list(world.fixes.values())[:first])
    return max(early, int(gravity_leads(world)))


def nve_bit(world: World) -> int:
    """Return the group bits that are integrated, 0 if there is no integrator."""
    found = 0
    for fix in world.of_kind(Integrate):
        found |= fix.bit
    return found


def frozen_bit(world: World) -> int:
    """Return the group bit of ``fix freeze``, 0 if there is none."""
    return next((post.bit for post in world.of_kind(Post) if post.kind == FREEZE), 0)


def flow_ranges(world: World) -> Ints:
    """Return triangle range and motion of every flow mesh, shape (flows, 3)."""
    moving = {move.mesh for move in world.of_kind(MoveMesh)}
    rows = [
        (*world.meshes.span(flow.mesh), int(flow.mesh in moving))
        for flow in world.of_kind(MassFlow)
    ]
    return np.array(rows, np.int64).reshape(-1, 3)


def flow_tables(world: World) -> tuple[Ints, Floats]:
    """Return the tables of flow counters, see `minidem.kernels.tables.Flows`."""
    flows = world.of_kind(MassFlow)
    spec = np.zeros((len(flows), 4), np.int64)
    value = np.zeros((len(flows), 6))
    for i, flow in enumerate(flows):
        lo, _ = world.meshes.span(flow.mesh)
        normal = world.meshes.table.normal[lo]
        spec[i] = int(flow.once), flow.bit, lo, int(flow.delete)
        value[i, :3] = world.meshes.table.node[lo, 0]
        value[i, 3:] = normal if float(normal @ flow.side) >= 0.0 else -normal
    return spec, value


def fill_control(world: World, control: Control) -> None:
    """Write the numbers that do not change within a run."""
    whole, real = control.whole, control.real
    near = world.neighbor
    whole[_W["delay"]] = near.delay
    whole[_W["every"]] = near.every
    whole[_W["check"]] = int(near.check)
    whole[_W["clear"]] = int(near.reach > 1.0)
    whole[_W["nve"]] = nve_bit(world)
    whole[_W["frozen"]] = frozen_bit(world)
    whole[_W["types"]] = world.types
    whole[_W["motions"]] = len(world.of_kind(MoveMesh))
    whole[_W["flows"]] = len(world.of_kind(MassFlow))
    whole[_W["leading"]] = int(gravity_leads(world))
    outside = needs_python(world)
    whole[_W["outside"]] = int(outside)
    whole[_W["late"]] = late = late_posts(world)
    # forces worked out in Python are not the kernels' business
    whole[_W["posts"]] = late if outside else len(world.of_kind(Post))
    real[_R["dt"]] = world.dt
    real[_R["trigger2"]] = 0.25 * near.skin * near.skin
    real[_R["reach2"]] = near.reach * near.reach
    real[_R["skin"]] = near.skin
    real[_R["reach"]] = near.reach
