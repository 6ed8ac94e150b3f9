"""Plastic contacts: springs that are stiffer on unloading than on loading, and attract after it.

Walton and Braun as in Luding, Granular Matter 10 (2008) 235 (``luding``, ``hooke/hysteresis``), and
Thakur et al., Granular Matter 16 (2014) 383 (``edinburgh``), in the form that LIGGGHTS 3.8.0 has.
Here k1 is the stiffness of loading, k2 that of unloading, kc that of adhesion, and `largest` the
overlap up to which the contact was loaded.
"""

from __future__ import annotations

from math import pi, sqrt
from typing import Any

from minidem.kernels.columns import (  # isort: skip
    LARGEST, LATEST, ADHESION,
)  # fmt: skip
from minidem.kernels.models import (  # isort: skip
    LUDING, UNLOADING, ADHESIVE, LARGEST_UNLOADING, PLASTICITY_DEPTH, SURFACE_ENERGY,
    ADHESION_EXPONENT, OVERLAP_EXPONENT,
)  # fmt: skip
from minidem.kernels.machine.jit import inlined, inner

__all__ = ["piecewise", "powers"]

MOST = 1000  # tries to bring the largest overlap of edinburgh in line; LIGGGHTS sets no limit


@inner
def piecewise(normal: int, contact: Any, values: Any, k1: float, history: Any, update: int) -> Any:
    """Return the elastic force of ``luding`` and ``hooke/hysteresis``, N, and kc, N/m.

    Parameters
    ----------
    normal : int
        `LUDING` or `HOOKE_HYSTERESIS`.
    contact : Contact
        Geometry.
    values : float64 (columns,)
        Coefficients of the pair of types.
    k1 : float
        Stiffness of loading, N/m.
    history : float64 (10,)
        Of the contact; the largest overlap is kept, of ``luding`` kc too.
    update : int
        1 in a time step, 0 at setup, when adhesion of ``hooke/hysteresis`` leaves it.
    """
    overlap = contact.overlap
    most = k1 * values[UNLOADING if normal == LUDING else LARGEST_UNLOADING]
    kc = k1 * values[ADHESIVE]
    largest = max(history[LARGEST], overlap)
    history[LARGEST] = largest
    if normal == LUDING:
        history[ADHESION] = kc
    full = most / (most - k1) * values[PLASTICITY_DEPTH] * 2.0 * contact.radius
    if largest >= full:
        k2 = most
        force = k2 * (overlap - full) + k1 * full
    else:
        k2 = k1 + (most - k1) * largest / full
        force = k2 * (overlap - largest) + k1 * largest
        if force >= k1 * overlap:
            return k1 * overlap, kc
    if force >= -kc * overlap:
        return force, kc
    if normal == LUDING:
        history[LARGEST] = (k2 + kc) / (k2 - k1) * overlap
    elif update == 1:
        root = overlap * overlap + 4.0 * ((k1 + kc) * overlap * full / (most - k1))
        history[LARGEST] = 0.5 * (overlap + sqrt(root))
    return -kc * overlap, kc


@inner
def powers(contact: Any, sizes: Any, values: Any, k1: float, history: Any, fixed: int) -> Any:
    """Return the elastic force of ``edinburgh``, N, and the kc that acts in it.

    Parameters
    ----------
    contact : Contact
        Geometry.
    sizes : (float, float)
        Radii, m; the second is 0 for a wall.
    values : float64 (columns,)
        Coefficients of the pair of types.
    k1 : float
        Stiffness of loading, N/m^x with the exponent x of the overlap.
    history : float64 (10,)
        Of the contact; all three numbers of plasticity are kept.
    fixed : int
        1 if kc follows from k1, 0 if from the surface energy.
    """
    overlap = contact.overlap
    k2 = k1 * values[UNLOADING]
    exponent = values[OVERLAP_EXPONENT]
    loaded = overlap**exponent
    adhered = overlap ** values[ADHESION_EXPONENT]
    if fixed == 1:
        kc = k1 * values[ADHESIVE]
        history[ADHESION] = kc
        largest = max(history[LARGEST], overlap)
        history[LARGEST] = largest
        last = largest**exponent
        force = k2 * (loaded - last) + k1 * last
        if force >= k1 * loaded:
            return k1 * loaded, 0.0
        if force > -kc * adhered:
            return force, 0.0
        history[LARGEST] = (k2 + kc) / (k2 - k1) * overlap
        return -kc * adhered, 0.0
    plastic = max(history[LARGEST], (1.0 - k1 / k2) ** (1.0 / exponent) * overlap)
    ri, rj = sizes
    apart = ri
    if rj > 0.0:
        apart = ri + rj - plastic
    latest = history[LATEST]
    force = k1 * loaded
    kc = 0.0
    for _ in range(MOST):
        force = k2 * (loaded - plastic**exponent)
        if force >= k1 * loaded:
            force = k1 * loaded
            break
        kc = _adhesion(values, k2, plastic, apart, sizes)
        history[ADHESION] = kc
        if force > -kc * adhered:
            break
        force = -kc * adhered
        if not overlap > latest:
            break
        plastic = (latest**exponent + kc / k2 * latest ** values[ADHESION_EXPONENT]) ** (
            1.0 / exponent
        )
    history[LARGEST] = plastic
    history[LATEST] = overlap
    return force, kc


@inlined
def _adhesion(values: Any, k2: float, plastic: float, apart: float, sizes: Any) -> Any:
    """Return the kc of two spheres that pull with their surface energy where they flattened."""
    ri, rj = sizes
    square = apart * apart
    one = ri * ri  # of a wall exactly `square`, and then the edge is exactly 0
    part = square - rj * rj + one
    edge = sqrt(max(4.0 * square * one - part * part, 0.0)) / (2.0 * apart)
    pull = 1.5 * pi * values[SURFACE_ENERGY] * edge
    last = plastic ** values[OVERLAP_EXPONENT]
    most = 0.5 * k2 * last
    least = 0.5 * plastic
    if pull > most:
        pull = most
    else:
        least = ((k2 * last - pull) / k2) ** (1.0 / values[OVERLAP_EXPONENT])
    return pull / least ** values[ADHESION_EXPONENT]
