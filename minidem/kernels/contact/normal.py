"""Contacts of any model, one at a time: the normal models that have no loop of their own.

These are ``hooke/stiffness``, ``hertz/stiffness``, ``hooke/hysteresis``, ``luding``,
``edinburgh``, ``edinburgh/stiffness`` and ``thornton_ning`` with the formulas of LIGGGHTS-PUBLIC
3.8.0; liquid bridges between surfaces that touch belong to contacts of any normal model.
"""

from __future__ import annotations

from math import pi, sqrt
from typing import Any

from minidem.kernels.columns import (  # isort: skip
    RADIUS, IMPACT, ADHESION, TYPES, DT,
)  # fmt: skip
from minidem.kernels.models import (  # isort: skip
    HOOKE, HOOKE_STIFFNESS, HERTZ_STIFFNESS, HOOKE_HYSTERESIS, LUDING, EDINBURGH, THORNTON_NING,
    EASO, EPSD2, EPSD3,
    ROLL_LUDING, NORMAL_STIFFNESS, TANGENTIAL_STIFFNESS, NORMAL_RATE, TANGENTIAL_RATE,
    NORMAL_DASHPOT, TANGENTIAL_DASHPOT, FLUID_VISCOSITY, ROLLING_STIFFNESS, LOADING, PULL_OFF,
    OVERLAP_EXPONENT, SLIDING_VISCOSITY, SLIDING_STIFFNESS, TURNING_STIFFNESS,
)  # fmt: skip
from minidem.kernels.contact.extended import extended_contact
from minidem.kernels.contact.law import EPSD_STIFFNESS, approach, hooke_stiffness, respond, spring
from minidem.kernels.contact.laws.bridges import soaked
from minidem.kernels.contact.laws.hysteresis import piecewise, powers
from minidem.kernels.contact.laws.liquid import drops_of
from minidem.kernels.contact.laws.thornton_ning import thornton_ning
from minidem.kernels.contact.records import Load, recall, remember
from minidem.kernels.machine.jit import inlined, inner

__all__ = ["act"]


@inlined
def act(
    model: Any, bodies: Any, q: Any, contact: Any, who: Any, hist: Any, k: Any, update: int
) -> Any:
    """Return what a contact of any model does, and keep its history.

    Parameters
    ----------
    model : Switches
        Models.
    bodies : Bodies
        See `minidem.kernels.scene`.
    q : int
        Row of the pair of types.
    contact : Contact
        Geometry and motion.
    who : (int, int)
        Rows of the particles; the second is -1 for a wall.
    hist : float64 (n, 3, 6, 7, 10 or 14)
        Histories.
    k : int
        Row of this contact.
    update : int
        1 in a time step, 0 at setup.

    Returns
    -------
    Reaction
        Force and torques.
    """
    keeps = hist.shape[1] > IMPACT
    before = hist[k, IMPACT] if keeps else 0.0
    own, impact = extended_contact(model, bodies.coef, q, contact, before, update)
    if keeps:
        hist[k, IMPACT] = impact
    i, j = who
    row = bodies.parts.row
    sizes = row[i, RADIUS], row[j, RADIUS] if j >= 0 else 0.0
    if model.normal <= HOOKE and model.rolling <= EPSD2:
        load = spring(model, own, contact)
    else:
        if model.normal == THORNTON_NING and j >= 0 and bodies.parts.rank[j] < bodies.parts.rank[i]:
            # what yields first is the one that LIGGGHTS would hold first
            ri, rj = sizes
            sizes = rj, ri
            q = bodies.parts.kind[j] * bodies.control.whole[TYPES] + bodies.parts.kind[i]
        load = _load(model, own, contact, sizes, bodies.coef[q], hist[k], update)
    if model.cohesion >= EASO:
        drops = drops_of(model, bodies, q, who)
        pull, drag = soaked(
            model.cohesion, bodies.coef[q], sizes, contact.overlap, approach(contact), drops
        )
        load = _with_bridge(load, pull, drag)
    dt = bodies.control.real[DT]
    did, kept = respond(model, own, contact, recall(hist, k), load, update, dt)
    remember(hist, k, kept)
    return did


@inlined
def _with_bridge(load: Any, pull: float, drag: float) -> Any:
    """Return a `Load` with the force and the drag of a liquid bridge."""
    return Load(
        load.kn, load.kt, load.gt, load.elastic, load.force, load.held, load.slide_stiffness,
        load.slide_damping, load.slip, load.roll_stiffness, load.turn, pull, drag,
    )  # fmt: skip


