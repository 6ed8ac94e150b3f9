"""Critical time steps: Rayleigh and Hertz, as ``fix check/timestep/gran`` reports them."""

from __future__ import annotations

import numpy as np

from minidem.contact.model import coefficient_table
from minidem.fixes.wall import MoveMesh
from minidem.kernels.contact.law import SWITCHES
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["critical_fractions"]


def critical_fractions(world: World) -> Floats:
    """Return dt/dt_Rayleigh, dt/dt_Hertz and vmax dt/skin.

    The Rayleigh time is ``pi r sqrt(rho/G) / (0.1631 nu + 0.8766)``, the smallest of all
    particles; the Hertz time ``2.87 (m^2/(r/2 Y*^2 vmax))^0.2`` with the full particle mass.
    """
    state = world.state
    n = state.n
    if n == 0:
        return np.zeros(3)
    row = state.row[:n]
    kind = state.kind[:n]
    young = world.materials.per_type("youngsModulus", world.types, "check/timestep/gran")
    nu = world.materials.per_type("poissonsRatio", world.types, "check/timestep/gran")
    shear = young / (2.0 * (1.0 + nu))
    wave = np.pi * row[:, 3] * np.sqrt(state.density[:n] / shear[kind])
    rayleigh = float(np.min(wave / (0.1631 * nu[kind] + 0.8766)))
    speed = np.sqrt((row[:, 4:7] ** 2).sum(axis=1))
    vmax = max(2.0 * float(speed.max()), float(speed.max()) + _mesh_speed(world))
    coef = coefficient_table(world.materials, world.types, [[0] * len(SWITCHES)])
    effective = coef[kind * world.types + kind, 0]
    out = np.zeros(3)
    out[0] = world.dt / rayleigh
    if vmax > 0.0:
        time = 2.87 * (row[:, 7] ** 2 / (0.5 * row[:, 3] * effective**2 * vmax)) ** 0.2
        out[1] = world.dt / float(time.min())
    out[2] = vmax * world.dt / world.neighbor.skin
    return out


def _mesh_speed(world: World) -> float:
    """Return the largest node velocity of the meshes that move, m/s.

    LIGGGHTS leaves out meshes whose surface alone moves, such as conveyor belts.
    """
    speeds = [0.0]
    for name in dict.fromkeys(move.mesh for move in world.of_kind(MoveMesh)):
        lo, hi = world.meshes.span(name)
        speeds.append(
            float(np.sqrt((world.meshes.table.vel[lo:hi] ** 2).sum(axis=2)).max(initial=0))
        )
    return max(speeds)
