"""Tables that are handed to kernels together.

Calls between kernels hand over every array of every table, so each gets no more than it needs.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from minidem.kernels.tables import (
    Control,
    Flows,
    Mesh,
    More,
    Motions,
    Pairs,
    Particles,
    Posts,
    Team,
    Walls,
)

__all__ = ["Bodies", "Lists", "Scene", "Tables"]


class Lists(NamedTuple):
    """One of the two sets of lists: that in use, or the spare one that a rebuild fills.

    Attributes
    ----------
    pairs : Pairs
        Pairs of particles.
    walls : Walls
        Particles and walls.
    """

    pairs: Pairs
    walls: Walls


class Bodies(NamedTuple):
    """What the loops over contacts have in common.

    Attributes
    ----------
    control : Control
        Numbers of the run loop.
    parts : Particles
        The particles.
    coef : float64 (types**2, columns)
        Coefficients of every ordered pair of types, see `minidem.kernels.columns`.
    """

    control: Control
    parts: Particles
    coef: Any


class Scene(NamedTuple):
    """What the phases of a step work on besides the lists.

    Attributes
    ----------
    control, parts, coef : Control, Particles, float64 (types**2, columns)
        As in `Bodies`.
    mesh : Mesh
        Triangles.
    posts : Posts
        Forces that come on top of contacts.
    team : Team
        What threads share.
    """

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
    control, parts, mesh, posts, coef, team : as in `Scene`
        What every step needs.
    more : More
        What only a rebuild touches.
    first, second : Lists
        The two sets of lists; ``TURNED`` in `control` says which is in use.
    motions : Motions
        Moving meshes.
    flows : Flows
        Counters.
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
