"""Coefficients of contact models for every pair of atom types."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import log, pi, sqrt

import numpy as np

from minidem.kernels.contact.law import COLUMNS
from minidem.world.materials import Materials
from minidem.world.state import Floats

__all__ = ["active_switches", "coefficient_table"]

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
        See `minidem.kernels.contact.law.COLUMNS`.

    Raises
    ------
    ValueError
        If a property is missing or out of its limits.
    """
    materials.check()
    out = np.zeros((types * types, len(COLUMNS)))
    if not used:
        return out
    young = materials.per_type("youngsModulus", types, "normal model")
    nu = materials.per_type("poissonsRatio", types, "normal model")
    bounce = materials.per_pair("coefficientRestitution", types, "normal model")
    optional = _optional(materials, types, used)
    for i in range(types):
        for j in range(types):
            row = out[i * types + j]
            row[0] = 1.0 / ((1.0 - nu[i] ** 2) / young[i] + (1.0 - nu[j] ** 2) / young[j])
            row[1] = 1.0 / (
                2.0 * (2.0 - nu[i]) * (1.0 + nu[i]) / young[i]
                + 2.0 * (2.0 - nu[j]) * (1.0 + nu[j]) / young[j]
            )
            loss = log(bounce[i, j])
            beta = loss / sqrt(loss * loss + pi * pi)
            row[2] = -2.0 * SQRT_5_6 * beta
            row[8] = loss
            for column, values in optional.items():
                row[column] = values[i, j]
    return out


def _optional(
    materials: Materials, types: int, used: Sequence[Sequence[int]]
) -> Mapping[int, Floats]:
    """Return the columns that only some models need, shape (types, types) each."""
    found: dict[int, Floats] = {}
    if any(s[1] for s in used):
        found[4] = materials.per_pair("coefficientFriction", types, "tangential_model")
    if any(s[2] for s in used):
        found[5] = materials.per_pair("coefficientRollingFriction", types, "rolling_model")
    if any(s[2] == 2 for s in used):
        found[7] = materials.per_pair(
            "coefficientRollingViscousDamping", types, "rolling_model epsd"
        )
    if any(s[3] for s in used):
        found[6] = materials.per_pair("cohesionEnergyDensity", types, "cohesion_model")
    if any(s[0] == 1 for s in used):
        found[9] = _speed(materials, types, "characteristicVelocity", "normal_model hooke")
    if any(s[9] for s in used):
        found[10] = materials.per_pair("coefficientStaticFriction", types, "staticFriction")
        found[11] = _speed(materials, types, "weakeningVelocity", "staticFriction")
        if (found[10] < found.get(4, found[10])).any():
            msg = (
                "coefficientStaticFriction is below coefficientFriction; friction may only fall "
                "with the sliding speed"
            )
            raise ValueError(msg)
    if any(s[10] for s in used):
        found[12] = materials.per_pair("restitutionExponent", types, "velocityRestitution")
        found[13] = _speed(materials, types, "restitutionVelocity", "velocityRestitution")
        if (found[12] < 0.0).any():
            msg = "restitutionExponent is negative; restitution may only fall with the impact speed"
            raise ValueError(msg)
    return found


def _speed(materials: Materials, types: int, name: str, model: str) -> Floats:
    """Return a characteristic speed for all pairs of types, shape (types, types)."""
    speed = float(materials.of(name, model).ravel()[0])
    if not speed > 0.0:
        msg = f"{name} is {speed:g} m/s; it must be above zero"
        raise ValueError(msg)
    return np.full((types, types), speed)


def active_switches(switches: Sequence[int], table: Floats) -> tuple[int, ...]:
    """Return the switches without the extensions that have no strength.

    Parameters
    ----------
    switches : sequence of int
        See `minidem.kernels.contact.law.SWITCHES`.
    table : ndarray of float64, shape (types**2, columns)
        From `coefficient_table`.
    """
    weakens = switches[9] and bool((table[:, 10] != table[:, 4]).any())
    slows = switches[10] and bool((table[:, 12] != 0.0).any())
    return (*switches[:9], int(weakens), int(slows))
