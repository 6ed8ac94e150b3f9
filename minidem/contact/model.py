"""Contact models: the words of ``pair_style gran`` and ``wall/gran``, and their coefficients."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import log, pi, sqrt

import numpy as np

from minidem.contact import extensions
from minidem.errors import suggest
from minidem.kernels.contact.law import COLUMNS
from minidem.world.state import Floats

__all__ = [
    "MODELS",
    "SETTINGS",
    "Materials",
    "active_switches",
    "coefficient_table",
    "parse_model",
    "parse_settings",
]

SQRT_5_6 = 0.91287092917527685576161630466800355658790782499663875  # as in LIGGGHTS

MODELS = {
    "model": ("hertz", "hooke"),
    "tangential": ("off", "history", "no_history"),
    "cohesion": ("off", "sjkr", "sjkr2"),
    "rolling_friction": ("off", "cdt", "epsd", "epsd2"),
    "surface": ("default",),
}
"""Keyword of a contact model, in the order of a script, to the names it knows."""

_PLACE = {"model": 0, "tangential": 1, "rolling_friction": 2, "cohesion": 3}
SETTINGS = {
    "tangential_damping": 4,
    "limitForce": 5,
    "torsionTorque": 6,
    "tangential_reduce": 7,
    "ktToKnUser": 8,
}
"""Setting of a contact model that takes on or off to its place in the switches."""

_ALL_SETTINGS = SETTINGS | extensions.SETTINGS


def parse_model(words: Sequence[str]) -> tuple[list[int], list[str]]:
    """Read the model words; they come in a fixed order.

    Returns
    -------
    list of int
        The switches of `minidem.kernels.contact.law.SWITCHES`, settings at their defaults.
    list of str
        The words that follow.

    Raises
    ------
    ValueError
        Unknown model, or keywords in the wrong order.
    """
    switches = [0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0]
    rest = list(words)
    if not rest or rest[0] != "model":
        msg = "expected 'model' first, e.g. 'model hertz tangential history'"
        raise ValueError(msg)
    for key, known in MODELS.items():
        if rest and rest[0] == key:
            if len(rest) < 2:
                msg = f"'{key}' needs a name: {', '.join(known)}"
                raise ValueError(msg)
            if rest[1] not in known:
                near = suggest(rest[1], known)
                msg = f"unknown {key} '{rest[1]}'{near} (known: {', '.join(known)})"
                raise ValueError(msg)
            if key in _PLACE:
                switches[_PLACE[key]] = known.index(rest[1])
            rest = rest[2:]
    if rest and rest[0] in MODELS:
        msg = (
            f"Unknown argument or wrong keyword order: '{rest[0]}'; the order is "
            "model, tangential, cohesion, rolling_friction, surface"
        )
        raise ValueError(msg)
    return switches, rest


def parse_settings(words: Sequence[str], switches: list[int]) -> None:
    """Read the settings at the end of a model into `switches`.

    Raises
    ------
    ValueError
        Unknown setting or a value other than on and off.
    """
    rest = list(words)
    while rest:
        if rest[0] not in _ALL_SETTINGS:
            near = suggest(rest[0], _ALL_SETTINGS)
            msg = f"Unknown argument or wrong keyword order: '{rest[0]}'{near}"
            raise ValueError(msg)
        if len(rest) < 2 or rest[1] not in ("on", "off"):
            msg = f"'{rest[0]}' needs on or off"
            raise ValueError(msg)
        switches[_ALL_SETTINGS[rest[0]]] = int(rest[1] == "on")
        rest = rest[2:]


@dataclass
class Materials:
    """Values given with ``fix property/global``, by name.

    Attributes
    ----------
    values : dict
        Name to array: one value, one per type, or one per pair of types.
    soft, hard : bool
        ``soft_particles yes`` and ``hard_particles yes``: Young's modulus out of the usual range.
    units : str
        si, cgs or lj.
    """

    values: dict[str, Floats] = field(default_factory=dict)
    soft: bool = False
    hard: bool = False
    units: str = "si"

    def per_type(self, name: str, types: int, model: str) -> Floats:
        """Return a property per type, shape (types,).

        Raises
        ------
        ValueError
            If it is missing or has the wrong length.
        """
        found = self._get(name, model)
        if found.size != types:
            msg = f"{name} has {found.size} values, but there are {types} atom types"
            raise ValueError(msg)
        return found

    def per_pair(self, name: str, types: int, model: str) -> Floats:
        """Return a property per pair of types, shape (types, types).

        Raises
        ------
        ValueError
            If it is missing, has the wrong length or is not symmetric.
        """
        found = self._get(name, model)
        if found.size != types * types:
            msg = f"{name} has {found.size} values, but {types} atom types need {types * types}"
            raise ValueError(msg)
        return found.reshape(types, types)

    def _get(self, name: str, model: str) -> Floats:
        if name not in self.values:
            msg = (
                "Could not locate a fix/property storing value(s) for "
                f"{name} as requested by {model}.{suggest(name, self.values)}"
            )
            raise ValueError(msg)
        return self.values[name]

    def check(self) -> None:
        """Apply the sanity limits of LIGGGHTS.

        Raises
        ------
        ValueError
            With the words of LIGGGHTS.
        """
        low, high = {"si": (5e6, 1e9), "cgs": (5e7, 1e10)}.get(self.units, (-np.inf, np.inf))
        label = self.units.upper()
        for young in self.values.get("youngsModulus", np.zeros(0)).ravel():
            if young < low and not self.soft:
                msg = (
                    f"youngsModulus >= {low:.0e} required for {label} units "
                    "(use command 'soft_particles yes' to override)"
                )
                raise ValueError(msg)
            if young > high and not self.hard:
                msg = (
                    f"youngsModulus <= {high:.0e} required for {label} units "
                    "(use command 'hard_particles yes' to override)"
                )
                raise ValueError(msg)
        for nu in self.values.get("poissonsRatio", np.zeros(0)).ravel():
            if not 0.0 <= nu <= 0.5:
                msg = "0 <= poissonsRatio <= 0.5 required"
                raise ValueError(msg)
        for e in self.values.get("coefficientRestitution", np.ones(1)).ravel():
            if not 0.05 < e <= 1.0:
                msg = "0.05 < coefficientRestitution <= 1 required"
                raise ValueError(msg)


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
    speed = float(materials._get(name, model).ravel()[0])
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
