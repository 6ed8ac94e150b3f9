"""Coefficients of contact models for every pair of atom types."""

from __future__ import annotations

from collections.abc import Sequence
from math import log, pi, sqrt

import numpy as np

from minidem.contact.properties import property_columns
from minidem.contact.reading import speed
from minidem.errors import InputError
from minidem.kernels.columns import (
    ABSOLUTE_DAMPING,
    BASIC_SWITCHES,
    NORMAL,
    SCATTERS,
    SLOWS,
    SOFTENS,
    VISCOUS,
    WEAKENS,
)
from minidem.kernels.models import (
    COEFFICIENTS,
    DAMPING,
    EDINBURGH,
    FRICTION,
    HERTZ,
    HERTZ_STIFFNESS,
    HOOKE,
    HOOKE_HYSTERESIS,
    HOOKE_STIFFNESS,
    LOG_RESTITUTION,
    RESTITUTION_DEVIATION,
    RESTITUTION_EXPONENT,
    RESTITUTION_SPEED,
    SHEAR,
    STATIC_FRICTION,
    TANGENTIAL_FACTOR,
    THORNTON_NING,
    WEAKENING_SPEED,
    YOUNG,
)
from minidem.world.materials import Materials
from minidem.world.state import Floats

__all__ = ["active_switches", "coefficient_table"]

_ELASTIC = (
    HERTZ,
    HOOKE,
    HOOKE_HYSTERESIS,
    EDINBURGH,
    THORNTON_NING,
)  # of moduli, not of given stiffness
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
    out = np.zeros((types * types, COEFFICIENTS))
    if any(s[NORMAL] in _ELASTIC for s in used):
        _moduli(out, materials, types)
    if any(_restitutes(s) for s in used):
        bounce = materials.per_pair("coefficientRestitution", types, "normal model")
        for row, e in zip(out, bounce.ravel(), strict=True):
            loss = log(e)
            row[DAMPING] = -2.0 * SQRT_5_6 * (loss / sqrt(loss * loss + pi * pi))
            row[LOG_RESTITUTION] = loss
    found = property_columns(materials, types, used)
    found |= _extended(materials, types, used, found.get(FRICTION))
    for column, values in found.items():
        out[:, column] = values.ravel()
    return out


def _restitutes(switches: Sequence[int]) -> bool:
    """Return True if a model damps by the coefficient of restitution."""
    if switches[NORMAL] in (HOOKE_STIFFNESS, HERTZ_STIFFNESS):
        return False
    return not switches[VISCOUS]


def _moduli(out: Floats, materials: Materials, types: int) -> None:
    """Fill in the effective moduli."""
    young = materials.per_type("youngsModulus", types, "normal model")
    nu = materials.per_type("poissonsRatio", types, "normal model")
    for i in range(types):
        for j in range(types):
            row = out[i * types + j]
            row[YOUNG] = 1.0 / ((1.0 - nu[i] ** 2) / young[i] + (1.0 - nu[j] ** 2) / young[j])
            row[SHEAR] = 1.0 / (
                2.0 * (2.0 - nu[i]) * (1.0 + nu[i]) / young[i]
                + 2.0 * (2.0 - nu[j]) * (1.0 + nu[j]) / young[j]
            )


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
        found[WEAKENING_SPEED] = speed(materials, types, "weakeningVelocity", "staticFriction")
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
        found[RESTITUTION_SPEED] = speed(
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
    return (*switches[:BASIC_SWITCHES], *extensions, *switches[ABSOLUTE_DAMPING:])
