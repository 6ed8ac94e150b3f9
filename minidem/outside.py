"""Forces that need script variables or regions: worked out in Python once per step."""

from __future__ import annotations

import numpy as np

from minidem.fixes.simple import Post
from minidem.kernels.post import POST_KINDS
from minidem.state import Floats, Ints
from minidem.world import World

__all__ = ["add_forces", "needs_python", "potential", "varies"]

_GRAVITY, _VISCOUS, _SET, _ADD, _FREEZE = range(len(POST_KINDS))


def needs_python(world: World) -> bool:
    """Return True if a body force has a variable, a region or a value per atom type."""
    return any(
        post.region or post.per_type is not None or any(post.variables) or varies(post)
        for post in world.of_kind(Post)
    )


def varies(post: Post) -> bool:
    """Return True for gravity that follows a variable."""
    return post.pull is not None and post.pull.varies


def add_forces(world: World, first: int, last: int | None = None) -> None:
    """Apply the body forces from number `first` to before `last`, in the order of their fixes.

    Contact forces are there already. A variable sees the forces of the fixes before its own.
    """
    for post in world.of_kind(Post)[first:last]:
        _apply(world, post)


def _apply(world: World, post: Post) -> None:
    state = world.state
    row, force = state.row[: state.n], state.force[: state.n]
    who = _affected(world, post)
    if post.kind == _GRAVITY:
        if post.pull is not None and post.pull.varies:
            post.value[:3] = post.pull.acceleration(world.interpreter.value)
        force[who, :3] += row[who, 7:8] * post.value[:3]
    elif post.kind == _VISCOUS:
        drag = np.full(state.n, post.value[0])
        if post.per_type is not None:
            drag = post.per_type[state.kind[: state.n]]
        force[who, :3] -= drag[who, None] * row[who, 4:7]
    elif post.kind == _FREEZE:
        post.before[1:] = force[who, :3].sum(axis=0)
        force[who, :6] = 0.0
    else:
        wanted = [_component(world, post, c)[who] for c in range(3)]
        if post.energy is not None:
            post.before[0] = world.interpreter.atom_values(post.energy)[who].sum()
        post.before[1:] = force[who, :3].sum(axis=0)
        for c in range(3):
            if post.kind == _ADD:
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
    if post.kind == _GRAVITY:
        row = world.state.row[who]
        return float(-(row[:, 7] * (row[:, :3] @ post.value[:3])).sum())
    return float(-(world.unwrapped()[who] @ post.value[:3]).sum())
