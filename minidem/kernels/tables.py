"""The arrays that kernels work on, grouped by what they describe.

``n`` is the number of particles; arrays may be longer. All lengths in m, velocities in m/s,
spins in rad/s, forces in N, torques in N m, masses in kg, times in s.
"""

from __future__ import annotations

from typing import Any, NamedTuple

__all__ = [
    "Bodies",
    "Control",
    "Flows",
    "Lists",
    "Mesh",
    "More",
    "Motions",
    "Pairs",
    "Particles",
    "Posts",
    "Scene",
    "Tables",
    "Team",
    "Walls",
]


class Particles(NamedTuple):
    """Rows of the particles, kept in spatial order."""

    row: Any  # float64 (cap, 8): x y z radius vx vy vz mass
    spin: Any  # float64 (cap, 4): wx wy wz 0
    force: Any  # float64 (cap, 8): fx fy fz tx ty tz 0 0
    kind: Any  # int32 (cap,): atom type counted from 0
    mask: Any  # int32 (cap,): group bits
    held: Any  # float64 (cap, 3): position at the last rebuild
    flight: (
        Any  # float64 (cap, 16): x0(3) start stop v(3) final v(3) final w(3) 0 0; stop < 0: none
    )


class More(NamedTuple):
    """Particle arrays that only a rebuild touches, and its working memory."""

    ids: Any  # int64 (cap,)
    rank: Any  # int64 (cap,)
    density: Any  # float64 (cap,)
    image: Any  # int64 (cap, 3)
    alive: Any  # uint8 (cap,): ones
    first: Any  # int64 (cells,)
    order: Any  # int64 (cap,)
    where: Any  # int64 (cap,)
    scratch: Any  # float64 (cap, 16)
    whole: Any  # int64 (cap, 4)
    cells: Any  # float64 (12,)
    box: Any  # float64 (12,): lower and upper corner, periodic(3), 1 if faces move
    ranges: Any  # int64 (flows, 3): triangle range and 1 if moving, of each flow mesh
    needs: Any  # int64 (8,): room that the lists need, see `minidem.kernels.lists.rebuild`


class Pairs(NamedTuple):
    """Half neighbour list: particle i owns entries ``start[i]`` to ``start[i + 1]``."""

    start: Any  # int64 (cap + 1,)
    other: Any  # uint32 (cap_pairs,)
    touch: Any  # uint8 (cap_pairs,)
    hist: Any  # float64 (cap_pairs, 3, 6 or 7): displacement, spring torque, impact speed


class Walls(NamedTuple):
    """Wall candidates per particle, and the tables of primitive walls and meshes."""

    start: Any  # int64 (cap + 1,)
    code: Any  # int32 (cap_walls,): triangle, or -1 - primitive wall
    touch: Any  # uint8 (cap_walls,): bit 0 in contact since before, bit 1 handled in this step
    hist: Any  # float64 (cap_walls, 7): displacement, spring torque, impact speed
    prim: Any  # int64 (primitives, 17): shape axis type groupbit shear switches(11) usual
    value: Any  # float64 (primitives, 8): offset or radius, centre(2), wall velocity(3), spin
    mesh: Any  # int64 (meshes, 17): active 0 type 0 moving switches(11) usual
    # usual: 1 if the model is the one that the loop is compiled for
    curve: Any  # float64 (meshes,): cosine above which facets are coplanar
    load: Any  # float64 (meshes, 8): force and torque of the particles on the mesh


class Mesh(NamedTuple):
    """Triangles of all meshes."""

    node: Any  # float64 (t, 3, 3)
    vel: Any  # float64 (t, 3, 3): node velocities
    edge: Any  # float64 (t, 3, 3): unit vectors from node k to node k + 1
    length: Any  # float64 (t, 3)
    normal: Any  # float64 (t, 3)
    flags: Any  # int64 (t,): bits 0-2 edge active, 3-5 corner active, 6 obtuse at node 2
    bound: Any  # float64 (t,): largest distance of a node from the centroid
    owner: Any  # int64 (t,): index of the mesh
    held: Any  # float64 (t, 3, 3): nodes at the last rebuild
    base: Any  # int64 (t,): the triangle itself, or the one of which this is an image
    shift: Any  # float64 (t, 3): of an image from its triangle
    origin: Any  # float64 (meshes, 3): reference points of torques


class Motions(NamedTuple):
    """Moving meshes, in the order of their fixes."""

    spec: Any  # int64 (moves, 8): kind first-triangle last-triangle is-first order
    value: Any  # float64 (moves, 104): see `minidem.kernels.motion.motion`
    clock: Any  # float64 (moves,): time since the fix was made
    table: Any  # float64 (steps, moves, 3): velocities worked out from script variables
    base: Any  # int64 (1,): step of the first row of the table


class Flows(NamedTuple):
    """Counters of particles through meshes."""

    pair: Any  # int64 (cap, 3): flow, triangle, particle; sorted by flow
    count: Any  # int64 (1,): pairs in use
    marker: Any  # int8 (flows, cap): -1 unseen 0 before 1 behind 2 counted for good
    spec: Any  # int64 (flows, 4): once, group bit, first triangle, delete
    value: Any  # float64 (flows, 6): reference point, side normal
    event: Any  # float64 (events, 12): flow particle step x y z vx vy vz radius mass 0
    found: Any  # int64 (1,): events in use


class Posts(NamedTuple):
    """What is done to forces after contacts, in the order of the fixes."""

    spec: Any  # int64 (posts, 4): kind group bit flags
    value: Any  # float64 (posts, 8)
    total: Any  # float64 (posts, 3): force on the particles before it was changed


class Control(NamedTuple):
    """The state of the run loop, shared by Python and the kernels."""

    whole: Any  # int64 (64,): see `minidem.kernels.control`
    real: Any  # float64 (24,)


class Team(NamedTuple):
    """What several threads share, see `minidem.kernels.step.team`; with one hardly anything."""

    sync: Any  # int64 (words,)
    bound: Any  # int64 (pieces + 1,): first row of each piece
    spill: Any  # float64 (pieces, cap, 8): forces on rows of later pieces
    load: Any  # float64 (pieces, meshes, 8): as Walls.load
    moved: Any  # float64 (16 pieces,): largest squared move


class Lists(NamedTuple):
    """One of the two sets of lists: that in use, or the spare one that a rebuild fills."""

    pairs: Pairs
    walls: Walls


class Bodies(NamedTuple):
    """What the loops over contacts have in common.

    Calls between kernels hand over every array of every table, so they get no more than they need.

    Attributes
    ----------
    coef : float64 (types**2, columns)
        Coefficients of every ordered pair of types, see `minidem.kernels.columns`.
    """

    control: Control
    parts: Particles
    coef: Any


class Scene(NamedTuple):
    """What the phases of a step work on besides the lists; `coef` as in `Bodies`."""

    control: Control
    parts: Particles
    mesh: Mesh
    posts: Posts
    coef: Any
    team: Team


class Tables(NamedTuple):
    """All that the run loop works on.

    Attributes
    ----------
    first, second : Lists
        The two sets of lists; ``TURNED`` in ``control`` says which is in use.
    coef : float64 (types**2, columns)
        As in `Bodies`.
    """

    control: Control
    parts: Particles
    more: More
    first: Lists
    second: Lists
    mesh: Mesh
    motions: Motions
    flows: Flows
    posts: Posts
    coef: Any
    team: Team
