"""One contact as the textbook has it: from where two bodies are to force, torques and history."""

from __future__ import annotations

from math import isnan, log
from typing import NamedTuple

import numpy as np

from tests.twins.scene import Model
from tests.twins.slow.laws import (
    COHESION,
    ROLLING,
    TANGENTIAL,
    Roll,
    Slip,
    scattered_restitution,
    slowed_restitution,
    weakened_friction,
)
from tests.twins.slow.normal import NORMAL, Stiffness, wet_loss
from tests.twins.slow.plastic import PLASTIC, Kept, Spring
from tests.twins.slow.touch import History, Materials, Touch

MODELS = {
    "model": NORMAL,
    "tangential": TANGENTIAL,
    "cohesion": COHESION,
    "rolling_friction": ROLLING,
    "surface": {"default": None},
}
"""Keyword of a contact model to the laws that this module has, by name."""

SETTINGS = {
    "tangential_damping": True,
    "limitForce": False,
    "torsionTorque": False,
    "tangential_reduce": False,
    "ktToKnUser": False,
    "absolute_damping": False,
    "viscous": False,
    "fixKc": False,
    "torsion": False,
    "staticFriction": False,
    "velocityRestitution": False,
    "restitutionScatter": False,
    "tangentialStiffness": False,
}
"""Setting to what it is when a script does not say."""


LUDING_SLIDING = ("coeffFrictionStiffness", "FrictionViscosity", "FluidViscosity")
"""Of tan_luding: stiffness and damping over those of the normal model, dynamic over static."""

ROLLING_STIFFNESS = ("rollingStiffness", "coeffRollingStiffness")
"""Of epsd3, of luding."""


class Result(NamedTuple):
    """What a contact does.

    Attributes
    ----------
    force, torque, torque_other : ndarray, shape (3,)
        On the sphere, N; on the sphere and on the other, N m.
    history : History
        To be kept.
    tie : bool
        True if a spring is at its limit to many digits: rounding decides whether it slides, and
        only a spring that does not slide is damped. That happens where a run begins in a sliding
        contact whose normal force does not depend on the velocity.
    """

    force: np.ndarray
    torque: np.ndarray
    torque_other: np.ndarray
    history: History
    tie: bool


def is_on(model: Model, setting: str) -> bool:
    """Return whether a setting is on."""
    return setting in model.on or (SETTINGS[setting] and setting not in model.off)


def loss(model: Model, materials: Materials, touch: Touch, speed: float) -> float:
    """Return ln e with the restitution e of a contact that began at a speed."""
    if is_on(model, "viscous"):
        return wet_loss(touch, materials)
    e = materials.pair("coefficientRestitution", *touch.kinds)
    if is_on(model, "velocityRestitution"):
        e = slowed_restitution(touch, materials, speed)
    if is_on(model, "restitutionScatter"):
        e = scattered_restitution(touch, materials, e, speed)
    return log(e)


def rolling(model: Model, materials: Materials, kinds: tuple[int, int]) -> Roll:
    """Return what rolling models take from values and settings; the rest is zero."""
    return Roll(
        Stiffness(0.0, 0.0, 0.0, 0.0),
        materials.pair("coefficientRollingFriction", *kinds),
        materials.pair("coefficientRollingViscousDamping", *kinds),
        0.0,
        is_on(model, "torsionTorque"),
        0.0,
        advance=False,
        stiffness=materials.pair(
            ROLLING_STIFFNESS[model.names["rolling_friction"] == "luding"], *kinds
        ),
        torsion=is_on(model, "torsion"),
    )


def like_luding(slip: Slip, materials: Materials, kinds: tuple[int, int]) -> Slip:
    """Return what tan_luding makes of stiffness and damping, and its dynamic friction."""
    kt, gt, dynamic = (materials.pair(name, *kinds) for name in LUDING_SLIDING)
    k = slip.k._replace(kt=slip.k.kt * kt, gt=slip.k.gt * gt)
    return slip._replace(k=k, slip=dynamic)


def contact(
    model: Model, materials: Materials, touch: Touch, history: History, *, dt: float, advance: bool
) -> Result:
    """Return what a contact does.

    Parameters
    ----------
    model, materials : Model, Materials
        Laws and values.
    touch : Touch
        The contact.
    history : History
        Of the step before.
    dt : float
        s.
    advance : bool
        False at the start of a run: forces are worked out, histories stay.
    """
    names, kinds = model.names, touch.kinds
    speed = history.impact or abs(touch.v_n)
    keeps = is_on(model, "velocityRestitution") or is_on(model, "restitutionScatter")
    impact = speed if advance and keeps else history.impact
    k = NORMAL[names["model"]](touch, materials, loss(model, materials, touch, speed), model)
    if not is_on(model, "tangential_damping"):
        k = k._replace(gt=0.0)
    spring = Spring(k.kn * touch.delta, 0.0, 0.0, clipped=True, largest=0.0)
    if names["model"] in PLASTIC:
        kept = Kept(k.kn, history, is_on(model, "fixKc"), advance)
        spring = PLASTIC[names["model"]](touch, materials, kept)
    normal = spring.force + spring.pull_off - k.gn * touch.v_n
    undecided = spring.tie
    if is_on(model, "limitForce") and normal < 0.0:
        undecided, normal = undecided | isnan(spring.adhesion), 0.0 if spring.clipped else normal
    pull = 0.0
    if names["cohesion"] != "off":
        density = materials.pair("cohesionEnergyDensity", *kinds)
        pull = -density * COHESION[names["cohesion"]](touch)
    pressed = normal + pull if is_on(model, "tangential_reduce") else normal
    pressing, held = abs(pressed), abs(pressed + spring.held)
    mu = materials.pair("coefficientFriction", *kinds)
    if is_on(model, "staticFriction"):
        mu = weakened_friction(touch, materials)
    slip = Slip(k, mu * pressing, dt, advance)
    if names["tangential"] == "tan_luding":
        slip = like_luding(slip._replace(limit=mu * held), materials, kinds)
    tangential, s, tie = TANGENTIAL[names["tangential"]](touch, slip, history.s)
    roll = rolling(model, materials, kinds)._replace(
        k=k, force=pressing, held=held, dt=dt, advance=advance
    )
    torque, m, tie_rolling = ROLLING[names["rolling_friction"]](touch, roll, history.m)
    if "luding" in names["tangential"] + names["rolling_friction"]:
        undecided |= isnan(held)
    lever = np.cross(touch.n, tangential)
    return Result(
        (normal + pull) * touch.n + tangential,
        -touch.arm * lever - torque,
        -touch.other_arm * lever + torque,
        History(s, m, impact, spring.largest, spring.latest, spring.adhesion),
        tie or tie_rolling or undecided,
    )
