"""Which ``property/global`` values each contact model takes, and where the kernels find them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from minidem.errors import InputError
from minidem.kernels.columns import ABSOLUTE_DAMPING, COHESION, NORMAL, ROLLING, TANGENTIAL, VISCOUS
from minidem.kernels.models import (
    ADHESION_EXPONENT,
    ADHESIVE,
    CHARACTERISTIC_SPEED,
    COHESION_ENERGY,
    CRITICAL_STOKES,
    EDINBURGH,
    EDINBURGH_STIFFNESS,
    EPSD,
    EPSD3,
    FLUID_VISCOSITY,
    FRICTION,
    HERTZ_STIFFNESS,
    HOOKE,
    HOOKE_HYSTERESIS,
    HOOKE_STIFFNESS,
    LARGEST_UNLOADING,
    LOADING,
    LUDING,
    MAXIMUM_RESTITUTION,
    NORMAL_DASHPOT,
    NORMAL_RATE,
    NORMAL_STIFFNESS,
    OVERLAP_EXPONENT,
    PLASTICITY_DEPTH,
    PULL_OFF,
    ROLL_LUDING,
    ROLLING_DAMPING,
    ROLLING_FRICTION,
    ROLLING_STIFFNESS,
    SLIDING_STIFFNESS,
    SLIDING_VISCOSITY,
    SURFACE_ENERGY,
    TAN_LUDING,
    TANGENTIAL_DASHPOT,
    TANGENTIAL_RATE,
    TANGENTIAL_STIFFNESS,
    TURNING_STIFFNESS,
    UNLOADING,
)
from minidem.world.materials import Materials
from minidem.world.state import Floats

__all__ = ["property_columns", "speed", "values_of_models"]

Read = Callable[[Materials, int, str, str], Floats]


def speed(materials: Materials, types: int, name: str, model: str) -> Floats:
    """Return a characteristic speed for all pairs of types, shape (types, types).

    Raises
    ------
    InputError
        If it is missing or not above zero.
    """
    return _scalar(materials, types, name, model, " m/s")


def _scalar(materials: Materials, types: int, name: str, model: str, unit: str = "") -> Floats:
    """Return a value that is above zero for all pairs of types."""
    value = float(materials.of(name, model).ravel()[0])
    if not value > 0.0:
        msg = f"{name} is {value:g}{unit}; it must be above zero"
        raise InputError(msg)
    return np.full((types, types), value)


def _any_pair(materials: Materials, types: int, name: str, model: str) -> Floats:
    return materials.per_pair(name, types, model)


def _pair_above(least: float) -> Read:
    """Return how values of pairs of types are read that are above a number, or equal to it."""

    def read(materials: Materials, types: int, name: str, model: str) -> Floats:
        values = materials.per_pair(name, types, model)
        if (values < least).any() or (least == 0.0 and (values == 0.0).any()):
            limit = f"at least {least:g}" if least else "above zero"
            msg = f"{name} is {values.min():g}; it must be {limit} (as requested by {model})"
            raise InputError(msg)
        return values

    return read


_above_zero = _pair_above(0.0)


def _restitution(materials: Materials, types: int, name: str, model: str) -> Floats:
    values = _above_zero(materials, types, name, model)
    if (values > 1.0).any():
        msg = f"{name} is {values.max():g}; 0 < {name} <= 1 required (as requested by {model})"
        raise InputError(msg)
    return values


def _roll_factor(materials: Materials, types: int, name: str, model: str) -> Floats:
    values = _scalar(materials, types, name, model)
    if materials.units == "si" and values.min(initial=1.0) < 1.0:
        msg = f"{name} is {values.min():g}; {name} >= 1 required for SI units"
        raise InputError(msg)
    return values


ANY: Final[tuple[int, ...]] = ()


@dataclass(frozen=True)
class _Property:
    """A value of a model.

    Attributes
    ----------
    name : str
        Of the ``property/global``.
    column : int
        Of the coefficients.
    switch, values : int, tuple of int
        It is needed where this switch has one of these values, `ANY` but off,
    unless : int or None
        and this one is 0.
    model : str
        What LIGGGHTS calls the model.
    read : callable
        Returns the values for all pairs of types.
    """

    name: str
    column: int
    switch: int
    values: tuple[int, ...]
    model: str
    read: Read = _any_pair
    unless: int | None = None

    def is_needed(self, switches: Sequence[int]) -> bool:
        """Return True for a model that takes it."""
        stands_aside = self.unless is not None and switches[self.unless] != 0
        value = switches[self.switch]
        wanted = value != 0 if self.values == ANY else value in self.values
        return wanted and not stands_aside


_STIFF = ((HOOKE_STIFFNESS, "model hooke/stiffness"), (HERTZ_STIFFNESS, "model hertz/stiffness"))
_POWERS = (
    (EDINBURGH, "model edinburgh"), (EDINBURGH_STIFFNESS, "model edinburgh/stiffness"),
)  # fmt: skip

_PROPERTIES: Final = (
    _Property(
        "characteristicVelocity", CHARACTERISTIC_SPEED, NORMAL, (HOOKE, HOOKE_HYSTERESIS),
        "normal_model hooke", speed,
    ),
    *(
        _Property(name, column, VISCOUS, (1,), "model hooke viscous", read)
        for name, column, read in (
            ("FluidViscosity", FLUID_VISCOSITY, _above_zero),
            ("CriticalStokes", CRITICAL_STOKES, _above_zero),
            ("MaximumRestitution", MAXIMUM_RESTITUTION, _restitution),
        )
    ),
    *(
        _Property(name, column, NORMAL, (normal,), model)
        for normal, model in _STIFF
        for name, column in (("kn", NORMAL_STIFFNESS), ("kt", TANGENTIAL_STIFFNESS))
    ),
    *(
        _Property(name, column, NORMAL, (normal,), model, unless=ABSOLUTE_DAMPING)
        for normal, model in _STIFF
        for name, column in (("gamman", NORMAL_RATE), ("gammat", TANGENTIAL_RATE))
    ),
    *(
        _Property(name, column, ABSOLUTE_DAMPING, (1,), "model hooke/stiffness")
        for name, column in (
            ("gamman_abs", NORMAL_DASHPOT), ("gammat_abs", TANGENTIAL_DASHPOT),
        )
    ),
    _Property(
        "coefficientMaxElasticStiffness", LARGEST_UNLOADING, NORMAL, (HOOKE_HYSTERESIS,),
        "model hooke/hysteresis",
    ),
    *(
        _Property(name, column, NORMAL, (normal,), model)
        for normal, model in (
            (HOOKE_HYSTERESIS, "model hooke/hysteresis"), (LUDING, "model luding"),
        )
        for name, column in (
            ("coefficientAdhesionStiffness", ADHESIVE),
            ("coefficientPlasticityDepth", PLASTICITY_DEPTH),
        )
    ),
    _Property("LoadingStiffness", LOADING, NORMAL, (LUDING,), "model luding"),
    _Property("UnloadingStiffness", UNLOADING, NORMAL, (LUDING,), "model luding"),
    _Property("pullOffForce", PULL_OFF, NORMAL, (LUDING,), "model luding"),
    _Property("LoadingStiffness", LOADING, NORMAL, (EDINBURGH_STIFFNESS,), _POWERS[1][1]),
    *(
        _Property(name, column, NORMAL, (normal,), model, read)
        for normal, model in _POWERS
        for name, column, read in (
            ("UnloadingStiffness", UNLOADING, _pair_above(1.0)),
            ("coefficientAdhesionStiffness", ADHESIVE, _any_pair),
            ("overlapExponent", OVERLAP_EXPONENT, _scalar),
            ("adhesionExponent", ADHESION_EXPONENT, _scalar),
            ("pullOffForce", PULL_OFF, _any_pair),
            ("surfaceEnergy", SURFACE_ENERGY, _any_pair),
        )
    ),
    _Property(
        "coefficientFriction", FRICTION, TANGENTIAL, ANY, "tangential_model",
    ),
    *(
        _Property(name, column, TANGENTIAL, (TAN_LUDING,), "tangential_model tan_luding", read)
        for name, column, read in (
            ("FluidViscosity", FLUID_VISCOSITY, _above_zero),
            ("FrictionViscosity", SLIDING_VISCOSITY, _above_zero),
            ("coeffFrictionStiffness", SLIDING_STIFFNESS, _any_pair),
        )
    ),
    _Property(
        "cohesionEnergyDensity", COHESION_ENERGY, COHESION, ANY, "cohesion_model"
    ),
    _Property(
        "coefficientRollingFriction", ROLLING_FRICTION, ROLLING, ANY, "rolling_model"
    ),
    *(
        _Property(
            "coefficientRollingViscousDamping", ROLLING_DAMPING, ROLLING, (rolling,), model
        )
        for rolling, model in (
            (EPSD, "rolling_model epsd"), (EPSD3, "rolling_model epsd3"),
            (ROLL_LUDING, "rolling_model luding"),
        )
    ),
    _Property(
        "rollingStiffness", ROLLING_STIFFNESS, ROLLING, (EPSD3,), "rolling_model epsd3",
        _roll_factor,
    ),
    _Property(
        "coeffRollingStiffness", TURNING_STIFFNESS, ROLLING, (ROLL_LUDING,),
        "rolling_model luding",
    ),
)  # fmt: skip


def values_of_models() -> dict[str, list[str]]:
    """Return the names of the values that only some models take, by model as LIGGGHTS calls it."""
    found: dict[str, list[str]] = {}
    for one in _PROPERTIES:
        found.setdefault(one.model, []).append(one.name)
    return found


def property_columns(
    materials: Materials, types: int, used: Sequence[Sequence[int]]
) -> dict[int, Floats]:
    """Return the columns that only some models need.

    Parameters
    ----------
    materials : Materials
        Values by name.
    types : int
        Number of atom types.
    used : sequence of switches
        The models in use.

    Returns
    -------
    dict of int to ndarray, shape (types, types)
        By column of the coefficients.

    Raises
    ------
    InputError
        If a property is missing or out of its limits.
    """
    return {
        one.column: one.read(materials, types, one.name, one.model)
        for one in _PROPERTIES
        if any(one.is_needed(switches) for switches in used)
    }
