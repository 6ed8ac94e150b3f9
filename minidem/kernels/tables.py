"""The arrays that kernels work on, grouped by what they describe.

``n`` is the number of particles; arrays may be longer (``cap`` rows). What the columns of an array
mean stands in `minidem.kernels.columns`, under its name. All lengths in m, velocities in m/s,
spins in rad/s, forces in N, torques in N m, masses in kg, times in s.
"""

from __future__ import annotations

from typing import Any, NamedTuple

__all__ = [
    "Control",
    "Flows",
    "Mesh",
    "More",
    "Motions",
    "Pairs",
    "Particles",
    "Posts",
    "Team",
    "Walls",
]


class Particles(NamedTuple):
    """Rows of the particles, kept in spatial order.

    Attributes
    ----------
    row : float64 (cap, 8)
        Position, radius, velocity, mass.
    spin : float64 (cap, 4)
        Spin.
    force : float64 (cap, 8)
        Force and torque, and what the half kicks multiply them by.
    kind, mask, rank : int32, int32, int64 (cap,)
        Atom type counted from 0; group bits; as in `More`.
    held, liquid : float64 (cap, 3)
        Position at the last rebuild; liquid on the surface.
    flight : float64 (cap, 16)
        Of particles that an insertion stream still holds.
    """

    row: Any
    spin: Any
    force: Any
    kind: Any
    mask: Any
    held: Any
    flight: Any
    liquid: Any
    rank: Any


class More(NamedTuple):
    """Particle arrays that only a rebuild touches, and its working memory.

    Attributes
    ----------
    ids, rank : int64 (cap,)
        Particle ids; places in the order in which LIGGGHTS would hold the particles.
    density : float64 (cap,)
        kg/m3.
    image : int64 (cap, 3)
        Crossings of periodic faces.
    alive : uint8 (cap,)
        0 for particles that leave, else 1.
    first : int64 (cells,)
        First particle of each cell.
    order, where : int64 (cap,)
        Old row of each new one; cell of each particle.
    scratch, whole : float64 (cap, 16), int64 (cap, 4)
        Rows while they are put in a new order.
    cells, box : float64 (12,)
        The cells that neighbours are sought in; the box.
    ranges : int64 (flows, 3)
        Triangles of each flow mesh.
    needs : int64 (8,)
        Room that the lists need.
    """

    ids: Any
    rank: Any
    density: Any
    image: Any
    alive: Any
    first: Any
    order: Any
    where: Any
    scratch: Any
    whole: Any
    cells: Any
    box: Any
    ranges: Any
    needs: Any


class Pairs(NamedTuple):
    """Half neighbour list.

    Attributes
    ----------
    start : int64 (cap + 2,)
        Particle i owns the entries ``start[i]`` to ``start[i + 1]``.
    owner : uint32 (entries,)
        That particle once more.
    other : uint32 (entries,)
        The other particle.
    touch : uint8 (entries,)
        1 in contact, or joined by a liquid bridge.
    hist : float64 (entries, 3, 6, 7, 10 or 14)
        What contacts keep.
    soon : uint32 (entries,)
        The entries that may soon touch, those of a range of rows from ``start`` of its first on,
        see `minidem.kernels.near`.
    found : int64 (cap + 2,)
        At the first row of a range, how many; -1 if nearly all.
    """

    start: Any
    owner: Any
    other: Any
    touch: Any
    hist: Any
    soon: Any
    found: Any


