"""Stiffness and damping of the normal models, from the manual (gran model hertz ...).

Symbols as in `tests.twins.slow.laws`.
"""

from __future__ import annotations

from math import log, pi, sqrt
from typing import NamedTuple

from tests.twins.scene import Model
from tests.twins.slow.touch import Materials, Touch

KT_TO_KN = 0.285714286
"""What ``ktToKnUser on`` multiplies k_t of hooke with, as LIGGGHTS writes it."""


class Stiffness(NamedTuple):
    """k_n and k_t, N/m; g_n and g_t, N s/m."""

    kn: float
    kt: float
    gn: float
    gt: float


def beta(loss: float) -> float:
    """Return B = ln e / sqrt(ln(e)^2 + pi^2) from ln e."""
    return loss / sqrt(loss**2 + pi**2)


def wet_loss(touch: Touch, materials: Materials) -> float:
    """Return ln e of e = e_max exp(St_c / St), with the Stokes number St of the approach."""
    drag = 6.0 * pi * materials.pair("FluidViscosity", *touch.kinds) * touch.radius**2
    critical = materials.pair("CriticalStokes", *touch.kinds)
    most = materials.pair("MaximumRestitution", *touch.kinds)
    return log(most) + critical * drag / (touch.mass * touch.v_n)


def hertz(touch: Touch, materials: Materials, loss: float, model: Model) -> Stiffness:
    """Spring by Hertz and Mindlin, dashpot by Tsuji."""
    Y, G = materials.young(*touch.kinds), materials.shear(*touch.kinds)
    if "tangentialStiffness" in model.on:
        G = G * materials.pair("tangentialStiffnessFactor", *touch.kinds)
    root = sqrt(touch.radius * touch.delta)
    kn, kt = 4.0 / 3.0 * Y * root, 8.0 * G * root
    damping = -2.0 * sqrt(5.0 / 6.0) * beta(loss)
    return Stiffness(
        kn, kt, damping * sqrt(2.0 * Y * root * touch.mass), damping * sqrt(kt * touch.mass)
    )


def hooke(touch: Touch, materials: Materials, loss: float, model: Model) -> Stiffness:
    """Linear spring that stores as much as Hertz' at the characteristic velocity V."""
    Y, m, R = materials.young(*touch.kinds), touch.mass, touch.radius
    V = materials.pair("characteristicVelocity", *touch.kinds)
    kn = 16.0 / 15.0 * sqrt(R) * Y * (15.0 * m * V**2 / (16.0 * sqrt(R) * Y)) ** (1.0 / 5.0)
    kt = kn * KT_TO_KN if "ktToKnUser" in model.on else kn
    g = sqrt(4.0 * m * kn * loss**2 / (loss**2 + pi**2))
    return Stiffness(kn, kt, g, g)


def hooke_stiffness(touch: Touch, materials: Materials, loss: float, model: Model) -> Stiffness:
    """Linear spring and dashpot that are given, the dashpot per mass unless it is absolute."""
    kn, kt = (materials.pair(name, *touch.kinds) for name in ("kn", "kt"))
    if "absolute_damping" in model.on:
        gn, gt = (materials.pair(name, *touch.kinds) for name in ("gamman_abs", "gammat_abs"))
        return Stiffness(kn, kt, gn, gt)
    gn, gt = (touch.mass * materials.pair(name, *touch.kinds) for name in ("gamman", "gammat"))
    return Stiffness(kn, kt, gn, gt)


def hertz_stiffness(touch: Touch, materials: Materials, loss: float, model: Model) -> Stiffness:
    """Return the same, all of it times sqrt(R* delta)."""
    root = sqrt(touch.radius * touch.delta)
    return Stiffness(*(root * value for value in hooke_stiffness(touch, materials, loss, model)))


def damped(kn: float, kt: float, touch: Touch, loss: float) -> Stiffness:
    """Return stiffness with the damping of a linear spring of restitution e."""
    g = 2.0 * sqrt(touch.mass * kn) * abs(beta(loss))
    return Stiffness(kn, kt, g, g)


def hooke_hysteresis(touch: Touch, materials: Materials, loss: float, model: Model) -> Stiffness:
    """Load as hooke does."""
    kn = hooke(touch, materials, loss, model).kn
    return damped(kn, kn, touch, loss)


def luding(touch: Touch, materials: Materials, loss: float, model: Model) -> Stiffness:
    """Load with a stiffness that is given."""
    kn = materials.pair("LoadingStiffness", *touch.kinds)
    return damped(kn, kn, touch, loss)


def edinburgh(touch: Touch, materials: Materials, loss: float, model: Model) -> Stiffness:
    """Load with the prefactor of Hertz, or one of a linear spring."""
    Y, G = materials.young(*touch.kinds), materials.shear(*touch.kinds)
    root = sqrt(touch.radius * touch.delta)
    if materials.pair("overlapExponent", *touch.kinds) == 1.0:
        return damped(2.0 * Y * touch.radius, 2.0 * Y * root, touch, loss)
    return damped(4.0 / 3.0 * Y * sqrt(touch.radius), 8.0 * G * root, touch, loss)


NORMAL = {
    "hertz": hertz,
    "hooke": hooke,
    "hooke/stiffness": hooke_stiffness,
    "hertz/stiffness": hertz_stiffness,
    "hooke/hysteresis": hooke_hysteresis,
    "luding": luding,
    "edinburgh": edinburgh,
    "edinburgh/stiffness": luding,
}