@inner
def _load(
    model: Any, own: Any, contact: Any, sizes: Any, values: Any, history: Any, update: int
) -> Any:
    """Return the `Load` of any normal model with what further rolling and sliding models need.

    Parameters
    ----------
    model, own, contact : Switches, Material, Contact
        See `minidem.kernels.contact.records`.
    sizes : (float, float)
        Radii, m; the second is 0 for a wall.
    update : int
        As for `act`.
    values : float64 (columns,)
        Coefficients of the pair of types.
    history : float64 (columns,)
        Of the contact.
    """
    held = 0.0
    if model.normal <= HOOKE:
        usual = spring(model, own, contact)
        kn, kt, gt, elastic, fn = usual.kn, usual.kt, usual.gt, usual.elastic, usual.force
    elif model.normal <= HERTZ_STIFFNESS:
        kn, kt, gn, gt = _given(model, contact, values)
        elastic = kn * contact.overlap
        fn = elastic - gn * approach(contact)
        if model.limit_force == 1 and fn < 0.0:
            fn = 0.0
    elif model.normal == THORNTON_NING:
        radius, _ = sizes
        fn, kt, gt, pull = thornton_ning(contact, own, values, radius, history)
        kn, elastic, held = 0.0, 0.0, -pull
    else:
        kn, kt, elastic, kc = _plastic(model, own, contact, sizes, values, history, update)
        loss = pi / own.log_restitution
        gt = sqrt(4.0 * contact.mass * kn / (1.0 + loss * loss))
        fn = elastic - gt * approach(contact)
        if model.normal != HOOKE_HYSTERESIS:
            pull = values[PULL_OFF]
            fn += pull
            if model.limit_force == 1 and fn < 0.0 and kc == 0.0 and pull == 0.0:
                fn = 0.0
            held = history[ADHESION] * contact.overlap - pull
    if model.tangential_damping == 0 and model.normal != THORNTON_NING:
        gt = 0.0
    roll = EPSD_STIFFNESS
    if model.rolling == EPSD3:
        roll = values[ROLLING_STIFFNESS]
    elif model.rolling == ROLL_LUDING:
        roll = values[TURNING_STIFFNESS]
    turn = 0.0
    ri, rj = sizes
    if rj == 0.0:
        turn = (ri - contact.overlap) / (ri - 0.5 * contact.overlap)
    return Load(
        kn, kt, gt, elastic if model.normal <= HERTZ_STIFFNESS else kn * contact.overlap, fn, held,
        values[SLIDING_STIFFNESS], values[SLIDING_VISCOSITY], values[FLUID_VISCOSITY], roll, turn,
        0.0, 0.0,
    )  # fmt: skip


@inlined
def _given(model: Any, contact: Any, values: Any) -> Any:
    """Return stiffness, N/m, and damping, kg/s, of ``hooke/stiffness`` and ``hertz/stiffness``."""
    kn, kt = values[NORMAL_STIFFNESS], values[TANGENTIAL_STIFFNESS]
    if model.normal == HOOKE_STIFFNESS and model.absolute_damping == 1:
        return kn, kt, values[NORMAL_DASHPOT], values[TANGENTIAL_DASHPOT]
    scale = 1.0
    if model.normal == HERTZ_STIFFNESS:
        scale = sqrt(contact.radius * contact.overlap)
    weight = scale * contact.mass
    return (
        scale * kn, scale * kt, weight * values[NORMAL_RATE], weight * values[TANGENTIAL_RATE],
    )  # fmt: skip


@inlined
def _plastic(
    model: Any, own: Any, contact: Any, sizes: Any, values: Any, history: Any, update: int
) -> Any:
    """Return stiffness, N/m, elastic force, N, and adhesion of a model that keeps its load."""
    if model.normal == HOOKE_HYSTERESIS or model.normal == LUDING:
        kn = values[LOADING]
        if model.normal == HOOKE_HYSTERESIS:
            kn = hooke_stiffness(own, contact)
        elastic, kc = piecewise(model.normal, contact, values, kn, history, update)
        return kn, kn, elastic, kc
    if model.normal == EDINBURGH:
        root = sqrt(contact.radius * contact.overlap)
        kn = 4.0 / 3.0 * own.young * sqrt(contact.radius)
        kt = 8.0 * own.shear * root
        if values[OVERLAP_EXPONENT] == 1.0:
            kn = 2.0 * own.young * contact.radius
            kt = 2.0 * own.young * root
    else:
        kn = values[LOADING]
        kt = kn
    elastic, kc = powers(contact, sizes, values, kn, history, model.fixed_adhesion)
    return kn, kt, elastic, kc
