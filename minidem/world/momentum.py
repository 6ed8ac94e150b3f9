"""The motion of a group as a whole, and taking it away."""

from __future__ import annotations

import numpy as np

from minidem.kernels.columns import MASS, VELOCITY, X, Y, Z
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = [
    "angular_velocity",
    "centre_of_mass",
    "group_mass",
    "inertia_of",
    "remove_drift",
    "remove_turning",
]

_OTHERS = ((Y, Z), (Z, X), (X, Y))


def group_mass(world: World, bit: int) -> float:
    """Return the mass of a group, kg."""
    return float(world.state.row[: world.state.n][world.member(bit), MASS].sum())


def remove_drift(world: World, bit: int, mass: float, axes: Floats) -> None:
    """Take the velocity of its centre of mass from all particles of a group.

    Parameters
    ----------
    world : World
        The particles.
    bit : int
        Bit of the group.
    mass : float
        Mass by which the momentum is divided, kg.
    axes : ndarray, shape (3,)
        1 for components that change, else 0.
    """
    who = np.flatnonzero(world.member(bit))
    row = world.state.row
    momentum = (row[who, MASS, None] * row[who, VELOCITY]).sum(axis=0)
    row[who, VELOCITY] -= axes * momentum / (mass if mass > 0.0 else 1.0)


def remove_turning(world: World, bit: int, mass: float) -> None:
    """Take the turning of a group about its centre of mass from the velocities of its particles.

    Parameters
    ----------
    world : World
        The particles.
    bit : int
        Bit of the group.
    mass : float
        Mass of the group, kg.
    """
    who = np.flatnonzero(world.member(bit))
    row = world.state.row
    weight, v = row[who, MASS, None], row[who, VELOCITY]
    place = world.unwrapped()[who]
    d = place - (weight * place).sum(axis=0) / (mass if mass > 0.0 else 1.0)
    angular = (weight * np.cross(d, v)).sum(axis=0)
    row[who, VELOCITY] -= np.cross(angular_velocity(inertia_of(weight, d), angular), d)


def centre_of_mass(weight: Floats, place: Floats) -> Floats:
    """Return the centre of particles of some masses, shape (n, 1), at places, shape (n, 3)."""
    mass = float(weight.sum())
    found: Floats = (weight * place).sum(axis=0) / (mass if mass > 0.0 else 1.0)
    return found


def inertia_of(weight: Floats, d: Floats) -> Floats:
    """Return the tensor of inertia of particles of some masses, shape (n, 1), at places `d`."""
    inertia: Floats = -(weight[:, :, None] * d[:, :, None] * d[:, None, :]).sum(axis=0)
    squares = (weight * d**2).sum(axis=0)
    inertia[np.diag_indices(3)] = squares.sum() - squares
    return inertia


def angular_velocity(inertia: Floats, angular: Floats) -> Floats:
    """Return the angular velocity; as in LIGGGHTS not divided for particles in one line."""
    adjoint = np.array(
        [
            [inertia[r, u] * inertia[s, v] - inertia[r, v] * inertia[s, u] for r, s in _OTHERS]
            for u, v in _OTHERS
        ]
    )
    determinant = float(inertia[X] @ adjoint[:, X])
    found: Floats = adjoint @ angular
    return found / determinant if determinant > 0.0 else found
