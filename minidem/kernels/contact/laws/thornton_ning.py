"""Elastic, plastic and adhesive spheres by steps of the force: ``model thornton_ning``.

Thornton and Ning, Powder Technology 99 (1998) 154, in the form that LIGGGHTS 3.8.0 has. The force
of a step is that of the step before and what the change of overlap adds; it has no dashpot.
"""

from __future__ import annotations

from math import inf, nan, pi, sqrt
from typing import Any

import numpy as np

from minidem.kernels.columns import (  # isort: skip
    LARGEST, LATEST, FORCE_BEFORE, FORCE_MOST, PARTED_AT, PARTED_FORCE, STAGE,
)  # fmt: skip
from minidem.kernels.machine.jit import inlined, inner
from minidem.kernels.models import SURFACE_ENERGY, YIELD_RATIO

__all__ = ["BEGUN", "NECKED", "PARTED", "UNLOADED", "YIELDED", "thornton_ning"]

BEGUN, NECKED, PARTED, YIELDED = 1, 2, 4, 8  # bits of `STAGE`
UNLOADED = 16  # it has yielded, and was unloaded in the step before: the pull-off force is another
# parts of the pull-off force: that of a new contact, and that with which a neck breaks
SNAP_IN, SNAP_OFF = -8.0 / 9.0, -5.0 / 9.0
ONE_THIRD = 1.0 / 3.0


@inner
def thornton_ning(contact: Any, own: Any, values: Any, radius: float, history: Any) -> Any:
    """Return normal force, N, tangential stiffness, N/m, and damping, kg/s, and pull-off force, N.

    Parameters
    ----------
    contact, own : Contact, Material
        See `minidem.kernels.contact.records`.
    values : float64 (columns,)
        Coefficients of the pair of types.
    radius : float
        Of the first particle, m: its contact yields first.
    history : float64 (14,)
        Of the contact; it is kept at setup too, when the overlap does not change.

    Notes
    -----
    As in LIGGGHTS tangential damping has the wrong sign, and ``tangential_damping`` and
    ``limitForce`` do nothing. A yield stress of 0 or less, with which LIGGGHTS stops, gives nan.
    While a contact is parted, history holds where it parted.
    """
    young, reff, overlap, energy = (
        own.young,
        contact.radius,
        contact.overlap,
        values[SURFACE_ENERGY],
    )
    pull = 1.5 * pi * energy * reff
    kt = 8.0 * own.shear * sqrt(reff * overlap)
    gt = -own.damping * sqrt(kt * contact.mass)
    stage = np.int64(history[STAGE])
    if not stage & BEGUN:
        stage = np.int64(BEGUN)
        history[LATEST] = 0.0
        history[LARGEST] = 0.0
        history[FORCE_BEFORE] = SNAP_IN * pull
        history[FORCE_MOST] = SNAP_IN * pull
        history[PARTED_AT] = 0.0
        history[PARTED_FORCE] = SNAP_OFF * pull
    stage &= ~UNLOADED
    if stage & PARTED and overlap < history[LATEST]:
        history[STAGE] = stage
        history[FORCE_MOST] = max(history[FORCE_MOST], 0.0)
        return 0.0, kt, gt, pull
    if stage & PARTED:
        stage &= ~PARTED
        history[PARTED_AT] = history[LATEST]
        history[PARTED_FORCE] = history[FORCE_BEFORE]
    before, last = history[FORCE_BEFORE], history[LATEST]
    moved = overlap - last
    held = pull
    loading = overlap >= history[LARGEST]
    edge = radius * values[YIELD_RATIO]
    inner_force = 0.0
    strength = 0.0
    if loading:
        history[LARGEST] = overlap
        inner_force = _inner(before, pull, 0)
        if _width(inner_force, young, reff, overlap, energy) >= edge:
            stage |= YIELDED
    elif stage & YIELDED:
        most = history[FORCE_MOST]
        inner_force = _inner(most, pull, 0)
        reff *= inner_force / (most + _root(4.0 * pull * inner_force))
        pull = 1.5 * pi * energy * reff
        held = -pull
        stage |= UNLOADED
    yields = loading and stage & YIELDED != 0
    change = 0.0
    if loading:
        strength, least = _strength(contact.radius, edge, young, energy)
        yields = yields or strength < least
        if not strength > 0.0:
            change = nan
    if yields:
        change += _plastic_slope(inner_force, pull, young, reff, edge, strength) * moved
    else:
        necked = stage & NECKED
        change += _elastic_step(before, pull, necked, young, reff, overlap, moved, energy)
    stage, force = _part(
        stage, before, change, pull, (young, reff, overlap, moved, energy), history, last
    )
    history[FORCE_MOST] = max(history[FORCE_MOST], force)
    history[STAGE] = stage
    return force, kt, gt, held


