"""One contact as the textbook has it: from where two bodies are to force, torques and history."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tests.twins.scene import Model
from tests.twins.slow.laws import (
    COHESION,
    NORMAL,
    ROLLING,
    TANGENTIAL,
    Roll,
    Slip,
    scattered_restitution,
    slowed_restitution,
    weakened_friction,
)
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
    "staticFriction": False,
    "velocityRestitution": False,
    "restitutionScatter": False,
    "tangentialStiffness": False,
}
"""Setting to what it is when a script does not say."""


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


def restitution(model: Model, materials: Materials, touch: Touch, speed: float) -> float:
    """Return the restitution of a contact that began at a speed."""
    e = materials.pair("coefficientRestitution", *touch.kinds)
    if is_on(model, "velocityRestitution"):
        e = slowed_restitution(touch, materials, speed)
    if is_on(model, "restitutionScatter"):
        e = scattered_restitution(touch, materials, e, speed)
    return e


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
    e = restitution(model, materials, touch, speed)
    keeps = is_on(model, "velocityRestitution") or is_on(model, "restitutionScatter")
    impact = speed if advance and keeps else history.impact
    k = NORMAL[names["model"]](touch, materials, e, model)
    if not is_on(model, "tangential_damping"):
        k = k._replace(gt=0.0)
    normal = k.kn * touch.delta - k.gn * touch.v_n
    if is_on(model, "limitForce"):
        normal = max(normal, 0.0)
    pull = 0.0
    if names["cohesion"] != "off":
        density = materials.pair("cohesionEnergyDensity", *kinds)
        pull = -density * COHESION[names["cohesion"]](touch)
    pressing = abs(normal + pull) if is_on(model, "tangential_reduce") else abs(normal)
    mu = materials.pair("coefficientFriction", *kinds)
    if is_on(model, "staticFriction"):
        mu = weakened_friction(touch, materials)
    slip = Slip(k, mu * pressing, dt, advance)
    tangential, s, tie = TANGENTIAL[names["tangential"]](touch, slip, history.s)
    roll = Roll(
        k,
        materials.pair("coefficientRollingFriction", *kinds),
        materials.pair("coefficientRollingViscousDamping", *kinds),
        pressing,
        is_on(model, "torsionTorque"),
        dt,
        advance,
    )
    torque, m, tie_rolling = ROLLING[names["rolling_friction"]](touch, roll, history.m)
    lever = np.cross(touch.n, tangential)
    return Result(
        (normal + pull) * touch.n + tangential,
        -touch.arm * lever - torque,
        -touch.other_arm * lever + torque,
        History(s, m, impact),
        tie or tie_rolling,
    )
