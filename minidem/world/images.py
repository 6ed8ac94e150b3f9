"""Images of meshes beyond periodic faces of the box."""

from __future__ import annotations

from itertools import product

import numpy as np

from minidem.errors import InputError
from minidem.kernels.columns import FEATURES
from minidem.world.mesh.store import MeshStore
from minidem.world.mesh.surface import BORDER, corners_outside, feature_flags
from minidem.world.state import Box, Floats, Ints
from minidem.world.world import World

__all__ = ["drop_images", "image_rows", "make_images"]


def image_rows(nodes: Floats, lo: Floats, period: Floats, reach: float) -> tuple[Ints, Floats]:
    """Find the images of triangles that a particle in the box may touch.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3, 3)
        Triangles, m.
    lo, period : ndarray, shape (3,)
        Lower corner of the box, and its length in periodic directions, else 0, m.
    reach : float
        How far outside the box images matter, m.

    Returns
    -------
    ndarray of int64, shape (m,)
        Triangle of each image.
    ndarray, shape (m, 3)
        Its shift, m.
    """
    low, high = nodes.min(axis=1), nodes.max(axis=1)
    centre = nodes.mean(axis=1)
    # as in LIGGGHTS a triangle belongs where its centre is, and has images next to that
    home = np.where(period > 0.0, -np.floor((centre - lo) / np.where(period > 0.0, period, 1.0)), 0)
    base: list[Ints] = []
    shift: list[Floats] = []
    for way in product(*((-1, 0, 1) if length > 0.0 else (0,) for length in period)):
        steps = home + np.array(way)
        moved = steps * period
        outside = (low + moved > lo + period + reach) | (high + moved < lo - reach)
        wanted = ~(outside & (period > 0.0)).any(axis=1) & (steps != 0).any(axis=1)
        base.append(np.flatnonzero(wanted))
        shift.append(moved[wanted])
    return np.concatenate(base), np.concatenate(shift)


def drop_images(world: World) -> None:
    """Take all images away until the next run; contacts with them become the triangle's own."""
    if world.meshes.images:
        world.lists.renumber(world.meshes.drop_images(), None)


def make_images(world: World, reach: float) -> None:
    """Put the images of all meshes into the store, instead of those that are there.

    Contact histories follow: they are kept under the triangle itself.

    Raises
    ------
    InputError
        If a mesh that is in a run for the first time is not in the box.
    """
    store, box = world.meshes, world.need_box()
    drop_images(world)
    _check_inside(store, box)
    _tell_of_corners(world, box)
    earlier = store.settle(box.lo, box.hi)
    period = box.period()
    if not period.any() or not store.count:
        return
    base, shift = image_rows(store.table.node, box.lo, period, reach)
    store.add_images(base, shift)
    _share_flags(store, earlier, box.lo, box.hi)


def _check_inside(store: MeshStore, box: Box) -> None:
    """Refuse new meshes with triangles whose centre lies outside of the box, as LIGGGHTS does.

    Faces that follow what is in the box are no limit.
    """
    fixed = np.array([[side not in "sm" for side in face] for face in box.boundary])
    lo, hi = np.where(fixed.T, [box.lo - BORDER, box.hi + BORDER], [[-np.inf], [np.inf]])
    centre = store.table.node.mean(axis=1)
    outside = ((centre < lo) | (centre >= hi)).any(axis=1) & (store.table.owner >= store.settled)
    # np.unique would load NumPy's masked arrays, which takes a script of two grains 4 % more time
    for number in sorted(set(store.table.owner[outside].tolist())):
        own = store.table.owner == number
        msg = (
            f"mesh '{store.names[number]}': {(own & outside).sum()} of its {own.sum()} triangles "
            "lie outside of the box, where LIGGGHTS loses them: make the box larger, move or "
            "scale the mesh, or use 'boundary m m m'"
        )
        raise InputError(msg)


def _tell_of_corners(world: World, box: Box) -> None:
    """Warn of new meshes that reach out of the box, as LIGGGHTS does."""
    store = world.meshes
    new = store.table.owner >= store.settled
    out = corners_outside(store.table.node[new], box.lo, box.hi) != 0
    for number in sorted(set(store.table.owner[new][out].tolist())):
        world.warn(f"Not all nodes of mesh '{store.names[number]}' are inside the simulation box")


def _share_flags(store: MeshStore, first: int, lo: Floats, hi: Floats) -> None:
    """Decide which edges and corners take contacts where a mesh meets its images.

    As in LIGGGHTS a feature is active only if it is in the triangle and in all its images, and
    this is decided once, in the first run of a mesh; `first` is the number of the first such mesh.
    """
    table = store.table
    for m in range(first, len(store.names)):
        own = np.flatnonzero(table.owner == m)
        base = table.base[own]
        if (base == own).all():
            continue
        nodes = table.node[own]
        flags = feature_flags(nodes, store.limits[m], base - own[0], store.equal[m])
        flags |= corners_outside(nodes, lo, hi)  # the image whose corner is inside decides
        shared = np.full(len(table.node), FEATURES, np.int64)
        np.bitwise_and.at(shared, base, flags)
        table.flags[own] = (table.flags[own] & ~FEATURES) | shared[base]
