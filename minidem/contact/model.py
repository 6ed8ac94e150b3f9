"""Contact models: the words of ``pair_style gran`` and ``wall/gran``."""

from __future__ import annotations

from collections.abc import Sequence

from minidem.contact import extensions
from minidem.errors import InputError, UnknownWordError, suggest
from minidem.kernels.columns import (
    COHESION,
    KT_TO_KN,
    LIMIT_FORCE,
    NORMAL,
    ROLLING,
    SWITCHES,
    TANGENTIAL,
    TANGENTIAL_DAMPING,
    TANGENTIAL_REDUCE,
    TORSION_TORQUE,
)

__all__ = ["MODELS", "SETTINGS", "parse_model", "parse_settings"]

MODELS = {
    "model": ("hertz", "hooke"),
    "tangential": ("off", "history", "no_history"),
    "cohesion": ("off", "sjkr", "sjkr2"),
    "rolling_friction": ("off", "cdt", "epsd", "epsd2"),
    "surface": ("default",),
}
"""Keyword of a contact model, in the order of a script, to the names it knows."""

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
}
"""Setting of a contact model that takes on or off to its place in the switches."""

_ALL_SETTINGS = SETTINGS | extensions.SETTINGS
BELONGS_TO = {
    "ktToKnUser": ("model", ("hooke",)),
    "torsionTorque": ("rolling_friction", ("cdt", "epsd", "epsd2")),
    "tangential_reduce": ("cohesion", ("sjkr", "sjkr2")),
    "tangentialStiffness": ("model", ("hertz",)),
}
"""Setting that exists with some models only to their keyword and names."""


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
    switches[TANGENTIAL_DAMPING] = 1
    rest = list(words)
    if not rest or rest[0] != "model":
        msg = "expected 'model' first, e.g. 'model hertz tangential history'"
        raise InputError(msg)
    for key, known in MODELS.items():
        if rest and rest[0] == key:
            if len(rest) < 2:
                msg = f"'{key}' needs a name: {', '.join(known)}"
                raise InputError(msg)
            if rest[1] not in known:
                near = suggest(rest[1], known)
                msg = f"unknown {key} '{rest[1]}'{near} (known: {', '.join(known)})"
                raise UnknownWordError(msg)
            if key in _PLACE:
                switches[_PLACE[key]] = known.index(rest[1])
            rest = rest[2:]
    if rest and rest[0] in MODELS:
        msg = (
            f"Unknown argument or wrong keyword order: '{rest[0]}'; the order is "
            "model, tangential, cohesion, rolling_friction, surface"
        )
        raise InputError(msg)
    return switches, rest


def parse_settings(words: Sequence[str], switches: list[int]) -> None:
    """Read the settings at the end of a model into `switches`.

    Raises
    ------
    InputError
        Unknown setting, one of a model that is not in use, or a value other than on and off.
    """
    rest = list(words)
    while rest:
        if rest[0] not in _ALL_SETTINGS:
            near = suggest(rest[0], _ALL_SETTINGS)
            msg = f"Unknown argument or wrong keyword order: '{rest[0]}'{near}"
            raise InputError(msg)
        _refuse_stray(rest[0], switches)
        if len(rest) < 2 or rest[1] not in ("on", "off"):
            msg = f"'{rest[0]}' needs on or off"
            raise InputError(msg)
        switches[_ALL_SETTINGS[rest[0]]] = int(rest[1] == "on")
        rest = rest[2:]


def _refuse_stray(setting: str, switches: Sequence[int]) -> None:
    """Refuse a setting of a model that is not in use, as LIGGGHTS does."""
    keyword, names = BELONGS_TO.get(setting, ("", ()))
    if keyword and MODELS[keyword][switches[_PLACE[keyword]]] not in names:
        msg = (
            f"'{setting}' is a setting of '{keyword} {' or '.join(names)}', which is not in use; "
            "take it out (LIGGGHTS: Unknown argument or wrong keyword order)"
        )
        raise InputError(msg)