class Walls(NamedTuple):
    """Wall candidates per particle, and the tables of primitive walls and meshes.

    Attributes
    ----------
    start : int64 (cap + 2,)
        As in `Pairs`.
    code : int32 (entries,)
        Triangle, or ``-1 - primitive wall``.
    touch : uint8 (entries,)
        Bits ``EARLIER`` and ``HANDLED``, and the place from ``PLACE_BIT`` on.
    hist, free : float64 (entries, 14), float64 (entries,)
        What contacts keep; up to which ``TRAVEL`` there can be no contact, m.
    prim, value : int64 (primitives, 25), float64 (primitives, 8)
        Primitive walls.
    mesh : int64 (meshes, 25)
        Model of each mesh.
    curve : float64 (meshes,)
        Cosine above which facets are coplanar.
    load : float64 (meshes + facets, 8)
        Force and torque of the particles on each mesh; then a row for each triangle of meshes that
        ask for it, with force and wear.
    """

    start: Any
    code: Any
    touch: Any
    hist: Any
    free: Any
    prim: Any
    value: Any
    mesh: Any
    curve: Any
    load: Any


class Mesh(NamedTuple):
    """Triangles of all meshes.

    Attributes
    ----------
    node, vel, edge : float64 (t, 3, 3)
        Nodes, their velocities, and unit vectors from node k to node k + 1.
    length : float64 (t, 3)
        Of the edges.
    normal : float64 (t, 3)
        Unit vector.
    flags : int64 (t,)
        Which edges and corners are active.
    bound : float64 (t,)
        Largest distance of a node from the centroid.
    owner, base : int64 (t,)
        Index of the mesh; the triangle itself, or the one of which this is an image.
    held : float64 (t, 3, 3)
        Nodes at the last rebuild.
    shift : float64 (t, 3)
        Of an image from its triangle.
    origin : float64 (meshes, 3)
        Reference points of torques.
    """

    node: Any
    vel: Any
    edge: Any
    length: Any
    normal: Any
    flags: Any
    bound: Any
    owner: Any
    held: Any
    base: Any
    shift: Any
    origin: Any


class Motions(NamedTuple):
    """Moving meshes, in the order of their fixes.

    Attributes
    ----------
    spec, value : int64 (moves, 8), float64 (moves, 104)
        Kind of motion, and its numbers.
    clock, table : float64 (moves,), float64 (steps, moves, 3)
        Time since the fix was made; velocities worked out from script variables.
    base : int64 (1,)
        Step of the first row of `table`.
    """

    spec: Any
    value: Any
    clock: Any
    table: Any
    base: Any


class Flows(NamedTuple):
    """Counters of particles through meshes.

    Attributes
    ----------
    pair : int64 (room, 3)
        Particles near flow meshes; sorted by flow.
    count, found : int64 (1,)
        Pairs and events in use.
    marker : int8 (flows, cap)
        ``UNSEEN``, ``BEFORE``, ``BEHIND`` or ``COUNTED``.
    spec, value : int64 (flows, 4), float64 (flows, 6)
        The counters.
    event : float64 (events, 12)
        Passages.
    """

    pair: Any
    count: Any
    marker: Any
    spec: Any
    value: Any
    event: Any
    found: Any


class Posts(NamedTuple):
    """What is done to forces after contacts, in the order of the fixes.

    Attributes
    ----------
    spec, value : int64 (posts, 4), float64 (posts, 8)
        Kind of force, and its numbers.
    total : float64 (posts, 3)
        Force on the particles before it was changed.
    """

    spec: Any
    value: Any
    total: Any


class Control(NamedTuple):
    """The state of the run loop, shared by Python and the kernels.

    Attributes
    ----------
    whole, real : int64 (64,), float64 (32,)
        Whole numbers, with values of `minidem.kernels.control`, and real ones.
    """

    whole: Any
    real: Any


class Team(NamedTuple):
    """What several threads share, see `minidem.kernels.step.team`; with one hardly anything.

    Attributes
    ----------
    sync, bound : int64 (words,), int64 (pieces + 1,)
        By which threads tell each other what to do; first row of each piece.
    spill : float64 (pieces, cap, 8)
        Forces on rows of later pieces.
    load : float64 (pieces, meshes + facets, 8)
        As ``Walls.load``.
    moved : float64 (16 pieces,)
        Of each piece the largest squared move and, in the next word, the largest squared speed.
    """

    sync: Any
    bound: Any
    spill: Any
    load: Any
    moved: Any
