"""Normal models that keep how far a contact was loaded, as the manual and the papers have them.

``hooke/hysteresis`` and ``luding``: Luding, Granular Matter 10 (2008) 235; ``edinburgh``: Thakur et
al., Granular Matter 16 (2014) 383, kc from the surface energy as in LIGGGHTS-PUBLIC 3.8.0.

Symbols: k_1 stiffness of loading, k_2 of unloading, k_c of adhesion, delta_max the largest overlap,
n and m the exponents of overlap and adhesion.
"""

from __future__ import annotations

from collections.abc import Callable
from math import nan, pi, sqrt
from typing import NamedTuple

from tests.twins.slow.touch import History, Materials, Touch

CLOSE = 1e-9


class Spring(NamedTuple):
    """Elastic force, N, what is kept, what a pull-off force and adhesion add, see `contact`.

    Attributes
    ----------
    force : float
        Without pull-off force, N.
    pull_off : float
        N.
    held : float
        k_c delta - pull-off force, N.
    clipped : bool
        True if ``limitForce`` acts.
    largest, latest, adhesion : float
        Of the history; the last is nan where rounding decides.
    tie : bool
        True if rounding decides which branch it is on.
    """

    force: float
    pull_off: float
    held: float
    clipped: bool
    largest: float
    latest: float = 0.0
    adhesion: float = 0.0
    tie: bool = False


class Kept(NamedTuple):
    """What the models take beside contact and values: k_1, history, and whether it advances."""

    k1: float
    history: History
    fixed: bool
    advance: bool


def branches(delta: float, largest: float, full: float, k1: float, k2: float, kc: float) -> float:
    """Return the force of the branch that is in the middle: loading, unloading, adhesion."""
    if largest >= full:
        return max(k2 * (delta - full) + k1 * full, -kc * delta)
    k = k1 + (k2 - k1) * largest / full
    return max(min(k * (delta - largest) + k1 * largest, k1 * delta), -kc * delta)


def hooke_hysteresis(touch: Touch, materials: Materials, kept: Kept) -> Spring:
    """Return the spring of Luding with the stiffness of hooke."""
    k1, delta = kept.k1, touch.delta
    k2 = k1 * materials.pair("coefficientMaxElasticStiffness", *touch.kinds)
    kc = k1 * materials.pair("coefficientAdhesionStiffness", *touch.kinds)
    depth = materials.pair("coefficientPlasticityDepth", *touch.kinds)
    full = k2 / (k2 - k1) * depth * 2.0 * touch.radius
    largest = max(kept.history.largest, delta)
    force = branches(delta, largest, full, k1, k2, kc)
    tie = False
    if force == -kc * delta and kept.advance:
        largest = (delta + sqrt(delta**2 + 4.0 * (k1 + kc) * delta * full / (k2 - k1))) / 2.0
    return Spring(force, 0.0, 0.0, False, largest, tie=tie)


def luding(touch: Touch, materials: Materials, kept: Kept) -> Spring:
    """Return the spring of Luding with stiffness that is given."""
    k1, delta = kept.k1, touch.delta
    k2 = k1 * materials.pair("UnloadingStiffness", *touch.kinds)
    kc = k1 * materials.pair("coefficientAdhesionStiffness", *touch.kinds)
    pull_off = materials.pair("pullOffForce", *touch.kinds)
    depth = materials.pair("coefficientPlasticityDepth", *touch.kinds)
    full = k2 / (k2 - k1) * depth * 2.0 * touch.radius
    largest = max(kept.history.largest, delta)
    force = branches(delta, largest, full, k1, k2, kc)
    if force == -kc * delta:
        if largest < full:
            k2 = k1 + (k2 - k1) * largest / full
        largest = (k2 + kc) / (k2 - k1) * delta
    clipped = kc == 0.0 and pull_off == 0.0
    return Spring(force, pull_off, kc * delta - pull_off, clipped, largest, adhesion=kc)


def edinburgh(touch: Touch, materials: Materials, kept: Kept) -> Spring:
    """Return the spring of Thakur et al."""
    k1, delta = kept.k1, touch.delta
    n = materials.pair("overlapExponent", *touch.kinds)
    m = materials.pair("adhesionExponent", *touch.kinds)
    k2 = k1 * materials.pair("UnloadingStiffness", *touch.kinds)
    pull_off = materials.pair("pullOffForce", *touch.kinds)
    if kept.fixed:
        kc = k1 * materials.pair("coefficientAdhesionStiffness", *touch.kinds)
        largest = max(kept.history.largest, delta)
        unloading = k2 * (delta**n - largest**n) + k1 * largest**n
        force = max(min(unloading, k1 * delta**n), -kc * delta**m)
        if force == -kc * delta**m:
            largest = (k2 + kc) / (k2 - k1) * delta
        return Spring(force, pull_off, kc * delta - pull_off, pull_off == 0.0, largest, adhesion=kc)
    latest, kc, tie = kept.history.latest, 0.0, False
    plastic = max(kept.history.largest, (1.0 - k1 / k2) ** (1.0 / n) * delta)
    apart = touch.i.radius
    if touch.j.radius is not None:
        apart += touch.j.radius - plastic
    while True:
        force = k2 * (delta**n - plastic**n)
        if abs(force - k1 * delta**n) < CLOSE * force:
            # at first loading the branches meet: rounding decides whether k_c is worked out
            kc = adhesion(touch, materials, k2, plastic, apart)
            force, kc = k1 * delta**n, nan if kc != kept.history.adhesion else kc
            break
        if force > k1 * delta**n:
            force = k1 * delta**n
            break
        kc = adhesion(touch, materials, k2, plastic, apart)
        if force > -kc * delta**m:
            break
        force = -kc * delta**m
        tie = abs(delta - latest) < CLOSE * delta
        if delta <= latest:
            break
        plastic = (latest**n + kc / k2 * latest**m) ** (1.0 / n)
    kept_kc = kc if kc != 0.0 or force < k1 * delta**n else kept.history.adhesion
    held = kept_kc * delta - pull_off
    clipped = kc == 0.0 and pull_off == 0.0
    return Spring(force, pull_off, held, clipped, plastic, delta, kept_kc, tie)


def adhesion(touch: Touch, materials: Materials, k2: float, plastic: float, apart: float) -> float:
    """Return the k_c at which the pull of the surface energy is reached on unloading."""
    n = materials.pair("overlapExponent", *touch.kinds)
    m = materials.pair("adhesionExponent", *touch.kinds)
    a = 0.0  # radius of the circle in which the spheres intersect; LIGGGHTS has none for walls
    if touch.j.radius is not None:
        ri, rj = touch.i.radius, touch.j.radius
        a = sqrt(4.0 * apart**2 * ri**2 - (apart**2 - rj**2 + ri**2) ** 2) / (2.0 * apart)
    pull = 1.5 * pi * materials.pair("surfaceEnergy", *touch.kinds) * a
    most = k2 * plastic**n / 2.0
    if pull > most:
        return most / (plastic / 2.0) ** m
    return pull / (plastic**n - pull / k2) ** (m / n)


PLASTIC: dict[str, Callable[[Touch, Materials, Kept], Spring]] = {
    "hooke/hysteresis": hooke_hysteresis,
    "luding": luding,
    "edinburgh": edinburgh,
    "edinburgh/stiffness": edinburgh,
}
