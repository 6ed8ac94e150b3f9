"""Effects that LIGGGHTS 3.8.0 lacks, in its grammar: the one table of their words.

A script that uses one of these words runs on minidem only. ``minidem --strict`` refuses them, so
that a script which passes is a script of LIGGGHTS.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from minidem.errors import ScriptError
from minidem.kernels.columns import SCATTERS, SLOWS, SOFTENS, WEAKENS
from minidem.record import record
from minidem.registry import Registry
from minidem.script import Command

__all__ = ["EXTENSIONS", "SETTINGS", "Extension", "extension_in", "refuse_extension"]


@record(frozen=True)
class Extension:
    """A word that only minidem understands.

    Attributes
    ----------
    word : str
        A fix style, or a setting of a contact model that takes on or off.
    usage : str
        How it is written.
    values : tuple of str
        The ``property/global`` values it needs.
    law, terms : str
        Formula, and what its letters mean.
    source : str
        Where the formula is from.
    """

    word: str
    usage: str
    values: tuple[str, ...]
    law: str
    terms: str
    source: str


EXTENSIONS: Final[Registry[Extension]] = Registry("extension")
"""Word to what it means; a fix style stands in its own file."""

SETTINGS: Final = {
    "staticFriction": WEAKENS,
    "velocityRestitution": SLOWS,
    "restitutionScatter": SCATTERS,
    "tangentialStiffness": SOFTENS,
}
"""Setting of a contact model to its place in the switches, see `minidem.kernels.columns`."""

_SETTING = "after the model of `pair_style gran` or `wall/gran`, like `limitForce`"

EXTENSIONS.register("staticFriction")(
    Extension(
        "staticFriction",
        f"`staticFriction on`, {_SETTING}",
        ("coefficientStaticFriction (pairs of types)", "weakeningVelocity (scalar, m/s)"),
        "mu = mu_k + (mu_s - mu_k) exp(-v_t / v_c)",
        "mu_s is coefficientStaticFriction, mu_k coefficientFriction, v_t the sliding speed, "
        "v_c weakeningVelocity",
        "exponential velocity weakening as in Bo and Pavelescu, Wear 82 (1982) 277",
    )
)
EXTENSIONS.register("velocityRestitution")(
    Extension(
        "velocityRestitution",
        f"`velocityRestitution on`, {_SETTING}",
        ("restitutionExponent (pairs of types)", "restitutionVelocity (scalar, m/s)"),
        "e = e_0 (v / v_0)^-k above v_0, e_0 below",
        "v is the impact speed, that of the first step of the contact, e_0 "
        "coefficientRestitution, v_0 restitutionVelocity, k restitutionExponent; e stays at "
        "least 0.05",
        "power law of impacts with plastic yield (k = 1/4): Johnson, Contact Mechanics (1985), "
        "section 11.5",
    )
)
EXTENSIONS.register("restitutionScatter")(
    Extension(
        "restitutionScatter",
        f"`restitutionScatter on`, {_SETTING}",
        ("restitutionDeviation (pairs of types)",),
        "e = e_0 (1 + s x), at least 0.05 and at most 1",
        "e_0 is coefficientRestitution, or with velocityRestitution what that makes of it, s "
        "restitutionDeviation, x a number of each contact with mean 0 and standard deviation 1, "
        "uniform between -sqrt(3) and sqrt(3); it follows from the impact speed in single "
        "precision, so that equal impacts are equal and a run can be repeated",
        "impacts of rough spheres at one speed scatter: Montaine et al., Phys. Rev. E 84 (2011) "
        "041306, arXiv 1104.0049",
    )
)
EXTENSIONS.register("tangentialStiffness")(
    Extension(
        "tangentialStiffness",
        f"`tangentialStiffness on`, {_SETTING}; with `hertz` only",
        ("tangentialStiffnessFactor (pairs of types)",),
        "k_t = f 8 G* sqrt(R* delta)",
        "f is tangentialStiffnessFactor, above 0, and 8 G* sqrt(R* delta) Mindlin's stiffness of "
        "hertz, which the dashpot of `tangential history` and the rolling spring of `epsd2` follow",
        "factor one: Mindlin, J. Appl. Mech. 16 (1949) 259; below one contacts that slip in part "
        "are softer: Mindlin and Deresiewicz, J. Appl. Mech. 20 (1953) 327",
    )
)


def extension_in(command: str, words: Sequence[str]) -> str | None:
    """Return the first word of a command that only minidem understands, None if there is none.

    Examples
    --------
    >>> extension_in("pair_style", ["gran", "model", "hertz", "staticFriction", "on"])
    'staticFriction'
    >>> extension_in("fix", ["staticFriction", "all", "gravity", "9.81"])
    """
    if command == "fix" and len(words) > 2:
        if words[2] in EXTENSIONS and words[2] not in SETTINGS:
            return words[2]
        words = words[3:] if words[2] == "wall/gran" else ()
    elif command != "pair_style":
        return None
    return next((word for word in words if word in EXTENSIONS), None)


def refuse_extension(command: Command) -> None:
    """Refuse a command with a word that LIGGGHTS 3.8.0 lacks.

    Raises
    ------
    ScriptError
        With file, line, word and remedy.
    """
    word = extension_in(command.name, command.args)
    if word is not None:
        msg = (
            f"'{word}' is an extension of minidem that LIGGGHTS 3.8.0 does not have; "
            "take it out, or run without --strict"
        )
        raise ScriptError(command.file, command.line, msg)
