"""Forces of liquid bridges: ``cohesion easo/capillary/viscous`` and ``washino/capillary/viscous``.

Capillary force after Soulie et al., Int. J. Numer. Anal. Meth. Geomech. 30 (2006) 213, or
Rabinovich et al., Langmuir 21 (2005) 10992; viscous force after Nase et al., Powder Technology 116
(2001) 214; rupture after Lian et al., J. Colloid Interface Sci. 161 (1993) 138; in the form that
LIGGGHTS-PUBLIC 3.8.0 has. Volumes are in litres, as there, so that its thresholds hold.
"""

from __future__ import annotations

from math import cos, exp, log, pi, sin, sqrt
from typing import Any

from minidem.kernels.contact.records import Reaction
from minidem.kernels.machine.jit import inlined, inner
from minidem.kernels.models import (
    BRIDGE_VISCOSITY,
    CONTACT_ANGLE,
    EASO,
    LARGEST_GAP,
    LEAST_GAP,
    SURFACE_TENSION,
)

__all__ = ["lasts", "soaked", "stretched"]

LEAST_VOLUME = 1e-14  # below it a bridge has no force, l
LITRE_EDGE = 0.1  # of a cube, m
EIGHT_FIFTEENTHS = 0.5333333  # as LIGGGHTS writes it
OF_SHEAR = 0.9588
ONE_THIRD = 1.0 / 3.0


@inlined
def lasts(values: Any, gap: float, both: float, volume: float) -> Any:
    """Return True if a bridge of a volume, l, spans a gap, m, between radii whose sum is `both`."""
    angle = values[CONTACT_ANGLE]
    rupture = (1.0 + 0.5 * angle) * volume**ONE_THIRD * LITRE_EDGE
    return gap < rupture and gap < values[LARGEST_GAP] * both


@inner
def soaked(cohesion: int, values: Any, sizes: Any, overlap: float, speed: float, drops: Any) -> Any:
    """Return the force of a bridge between surfaces that touch, N, and the drag along them, kg/s.

    Parameters
    ----------
    cohesion : int
        `EASO` or `WASHINO`.
    values : float64 (columns,)
        Coefficients of the pair of types.
    sizes : (float, float)
        Radii, m; the second is 0 for a wall.
    overlap, speed : float
        m; normal relative velocity, below zero while the two approach, m/s.
    drops : (float, float)
        What both give to the bridge, l.

    Notes
    -----
    As in LIGGGHTS a wall that is touched has no radius, and feels nothing therefore.
    """
    ri, rj = sizes
    mine, other = drops
    volume = mine + other
    if rj == 0.0 or volume < LEAST_VOLUME:
        return 0.0, 0.0
    reff = ri * rj / (ri + rj)
    angle = values[CONTACT_ANGLE]
    if cohesion == EASO:
        pull = _soulie(ri, rj, volume, angle, 0.0)
    else:
        depth = 1.0 + overlap * sqrt(1000.0 * pi * reff / (2.0 * volume))
        pull = -2.0 * pi * reff * cos(angle) * depth
    least = values[LEAST_GAP]
    stokes = -6.0 * pi * values[BRIDGE_VISCOSITY] * reff
    drag = (EIGHT_FIFTEENTHS * log(1.0 / least) + OF_SHEAR) * stokes
    return values[SURFACE_TENSION] * pull + stokes * speed / least, drag


@inner
def stretched(cohesion: int, values: Any, sizes: Any, contact: Any, drops: Any) -> Any:
    """Return the `Reaction` of a bridge across a gap.

    Parameters
    ----------
    cohesion, values, drops
        As for `soaked`.
    sizes : (float, float)
        Radii, m; that of the particle twice for a wall.
    contact : Contact
        Geometry and motion; the overlap is below zero.
    """
    ri, rj = sizes
    gap = -contact.overlap
    mine, other = drops
    volume = mine + other
    if volume < LEAST_VOLUME:
        return Reaction(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    reff = ri * rj / (ri + rj)
    angle = values[CONTACT_ANGLE]
    if cohesion == EASO:
        pull = _soulie(ri, rj, volume, angle, gap)
    else:
        pull = _rabinovich(reff, volume, angle, gap)
    nx, ny, nz = contact.nx, contact.ny, contact.nz
    dx, dy, dz = contact.dx, contact.dy, contact.dz
    wx, wy, wz = contact.wx, contact.wy, contact.wz
    speed = contact.vx * nx + contact.vy * ny + contact.vz * nz
    span = max(values[LEAST_GAP], gap / reff)
    stokes = -6.0 * pi * values[BRIDGE_VISCOSITY] * reff
    drag = (EIGHT_FIFTEENTHS * log(1.0 / span) + OF_SHEAR) * stokes
    force = values[SURFACE_TENSION] * pull + stokes * speed / span
    fx = drag * (contact.vx - speed * nx - (wy * dz - wz * dy))
    fy = drag * (contact.vy - speed * ny - (wz * dx - wx * dz))
    fz = drag * (contact.vz - speed * nz - (wx * dy - wy * dx))
    return Reaction(
        force * nx + fx, force * ny + fy, force * nz + fz,
        ny * fz - nz * fy, nz * fx - nx * fz, nx * fy - ny * fx, 0.0, 0.0, 0.0,
    )  # fmt: skip


@inlined
def _soulie(ri: float, rj: float, volume: float, angle: float, gap: float) -> Any:
    """Return the capillary force over the surface tension after Soulie, m."""
    larger = max(ri, rj)
    scaled = volume * 0.001 / (larger * larger * larger)
    size = log(scaled)
    a = -1.1 * scaled**-0.53
    b = (-0.148 * size - 0.96) * angle * angle - 0.0082 * size + 0.48
    c = 0.0018 * size + 0.078
    return -pi * sqrt(ri * rj) * (exp(a * gap / larger + b) + c)


@inlined
def _rabinovich(reff: float, volume: float, angle: float, gap: float) -> Any:
    """Return the capillary force over the surface tension after Rabinovich, m."""
    part = -1.0 + sqrt(1.0 + 2.0 * volume / (pi * reff * 1000.0 * gap * gap))
    depth = 0.5 * gap * part
    alpha = sqrt(gap / reff * part)
    return (
        -2.0 * pi * reff
        * (cos(angle) / (1.0 + gap / (2.0 * depth)) + sin(alpha) * sin(alpha + angle))
    )  # fmt: skip
