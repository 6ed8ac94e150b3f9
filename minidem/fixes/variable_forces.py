"""Forces that need script variables or regions: worked out in Python once per step."""

from __future__ import annotations

import numpy as np

from minidem.fixes.body import Post
from minidem.kernels.motion.post import POST_KINDS, apply_range
from minidem.kernels.tables import Posts
from minidem.world.state import Floats, Ints
from minidem.world.world import World

__all__ = ["add_forces", "needs_python", "potential", "varies"]


def varies(post: Post) -> bool:
    """Return True for a force that kernels cannot work out: by variable, region or atom type."""
    field = post.pull is not None and post.pull.varies
    return field or bool(post.region) or post.per_type is not None or any(post.variables)


def needs_python(world: World) -> bool:
    """Return True if there is a force that kernels cannot work out."""
    return any(varies(post) for post in world.of_kind(Post))


def add_forces(world: World, table: Posts | None, first: int, last: int | None = None) -> None:
    """Apply the body forces from number `first` to before `last`, in the order of their fixes.

    Contact forces are there already. A variable sees the forces of the fixes before its own.

    Raises
    ------
    ValueError
        If the run was not prepared, or a region is not there any more.
    """
    if table is None:
        msg = "the run was not prepared"
        raise ValueError(msg)
    state = world.state
    posts = world.of_kind(Post)
    for p in range(first, len(posts) if last is None else last):
        if varies(posts[p]):
            _apply(world, posts[p])
        else:
            apply_range(state.n, state.table(), table, p, p + 1)
            posts[p].before[1:] = table.total[p]


def _apply(world: World, post: Post) -> None:
    state = world.state
    row, force = state.row[: state.n], state.force[: state.n]
    who = _affected(world, post)
    style = POST_KINDS[post.kind]
    if style == "gravity" and post.pull is not None:
        post.value[:3] = post.pull.acceleration(world.interpreter.value)
        force[who, :3] += row[who, 7:8] * post.value[:3]
    elif style == "viscous" and post.per_type is not None:
        drag = post.per_type[state.kind[: state.n]]
        force[who, :3] -= drag[who, None] * row[who, 4:7]
    else:
        wanted = [_component(world, post, c)[who] for c in range(3)]
        if post.energy is not None:
            post.before[0] = world.interpreter.atom_values(post.energy)[who].sum()
        post.before[1:] = force[who, :3].sum(axis=0)
        for c in range(3):
            if style == "addforce":
                force[who, c] += wanted[c]
            elif post.flags & 1 << c:
                force[who, c] = wanted[c]


def _affected(world: World, post: Post) -> Ints:
    """Return the particles that a body force acts on."""
    chosen = world.member(post.bit)
    if post.region:
        if post.region not in world.regions:
            msg = f"Region ID '{post.region}' for fix {post.style} does not exist"
            raise ValueError(msg)
        chosen = chosen & world.regions[post.region].match(world.state.row[: world.state.n, :3])
    return np.flatnonzero(chosen)


def _component(world: World, post: Post, c: int) -> Floats:
    """Return one component of a force for every particle, N."""
    name = post.variables[c]
    if name is None:
        return np.full(world.state.n, post.value[c])
    values: Floats = world.interpreter.atom_values(name)
    return values


def potential(world: World, post: Post) -> float:
    """Return the potential energy, J, of particles in a force that is the same everywhere."""
    who = _affected(world, post)
    if post.style == "gravity":
        row = world.state.row[who]
        return float(-(row[:, 7] * (row[:, :3] @ post.value[:3])).sum())
    return float(-(world.unwrapped()[who] @ post.value[:3]).sum())
