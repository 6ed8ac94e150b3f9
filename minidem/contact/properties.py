"""Which ``property/global`` values each contact model takes, and where the kernels find them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from minidem.contact.reading import (
    Read,
    above_zero,
    angle,
    any_pair,
    any_scalar,
    of_first,
    pair_above,
    part,
    restitution,
    roll_factor,
    scalar,
    speed,
)
from minidem.record import record

from minidem.kernels.columns import (  # isort: skip
    ABSOLUTE_DAMPING, COHESION, LIMITS_LIQUID, NORMAL, ROLLING, SETS_BRIDGES, TANGENTIAL, VISCOUS,
)  # fmt: skip
from minidem.kernels.models import (  # isort: skip
    ADHESION_EXPONENT, ADHESIVE, BRIDGE_SHARE, BRIDGE_VISCOSITY, CHARACTERISTIC_SPEED,
    COHESION_ENERGY, CONTACT_ANGLE, CRITICAL_STOKES, EASO, EDINBURGH, EDINBURGH_STIFFNESS, EPSD,
    EPSD3, FLUID_VISCOSITY, FRICTION, HERTZ_STIFFNESS, HOOKE, HOOKE_HYSTERESIS, HOOKE_STIFFNESS,
    LARGEST_UNLOADING, LEAST_GAP, LIQUID_LIMIT, LOADING, LUDING, MAXIMUM_RESTITUTION,
    NORMAL_DASHPOT, NORMAL_RATE, NORMAL_STIFFNESS, OVERLAP_EXPONENT, PLASTICITY_DEPTH, PULL_OFF,
    ROLLING_DAMPING, ROLLING_FRICTION, ROLLING_STIFFNESS, ROLL_LUDING, SJKR,
    SLIDING_STIFFNESS, SLIDING_VISCOSITY, SURFACE_ENERGY, SURFACE_TENSION, TANGENTIAL_DASHPOT,
    TANGENTIAL_RATE, TANGENTIAL_STIFFNESS, TAN_LUDING, THORNTON_NING, TURNING_STIFFNESS, UNLOADING,
    WASHINO, YIELD_RATIO,
)  # fmt: skip
from minidem.world.materials import Materials
from minidem.world.state import Floats

__all__ = ["property_columns", "values_of_models"]

ANY: Final[tuple[int, ...]] = ()


@record(frozen=True)
class _Property:
    """A value of a model.

    Attributes
    ----------
    name : str
        Of the ``property/global``.
    column : int or None
        Of the coefficients; None if kernels do not take it.
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
    column: int | None
    switch: int
    values: tuple[int, ...]
    model: str
    read: Read = any_pair
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
WASHINO_MODEL: Final = "cohesion_model washino/capillary/viscous"
THORNTON_MODEL: Final = "model thornton_ning"

_PROPERTIES: Final = (
    _Property(
        "characteristicVelocity", CHARACTERISTIC_SPEED, NORMAL, (HOOKE, HOOKE_HYSTERESIS),
        "normal_model hooke", speed,
    ),
    *(
        _Property(name, column, VISCOUS, (1,), "model hooke viscous", read)
        for name, column, read in (
            ("FluidViscosity", FLUID_VISCOSITY, above_zero),
            ("CriticalStokes", CRITICAL_STOKES, above_zero),
            ("MaximumRestitution", MAXIMUM_RESTITUTION, restitution),
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
            ("UnloadingStiffness", UNLOADING, pair_above(1.0)),
            ("coefficientAdhesionStiffness", ADHESIVE, any_pair),
            ("overlapExponent", OVERLAP_EXPONENT, scalar),
            ("adhesionExponent", ADHESION_EXPONENT, scalar),
            ("pullOffForce", PULL_OFF, any_pair),
            ("surfaceEnergy", SURFACE_ENERGY, any_pair),
        )
    ),
    _Property("surfaceEnergy", SURFACE_ENERGY, NORMAL, (THORNTON_NING,), THORNTON_MODEL),
    _Property(
        "coefficientYieldRatio", YIELD_RATIO, NORMAL, (THORNTON_NING,), THORNTON_MODEL, of_first
    ),
    _Property(
        "coefficientFriction", FRICTION, TANGENTIAL, ANY, "tangential_model",
    ),
    *(
        _Property(name, column, TANGENTIAL, (TAN_LUDING,), "tangential_model tan_luding", read)
        for name, column, read in (
            ("FluidViscosity", FLUID_VISCOSITY, above_zero),
            ("FrictionViscosity", SLIDING_VISCOSITY, above_zero),
            ("coeffFrictionStiffness", SLIDING_STIFFNESS, any_pair),
        )
    ),
    _Property(
        "cohesionEnergyDensity", COHESION_ENERGY, COHESION, tuple(range(SJKR, EASO)),
        "cohesion_model",
    ),
    *(
        _Property(name, column, COHESION, (cohesion,), model, read)
        for cohesion, model in (
            (EASO, "cohesion_model easo/capillary/viscous"), (WASHINO, WASHINO_MODEL),
        )
        for name, column, read in (
            ("surfaceLiquidContentInitial", None, any_scalar),
            ("surfaceTension", SURFACE_TENSION, any_scalar),
            ("fluidViscosity", BRIDGE_VISCOSITY, any_scalar),
            ("contactAngle", CONTACT_ANGLE, angle),
            ("minSeparationDistanceRatio", LEAST_GAP, scalar),
            ("maxSeparationDistanceRatio", None, any_scalar),
        )
    ),
    _Property("maxLiquidContent", LIQUID_LIMIT, LIMITS_LIQUID, (1,), WASHINO_MODEL, of_first),
    _Property("lbVolumeFraction", BRIDGE_SHARE, SETS_BRIDGES, (1,), WASHINO_MODEL, part),
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
        roll_factor,
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
    found: dict[int, Floats] = {}
    for one in _PROPERTIES:
        if any(one.is_needed(switches) for switches in used):
            values = one.read(materials, types, one.name, one.model)
            if one.column is not None:
                found[one.column] = values
    return found
