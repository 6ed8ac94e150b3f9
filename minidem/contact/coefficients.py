"""Coefficients of contact models for every pair of atom types."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import log, pi, sqrt

import numpy as np

from minidem.contact.model import MODELS
from minidem.errors import InputError
from minidem.kernels.columns import (
    BASIC_SWITCHES,
    CHARACTERISTIC_SPEED,
    COEFFICIENTS,
    COHESION,
    COHESION_ENERGY,
    DAMPING,
    FRICTION,
    LOG_RESTITUTION,
    NORMAL,
    RESTITUTION_DEVIATION,
    RESTITUTION_EXPONENT,
    RESTITUTION_SPEED,
    ROLLING,
    ROLLING_DAMPING,
    ROLLING_FRICTION,
    SCATTERS,
    SHEAR,
    SLOWS,
    SOFTENS,
    STATIC_FRICTION,
    TANGENTIAL,
    TANGENTIAL_FACTOR,
    WEAKENING_SPEED,
    WEAKENS,
    YOUNG,
)
from minidem.world.materials import Materials
from minidem.world.state import Floats

__all__ = ["active_switches", "coefficient_table"]

_HOOKE, _EPSD = MODELS["model"].index("hooke"), MODELS["rolling_friction"].index("epsd")
SQRT_5_6 = 0.91287092917527685576161630466800355658790782499663875  # as in LIGGGHTS


def coefficient_table(materials: Materials, types: int, used: Sequence[Sequence[int]]) -> Floats:
    """Work out the coefficients of every ordered pair of types.

    Parameters
    ----------
    materials : Materials
        Values by name.
    types : int
        Number of atom types.
    used : sequence of switches
        The models in use; only what they need must be there.

    Returns
    -------
    ndarray of float64, shape (types**2, columns)
        See `minidem.kernels.columns`.

    Raises
    ------
    InputError
        If a property is missing or out of its limits.
    """
    materials.check()
    if not used:
        return np.zeros((types * types, COEFFICIENTS))
    young = materials.per_type("youngsModulus", types, "normal model")
    nu = materials.per_type("poissonsRatio", types, "normal model")
    bounce = materials.per_pair("coefficientRestitution", types, "normal model")
    optional = _optional(materials, types, used)
    out = np.zeros((types * types, COEFFICIENTS))
    for i in range(types):
        for j in range(types):
            row = out[i * types + j]
            row[YOUNG] = 1.0 / ((1.0 - nu[i] ** 2) / young[i] + (1.0 - nu[j] ** 2) / young[j])
            row[SHEAR] = 1.0 / (
                2.0 * (2.0 - nu[i]) * (1.0 + nu[i]) / young[i]
                + 2.0 * (2.0 - nu[j]) * (1.0 + nu[j]) / young[j]
            )
            loss = log(bounce[i, j])
            beta = loss / sqrt(loss * loss + pi * pi)
            row[DAMPING] = -2.0 * SQRT_5_6 * beta
            row[LOG_RESTITUTION] = loss
            for column, values in optional.items():
                row[column] = values[i, j]
    return out


def _optional(
    materials: Materials, types: int, used: Sequence[Sequence[int]]
) -> Mapping[int, Floats]:
    """Return the columns that only some models need, shape (types, types) each."""
    found: dict[int, Floats] = {}
    if any(s[TANGENTIAL] for s in used):
        found[FRICTION] = materials.per_pair("coefficientFriction", types, "tangential_model")
    if any(s[ROLLING] for s in used):
        found[ROLLING_FRICTION] = materials.per_pair(
            "coefficientRollingFriction", types, "rolling_model"
        )
    if any(s[ROLLING] == _EPSD for s in used):
        found[ROLLING_DAMPING] = materials.per_pair(
            "coefficientRollingViscousDamping", types, "rolling_model epsd"
        )
    if any(s[COHESION] for s in used):
        found[COHESION_ENERGY] = materials.per_pair(
            "cohesionEnergyDensity", types, "cohesion_model"
        )
    if any(s[NORMAL] == _HOOKE for s in used):
        found[CHARACTERISTIC_SPEED] = _speed(
            materials, types, "characteristicVelocity", "normal_model hooke"
        )
    return found | _extended(materials, types, used, found.get(FRICTION))


def _extended(
    materials: Materials,
    types: int,
    used: Sequence[Sequence[int]],
    kinetic: Floats | None,
) -> dict[int, Floats]:
    """Return the columns of the extensions, shape (types, types) each."""
    found: dict[int, Floats] = {}
    if any(s[WEAKENS] for s in used):
        static = materials.per_pair("coefficientStaticFriction", types, "staticFriction")
        found[STATIC_FRICTION] = static
        found[WEAKENING_SPEED] = _speed(materials, types, "weakeningVelocity", "staticFriction")
        if kinetic is not None and (static < kinetic).any():
            msg = (
                "coefficientStaticFriction is below coefficientFriction; friction may only fall "
                "with the sliding speed"
            )
            raise InputError(msg)
    if any(s[SLOWS] for s in used):
        found[RESTITUTION_EXPONENT] = materials.per_pair(
            "restitutionExponent", types, "velocityRestitution"
        )
        found[RESTITUTION_SPEED] = _speed(
            materials, types, "restitutionVelocity", "velocityRestitution"
        )
        if (found[RESTITUTION_EXPONENT] < 0.0).any():
            msg = "restitutionExponent is negative; restitution may only fall with the impact speed"
            raise InputError(msg)
    if any(s[SCATTERS] for s in used):
        deviation = materials.per_pair("restitutionDeviation", types, "restitutionScatter")
        found[RESTITUTION_DEVIATION] = deviation
        if (deviation < 0.0).any():
            msg = "restitutionDeviation is negative; give a standard deviation, 0 for none"
            raise InputError(msg)
    if any(s[SOFTENS] for s in used):
        factor = materials.per_pair("tangentialStiffnessFactor", types, "tangentialStiffness")
        found[TANGENTIAL_FACTOR] = factor
        if not (factor > 0.0).all():
            msg = "tangentialStiffnessFactor must be above zero; 1 is the stiffness of Mindlin"
            raise InputError(msg)
    return found


def _speed(materials: Materials, types: int, name: str, model: str) -> Floats:
    """Return a characteristic speed for all pairs of types, shape (types, types)."""
    speed = float(materials.of(name, model).ravel()[0])
    if not speed > 0.0:
        msg = f"{name} is {speed:g} m/s; it must be above zero"
        raise InputError(msg)
    return np.full((types, types), speed)


def active_switches(switches: Sequence[int], table: Floats) -> tuple[int, ...]:
    """Return the switches without the extensions that have no strength.

    Parameters
    ----------
    switches : sequence of int
        See `minidem.kernels.contact.records.Switches`.
    table : ndarray of float64, shape (types**2, columns)
        From `coefficient_table`.
    """
    weakens = switches[WEAKENS] and bool((table[:, STATIC_FRICTION] != table[:, FRICTION]).any())
    slows = switches[SLOWS] and bool((table[:, RESTITUTION_EXPONENT] != 0.0).any())
    scatters = switches[SCATTERS] and bool((table[:, RESTITUTION_DEVIATION] != 0.0).any())
    softens = switches[SOFTENS] and bool((table[:, TANGENTIAL_FACTOR] != 1.0).any())
    extensions = int(weakens), int(slows), int(scatters), int(softens)
    return (*switches[:BASIC_SWITCHES], *extensions)
