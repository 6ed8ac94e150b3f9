"""Contact models: the words of ``pair_style gran`` and ``wall/gran``."""

from __future__ import annotations

from collections.abc import Sequence

from minidem.contact import extensions
from minidem.errors import InputError, UnknownWordError, suggest
from minidem.kernels.columns import (
    ABSOLUTE_DAMPING,
    COHESION,
    FIXED_ADHESION,
    KT_TO_KN,
    LIMIT_FORCE,
    LIMITS_LIQUID,
    NORMAL,
    ROLLING,
    SETS_BRIDGES,
    SWITCHES,
    TANGENTIAL,
    TANGENTIAL_DAMPING,
    TANGENTIAL_REDUCE,
    TORSION,
    TORSION_TORQUE,
    VISCOUS,
)
from minidem.kernels.models import LUDING, SJKR, THORNTON_NING, WASHINO

__all__ = ["MODELS", "SETTINGS", "parse_model", "parse_settings"]

MODELS = {
    "model": (
        "hertz", "hooke", "hooke/stiffness", "hertz/stiffness", "hooke/hysteresis", "luding",
        "edinburgh", "edinburgh/stiffness", "thornton_ning",
    ),
    "tangential": ("off", "history", "no_history", "tan_luding"),
    "cohesion": (
        "off", "sjkr", "sjkr2",
        "easo/capillary/viscous", "washino/capillary/viscous",
    ),
    "rolling_friction": ("off", "cdt", "epsd", "epsd2", "epsd3", "luding"),
    "surface": ("default",),
}  # fmt: skip
"""Keyword of a contact model, in the order of a script, to the names it knows."""

LACKING = {
    "multicontact": "contacts do not feel each other in minidem; use surface default",
    "superquadric": "grains are spheres; use rolling friction for their shape",
}
"""Model that LIGGGHTS 3.8.0 has and minidem has not to what may be done."""

_NEITHER = "LIGGGHTS 3.8.0 has none of that name either"

_PLACE = {
    "model": NORMAL,
    "tangential": TANGENTIAL,
    "rolling_friction": ROLLING,
    "cohesion": COHESION,
}
SETTINGS = {
    "tangential_damping": TANGENTIAL_DAMPING,
    "limitForce": LIMIT_FORCE,
    "torsionTorque": TORSION_TORQUE,
    "tangential_reduce": TANGENTIAL_REDUCE,
    "ktToKnUser": KT_TO_KN,
    "absolute_damping": ABSOLUTE_DAMPING,
    "viscous": VISCOUS,
    "fixKc": FIXED_ADHESION,
    "torsion": TORSION,
    "limitLiquidContent": LIMITS_LIQUID,
    "modifyLbVolume": SETS_BRIDGES,
}
"""Setting of a contact model that takes on or off to its place in the switches."""

_ALL_SETTINGS = SETTINGS | extensions.SETTINGS
_HEAT = "heat is not computed; without it the motion is the same"
_ENERGY = "energies of contacts are not kept; the motion does not depend on them"
_BONDS = "bonds between grains are not computed"
ONLY_OFF = {
    "heating_normal_hertz": _HEAT,
    "heating_normal_hooke": _HEAT,
    "heating_tangential_history": _HEAT,
    "heating_tracking": _HEAT,
    "computeElasticPotential": _ENERGY,
    "computeDissipatedEnergy": _ENERGY,
    "disableNormalWhenBonded": _BONDS,
    "disableTangentialWhenBonded": _BONDS,
}
"""Setting of LIGGGHTS that minidem knows as off only to the reason."""

_WITH_SPEED = ("model", ("hertz", "hooke"))
BELONGS_TO = {
    "ktToKnUser": ("model", ("hooke", "hooke/hysteresis")),
    "viscous": ("model", ("hooke", "hooke/hysteresis")),
    "absolute_damping": ("model", ("hooke/stiffness",)),
    "fixKc": ("model", ("edinburgh", "edinburgh/stiffness")),
    "torsion": ("rolling_friction", ("luding",)),
    "torsionTorque": ("rolling_friction", ("cdt", "epsd", "epsd2", "epsd3")),
    "velocityRestitution": _WITH_SPEED,
    "restitutionScatter": _WITH_SPEED,
    "tangential_reduce": ("cohesion", MODELS["cohesion"][SJKR:]),
    "limitLiquidContent": ("cohesion", MODELS["cohesion"][WASHINO:]),
    "modifyLbVolume": ("cohesion", MODELS["cohesion"][WASHINO:]),
    "tangentialStiffness": ("model", ("hertz",)),
}
"""Setting that exists with some models only to their keyword and names."""

EXCLUDES = {"viscous": ("velocityRestitution", "restitutionScatter")}
"""Setting to those that cannot be on with it, as both say what the restitution is."""