@inlined
def _part(
    stage: Any, before: float, change: float, pull: float, state: Any, history: Any, last: float
) -> Any:
    """Return stage and force of a contact whose neck may break; keep what the next step needs."""
    young, reff, overlap, moved, energy = state
    force = before + change
    history[LATEST] = overlap
    history[FORCE_BEFORE] = force
    if energy == 0.0 and force < 0.0:
        history[FORCE_BEFORE] = 0.0
        return stage | PARTED, 0.0
    if force < -pull:
        stage ^= NECKED
        necked = stage & NECKED
        change = _elastic_step(before, pull, necked, young, reff, overlap, moved, energy)
        force = before + change
        history[FORCE_BEFORE] = force
    if stage & NECKED and force + 3.0 * change >= SNAP_OFF * pull:
        history[LATEST] = last
        history[FORCE_BEFORE] = before
        return stage | PARTED, 0.0
    return stage, force


@inlined
def _strength(reff: float, edge: float, young: float, energy: float) -> Any:
    """Return the yield stress, and that below which a contact is plastic at once, Pa."""
    strength = 2.0 * young * edge / (pi * reff)
    if edge > 0.0:
        strength -= sqrt(2.0 * energy * young / (pi * edge))
    elif energy > 0.0:
        strength = -inf
    return strength, (2.0 * young * young * energy / (pi * pi * reff)) ** ONE_THIRD


@inlined
def _root(square: float) -> Any:
    """Return the root, nan below zero."""
    return sqrt(square) if square >= 0.0 else nan


@inlined
def _inner(force: float, pull: float, necked: Any) -> Any:
    """Return the force without adhesion that gives the same contact radius, N."""
    root = _root(pull * (force + pull))
    return force + 2.0 * (pull - root) if necked else force + 2.0 * (pull + root)


@inlined
def _width(inner_force: float, young: float, reff: float, overlap: float, energy: float) -> Any:
    """Return the contact radius, m."""
    if energy == 0.0:
        return sqrt(reff * overlap)
    cube = 3.0 * reff * inner_force / (4.0 * young)
    return cube**ONE_THIRD if cube >= 0.0 else nan


@inlined
def _elastic_step(
    before: float, pull: float, necked: Any, young: float, reff: float, overlap: float,
    moved: float, energy: float,
) -> Any:  # fmt: skip
    """Return what a change of overlap adds to the force of an elastic contact, N."""
    inner_force = _inner(before, pull, necked)
    slope = 2.0 * young * _width(inner_force, young, reff, overlap, energy)
    if pull != 0.0:
        root, least = _root(inner_force), sqrt(pull)
        slope *= (3.0 * root - 3.0 * least) / (3.0 * root - least)
    return slope * moved


@inlined
def _plastic_slope(
    inner_force: float, pull: float, young: float, reff: float, edge: float, strength: float
) -> Any:
    """Return the stiffness of a contact that yields, N/m."""
    if pull == 0.0:
        return 2.0 * young * edge
    root, least = _root(inner_force), sqrt(pull)
    over = 3.0 * pi * reff * strength * root - 2.0 * edge * young * least
    return over / (3.0 * root - least)
