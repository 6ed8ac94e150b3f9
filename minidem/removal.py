"""Taking fixes away."""

from __future__ import annotations

import numpy as np

from minidem.fixes.insert import Insert
from minidem.fixes.wall import MassFlow, MeshSurface, MoveMesh, WallGran
from minidem.world.images import drop_images
from minidem.world.world import World

__all__ = ["remove_fix"]


def remove_fix(world: World, name: str) -> None:
    """Take a fix away.

    Raises
    ------
    ValueError
        If another fix still needs it.
    """
    fix = world.fixes[name]
    if isinstance(fix, MeshSurface):
        _remove_mesh(world, name)
    elif isinstance(fix, WallGran) and not fix.meshes:
        walls = [w.name for w in world.of_kind(WallGran) if not w.meshes]
        gone = walls.index(name)
        new = np.array([i - (i > gone) if i != gone else -1 for i in range(len(walls))])
        world.lists.renumber(None, new.astype(np.int64))
    elif isinstance(fix, WallGran):
        world.lists.renumber(np.full(len(world.meshes.table.node), -1, np.int64), None)
    elif isinstance(fix, MoveMesh):
        later = [m for m in world.of_kind(MoveMesh) if m.mesh == fix.mesh]
        if later and later[-1] is not fix:
            msg = "superposed fix move/mesh commands must be unfixed in reverse order"
            raise ValueError(msg)
        lo, hi = world.meshes.span(fix.mesh)
        world.meshes.table.vel[lo:hi] = 0.0
    del world.fixes[name]
    if isinstance(fix, Insert) and not world.of_kind(Insert):
        # Particles of a stream that have not reached the face yet are free from now on.
        world.state.flight[: world.state.n, 4] = -1.0


def _remove_mesh(world: World, name: str) -> None:
    """Take a mesh away if no wall, motion or counter uses it."""
    for other in world.fixes.values():
        used = (isinstance(other, WallGran) and name in other.meshes) or (
            isinstance(other, MoveMesh | MassFlow) and other.mesh == name
        )
        if used:
            msg = f"fix {other.name} still uses the mesh '{name}'; unfix it first"
            raise ValueError(msg)
    drop_images(world)
    world.lists.renumber(world.meshes.remove(name), None)