_ATTRACTING = MODELS["model"][LUDING:]
_STIFF = MODELS["model"][:THORNTON_NING]
_ADHESION, _STIFFNESS = "the adhesion", "the normal stiffness"
NEEDS = {
    ("tangential", "tan_luding"): (_ADHESION, _ATTRACTING),
    ("rolling_friction", "luding"): (_ADHESION, _ATTRACTING),
} | {("rolling_friction", name): (_STIFFNESS, _STIFF) for name in ("cdt", "epsd", "epsd3")}
"""Keyword and name of a model to what it takes from the normal model, and those that have it."""


def parse_model(words: Sequence[str]) -> tuple[list[int], list[str]]:
    """Read the model words; they come in a fixed order.

    Returns
    -------
    list of int
        The switches, see `minidem.kernels.contact.records.Switches`, settings at their defaults.
    list of str
        The words that follow.

    Raises
    ------
    InputError
        Unknown model, or keywords in the wrong order.
    """
    switches = [0] * SWITCHES
    rest = list(words)
    if not rest or rest[0] != "model":
        found = f", found '{rest[0][:40]}'" if rest else ""
        msg = (
            f"expected 'model' first, e.g. 'model hertz tangential history'{found}; coefficients "
            "stand in fix property/global, not here as in LAMMPS (LIGGGHTS 3.8.0 takes a line "
            "without 'model', and particles then pass through each other)"
        )
        raise InputError(msg)
    for key, known in MODELS.items():
        if rest and rest[0] == key:
            if len(rest) < 2:
                msg = f"'{key}' needs a name: {', '.join(known)}"
                raise InputError(msg)
            if rest[1] not in known:
                raise UnknownWordError(_unknown(key, rest[1]))
            if key in _PLACE:
                switches[_PLACE[key]] = known.index(rest[1])
            rest = rest[2:]
    if rest and rest[0] in MODELS:
        msg = (
            f"Unknown argument or wrong keyword order: '{rest[0]}'; the order is "
            "model, tangential, cohesion, rolling_friction, surface"
        )
        raise InputError(msg)
    for (key, name), (what, normal) in NEEDS.items():
        if _chosen(key, switches) == name and _chosen("model", switches) not in normal:
            msg = (
                f"'{key} {name}' needs {what} of 'model {' or '.join(normal)}', not "
                f"'{_chosen('model', switches)}'; LIGGGHTS would read memory that is not its own"
            )
            raise InputError(msg)
    switches[TANGENTIAL_DAMPING] = 1
    switches[LIMIT_FORCE] = int(switches[NORMAL] >= LUDING)
    return switches, rest


def _unknown(key: str, name: str) -> str:
    """Return what is wrong with the name of a model."""
    known = ", ".join(MODELS[key])
    if name in LACKING:
        return f"'{key} {name}' is not in minidem: {LACKING[name]} (known: {known})"
    told = suggest(name, MODELS[key]) or f": {_NEITHER}"
    if name.startswith("jkr") or key == "cohesion":
        told += "; what attracts in both is cohesion sjkr or sjkr2"
    return f"unknown {key} '{name}'{told} (known: {known})"


def _chosen(key: str, switches: Sequence[int]) -> str:
    """Return the name of the model that was chosen for a keyword."""
    return MODELS[key][switches[_PLACE[key]]]


def parse_settings(words: Sequence[str], switches: list[int]) -> None:
    """Read the settings at the end of a model into `switches`.

    Raises
    ------
    InputError
        Unknown setting, one of a model that is not in use, or a value other than on and off.
    """
    rest = list(words)
    while rest:
        if rest[0] not in _ALL_SETTINGS and rest[0] not in ONLY_OFF:
            near = suggest(rest[0], _ALL_SETTINGS)
            msg = f"Unknown argument or wrong keyword order: '{rest[0]}'{near}"
            raise InputError(msg)
        _refuse_stray(rest[0], switches)
        if len(rest) < 2 or rest[1] not in ("on", "off"):
            msg = f"'{rest[0]}' needs on or off"
            raise InputError(msg)
        if rest[0] in ONLY_OFF and rest[1] == "on":
            msg = f"'{rest[0]} on' is not in minidem: {ONLY_OFF[rest[0]]}; take it out"
            raise UnknownWordError(msg)
        if rest[0] in _ALL_SETTINGS:
            switches[_ALL_SETTINGS[rest[0]]] = int(rest[1] == "on")
        rest = rest[2:]
    for one, others in EXCLUDES.items():
        for other in others:
            if switches[_ALL_SETTINGS[one]] and switches[_ALL_SETTINGS[other]]:
                msg = f"'{one} on' and '{other} on' both set the restitution; take one of them out"
                raise InputError(msg)


def _refuse_stray(setting: str, switches: Sequence[int]) -> None:
    """Refuse a setting of a model that is not in use, as LIGGGHTS does."""
    keyword, names = BELONGS_TO.get(setting, ("", ()))
    if keyword and _chosen(keyword, switches) not in names:
        msg = (
            f"'{setting}' is a setting of '{keyword} {' or '.join(names)}', which is not in use; "
            "take it out (LIGGGHTS: Unknown argument or wrong keyword order)"
        )
        raise InputError(msg)
