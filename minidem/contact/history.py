"""The numbers that contacts keep, in the order in which LIGGGHTS has them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from minidem.kernels.columns import (
    ADHESION,
    COHESION,
    FORCE_BEFORE,
    FORCE_MOST,
    LARGEST,
    LATEST,
    NORMAL,
    PARTED_AT,
    PARTED_FORCE,
    REMEMBERED,
    ROLLING,
    SLIDING_ONLY,
    STAGE,
    TANGENTIAL,
    WITH_ROLLING,
)
from minidem.kernels.contact.laws.thornton_ning import BEGUN, NECKED, PARTED, UNLOADED, YIELDED
from minidem.kernels.models import (
    EASO,
    EDINBURGH,
    EPSD,
    HISTORY,
    HOOKE_HYSTERESIS,
    LUDING,
    ROLL_LUDING,
    TAN_LUDING,
    THORNTON_NING,
)
from minidem.world.state import Floats

__all__ = ["BRIDGE", "PULL", "TORSION", "YIELDING", "history_slots", "yielding", "yielding_columns"]

BRIDGE: Final = -1
"""Whether there is a liquid bridge; every contact that is kept has one."""
PULL: Final = -2
"""The pull-off force of the pair of materials, N."""
TORSION: Final = -3
"""Of rolling friction ``luding``, which does not use it."""
YIELDING: Final = tuple(range(-4, -16, -1))
"""The twelve numbers of ``thornton_ning``, see `yielding`; minidem keeps them in another form."""


def history_slots(switches: Sequence[int]) -> list[int]:
    """Return the columns of ``Pairs.hist`` that stand for the history values of LIGGGHTS.

    Parameters
    ----------
    switches : sequence of int
        Contact model, see `minidem.kernels.contact.records.Switches`.

    Returns
    -------
    list of int
        A column per value; below zero `BRIDGE`, `PULL`, `TORSION` or one of `YIELDING`, which
        minidem does not keep as they are.
    """
    normal, rolling = switches[NORMAL], switches[ROLLING]
    found: list[int] = []
    if normal == THORNTON_NING:
        found += YIELDING
    elif normal >= HOOKE_HYSTERESIS:
        found.append(LARGEST)
        if normal >= EDINBURGH:
            found.append(LATEST)
        if normal >= LUDING:
            found += [ADHESION, PULL]
    if switches[COHESION] >= EASO:
        found.append(BRIDGE)
    if switches[TANGENTIAL] in (HISTORY, TAN_LUDING):
        found += range(SLIDING_ONLY)
    if rolling >= EPSD:
        found += range(SLIDING_ONLY, WITH_ROLLING)
    if rolling == ROLL_LUDING:
        found += [TORSION] * 3
    return found


def yielding(hist: Floats, overlap: Floats, energy: Floats, radius: Floats) -> Floats:
    """Return what LIGGGHTS keeps of contacts with ``thornton_ning``.

    Parameters
    ----------
    hist : (n, 14) float64
        Histories after a step.
    overlap : (n,) float64
        Then, m.
    energy : (n,) float64
        Of the surfaces, J/m2.
    radius : (n,) float64
        Effective radii, m.

    Returns
    -------
    (n, 12) float64
        Whether it has begun; overlap and largest overlap, m; force and largest force, N; whether
        it is held by a neck; overlap, m, of the last parting, whether it is parted, and its force,
        N; whether it has yielded; 0; and the pull-off force, N.
    """
    stage = hist[:, STAGE].astype(np.int64)
    parted, unloaded = stage & PARTED != 0, stage & UNLOADED != 0
    pull, most = 1.5 * np.pi * energy * radius, hist[:, FORCE_MOST]
    inner = most + 2.0 * (pull + np.sqrt(np.maximum(pull * (most + pull), 0.0)))
    with np.errstate(invalid="ignore", divide="ignore"):
        worn = radius * (inner / (most + np.sqrt(np.maximum(4.0 * pull * inner, 0.0))))
    return np.column_stack([
        (stage & BEGUN != 0).astype(np.float64),
        np.where(parted, overlap, hist[:, LATEST]),
        hist[:, LARGEST],
        np.where(parted, 0.0, hist[:, FORCE_BEFORE]),
        most,
        (stage & NECKED != 0).astype(np.float64),
        np.where(parted, hist[:, LATEST], hist[:, PARTED_AT]),
        parted.astype(np.float64),
        np.where(parted, hist[:, FORCE_BEFORE], hist[:, PARTED_FORCE]),
        (stage & YIELDED != 0).astype(np.float64),
        np.zeros(len(hist)),
        np.where(unloaded, -1.5 * np.pi * energy * worn, pull),
    ])  # fmt: skip


def yielding_columns(values: Floats) -> Floats:
    """Return histories, (n, 14), from those of LIGGGHTS, (n, 12 or more), see `yielding`."""
    begun, overlap, largest, force, most, neck, apart_at, apart, apart_force, yielded, *_ = values.T
    hist = np.zeros((len(values), REMEMBERED))
    parted = apart == 1.0
    hist[:, LARGEST] = largest
    hist[:, LATEST] = np.where(parted, apart_at, overlap)
    hist[:, FORCE_BEFORE] = np.where(parted, apart_force, force)
    hist[:, FORCE_MOST] = most
    hist[:, PARTED_AT] = apart_at
    hist[:, PARTED_FORCE] = apart_force
    bits = ((begun, BEGUN), (neck, NECKED), (apart, PARTED), (yielded, YIELDED))
    hist[:, STAGE] = sum(np.where(flag == 1.0, bit, 0) for flag, bit in bits)
    return hist
