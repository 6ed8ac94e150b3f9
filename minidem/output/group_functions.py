"""Functions of a group in formulas: ``count(g)``, ``xcm(g,x)``, ``inertia(g,xy,reg)`` and so on."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from minidem.errors import InputError, UnknownNameError
from minidem.kernels.columns import MASS, POSITION, TOTAL_FORCE, VELOCITY, X, Y, Z
from minidem.world.momentum import angular_velocity, centre_of_mass, inertia_of
from minidem.world.state import Bools, Floats
from minidem.world.world import World

__all__ = ["group_value"]

_AXES: Final = {"x": X, "y": Y, "z": Z}
_FAR: Final = 1.0e20  # lowest and highest coordinate of no particles


def group_value(world: World, function: str, args: tuple[str, ...]) -> float:
    """Return a function of a group, and perhaps a region.

    Raises
    ------
    UnknownNameError
        For an unknown function.
    InputError
        For a wrong direction, group or region.
    """
    rest = list(args)
    chosen = world.member(world.bit(rest.pop(0) if rest else "all"))
    if rest and rest[-1] in world.regions:
        region = world.regions[rest.pop()]
        chosen = chosen & region.match(world.state.row[: world.state.n, POSITION])
    if function in _NUMBERS:
        if rest:
            msg = f"{function}({','.join(args)}): there is no region '{rest[0][:40]}'"
            raise InputError(msg)
        return float(_NUMBERS[function](world, chosen))
    if function not in _PARTS:
        msg = f"{function}()"
        raise UnknownNameError(msg)
    values, names = _PARTS[function]
    if len(rest) != 1 or rest[0] not in names:
        msg = f"{function}({','.join(args)}): expected {function}(GROUP,{names[0]}), "
        msg += f"{', '.join(names[1:])}, and perhaps a region that exists"
        raise InputError(msg)
    return float(values(world, chosen)[names.index(rest[0])])


def _rows(world: World, chosen: Bools) -> Floats:
    found: Floats = world.state.row[: world.state.n][chosen]
    return found


def _mass(world: World, chosen: Bools) -> float:
    return float(_rows(world, chosen)[:, MASS].sum())


def _energy(world: World, chosen: Bools) -> float:
    row = _rows(world, chosen)
    return float(0.5 * (row[:, MASS] * (row[:, VELOCITY] ** 2).sum(axis=1)).sum())


def _weights(world: World, chosen: Bools) -> Floats:
    return _rows(world, chosen)[:, [MASS]]


def _apart(world: World, chosen: Bools) -> Floats:
    """Return places from the centre of mass, across periodic faces, m."""
    place = world.unwrapped()[chosen]
    found: Floats = place - centre_of_mass(_weights(world, chosen), place)
    return found


def _gyration(world: World, chosen: Bools) -> float:
    weight, d = _weights(world, chosen), _apart(world, chosen)
    mass = float(weight.sum())
    return float(np.sqrt((weight * d**2).sum() / mass)) if mass > 0.0 else 0.0


def _centre(world: World, chosen: Bools) -> Floats:
    return centre_of_mass(_weights(world, chosen), world.unwrapped()[chosen])


def _drift(world: World, chosen: Bools) -> Floats:
    return centre_of_mass(_weights(world, chosen), _rows(world, chosen)[:, VELOCITY])


def _force(world: World, chosen: Bools) -> Floats:
    found: Floats = world.state.force[: world.state.n][chosen][:, TOTAL_FORCE].sum(axis=0)
    return found


def _torque(world: World, chosen: Bools) -> Floats:
    """Return the torque of the forces about the centre of mass, N m."""
    force = world.state.force[: world.state.n][chosen][:, TOTAL_FORCE]
    found: Floats = np.cross(_apart(world, chosen), force).sum(axis=0)
    return found


def _angular_momentum(world: World, chosen: Bools) -> Floats:
    turning = np.cross(_apart(world, chosen), _rows(world, chosen)[:, VELOCITY])
    found: Floats = (_weights(world, chosen) * turning).sum(axis=0)
    return found


def _inertia(world: World, chosen: Bools) -> Floats:
    tensor = inertia_of(_weights(world, chosen), _apart(world, chosen))
    return tensor[[X, Y, Z, X, Y, X], [X, Y, Z, Y, Z, Z]]


def _omega(world: World, chosen: Bools) -> Floats:
    tensor = inertia_of(_weights(world, chosen), _apart(world, chosen))
    return angular_velocity(tensor, _angular_momentum(world, chosen))


def _bounds(world: World, chosen: Bools) -> Floats:
    """Return the lowest and the highest coordinate along each axis, m."""
    at = _rows(world, chosen)[:, POSITION]
    found: Floats = np.array([at.min(axis=0, initial=_FAR), at.max(axis=0, initial=-_FAR)]).T
    return found.ravel()


_NUMBERS: Final[dict[str, Callable[[World, Bools], float]]] = {
    "count": lambda world, chosen: float(np.count_nonzero(chosen)),
    "mass": _mass,
    "ke": _energy,
    "gyration": _gyration,
}
_XYZ: Final = tuple(_AXES)
_PARTS: Final[dict[str, tuple[Callable[[World, Bools], Floats], tuple[str, ...]]]] = {
    "xcm": (_centre, _XYZ),
    "vcm": (_drift, _XYZ),
    "fcm": (_force, _XYZ),
    "torque": (_torque, _XYZ),
    "angmom": (_angular_momentum, _XYZ),
    "omega": (_omega, _XYZ),
    "inertia": (_inertia, ("xx", "yy", "zz", "xy", "yz", "xz")),
    "bound": (_bounds, ("xmin", "xmax", "ymin", "ymax", "zmin", "zmax")),
}
