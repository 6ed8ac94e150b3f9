"""Liquid on the surface of particles: what goes into bridges, and where it goes when they break.

As in LIGGGHTS 3.8.0 a bridge holds no liquid of its own: while it lasts its volume follows from
what its particles have, and when it breaks they share it out by their volumes.
"""

from __future__ import annotations

from math import pi, sqrt
from typing import Any

from minidem.kernels.columns import (  # isort: skip
    RADIUS, LIQUID_CONTENT, LIQUID_FLUX, LIQUID_SOURCE, SPILT, TYPES, DT,
)  # fmt: skip
from minidem.kernels.machine.jit import inlined, inner
from minidem.kernels.models import BRIDGE_SHARE, EASO, LIQUID_LIMIT

__all__ = ["begin_flux", "drain_bridge", "drops_of", "settle"]

SPHERE = 1333.333333 * pi  # litres of a sphere of radius 1 m, as LIGGGHTS writes it
USUAL_SHARE = 0.05  # of washino


@inner
def drops_of(model: Any, bodies: Any, q: Any, who: Any) -> Any:
    """Return what two particles give to a bridge between them, l.

    Parameters
    ----------
    model : Switches
        See `minidem.kernels.contact.records`.
    bodies : Bodies
        See `minidem.kernels.scene`; contents above the limit are brought down to it.
    q : int
        Row of the pair of types.
    who : (int, int)
        Rows of the particles; the second is -1 for a wall, which is dry.
    """
    i, j = who
    row = bodies.parts.row
    ri = row[i, RADIUS]
    rj = ri
    both = ri
    here = _litres(model, bodies, i)
    there = 0.0
    if j >= 0:
        rj = row[j, RADIUS]
        both = ri + rj
        there = _litres(model, bodies, j)
    if model.cohesion == EASO:
        return _cap(here, rj, both), _cap(there, ri, both)
    share = USUAL_SHARE
    if model.sets_bridges == 1:
        share = bodies.coef[q, BRIDGE_SHARE]
    return share * here, share * there


@inlined
def _cap(litres: float, other: float, both: float) -> Any:
    """Return the liquid on the part of a sphere that faces the other, l."""
    return 0.5 * litres * (1.0 - sqrt(1.0 - other * other / (both * both)))


@inlined
def _litres(model: Any, bodies: Any, i: Any) -> Any:
    """Return the liquid of a particle, l, at most its limit."""
    parts = bodies.parts
    liquid = parts.liquid
    if model.limits_liquid == 1:
        own = parts.kind[i] * (bodies.control.whole[TYPES] + 1)
        if liquid[i, LIQUID_CONTENT] > bodies.coef[own, LIQUID_LIMIT]:
            # threads may write the same at once, and none reads it but through this line
            liquid[i, LIQUID_CONTENT] = bodies.coef[own, LIQUID_LIMIT]
    radius = parts.row[i, RADIUS]
    return SPHERE * radius * radius * radius * liquid[i, LIQUID_CONTENT]


@inner
def drain_bridge(bodies: Any, who: Any, drops: Any, hi: int, overflow: Any) -> None:
    """Share out the liquid of a bridge that breaks in this step.

    Parameters
    ----------
    bodies : Bodies
        See `minidem.kernels.scene`.
    who : (int, int)
        Rows of the particles.
    drops : (float, float)
        What they had given, l.
    hi : int
        Rows from here on are another thread's; what they get goes to `overflow`.
    overflow : float64 (cap, 8)
        See ``Team.spill``.
    """
    i, j = who
    parts = bodies.parts
    ri, rj = parts.row[i, RADIUS], parts.row[j, RADIUS]
    rate = 1.0 / bodies.control.real[DT]
    ratio = rj / ri
    part = 1.0 / (1.0 + ratio * ratio * ratio)
    mine, other = drops
    volume = mine + other
    parts.liquid[i, LIQUID_FLUX] += rate * (part * volume - mine) / (SPHERE * ri * ri * ri)
    flux = rate * ((1.0 - part) * volume - other) / (SPHERE * rj * rj * rj)
    if j >= hi:
        overflow[j, SPILT] += flux
    else:
        parts.liquid[j, LIQUID_FLUX] += flux


@inner
def begin_flux(n: int, parts: Any) -> None:
    """Forget the flux of the step before."""
    for i in range(n):
        parts.liquid[i, LIQUID_FLUX] = 0.0


@inner
def settle(n: int, control: Any, parts: Any) -> None:
    """Add flux and source of a step to the contents."""
    liquid = parts.liquid
    for i in range(n):
        gain = liquid[i, LIQUID_FLUX] + liquid[i, LIQUID_SOURCE]
        liquid[i, LIQUID_CONTENT] += gain * control.real[DT]
