"""The keywords of ``thermo_style custom``, which formulas know as well."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial
from typing import Final

import numpy as np

from minidem.kernels.columns import MASS, OMEGA, RADIUS, TOTAL_FORCE
from minidem.registry import Registry
from minidem.world.world import World

__all__ = ["OF_RUN", "SUMS", "THERMO"]

THERMO: Registry[Callable[[World], float]] = Registry("thermo keyword")
"""Thermo keyword to a function of the world; titles and formats: `minidem.output.text.thermo`."""

SUMS: Final = frozenset(["ke", "erotate"])
"""Keywords that ``thermo_modify norm yes`` divides by the number of particles."""

OF_RUN: Final = frozenset(["elapsed", "elaplong", "cpu", "cu", "tpcpu", "spcpu", "cpuremain"])
"""Keywords that have a value only during a run."""

_UPRIGHT = 90.0  # angle between edges of the box, degrees


def _clock(world: World) -> float:
    """Return the wall time since the start of the run, s; 0 before its first step."""
    if world.begin_step is None or world.step == world.begin_step:
        return 0.0
    return time.perf_counter() - world.run_start


def _pace(keyword: str, amount: Callable[[World], float], world: World) -> float:
    """Return how much of something was done per second of wall time since this was last asked."""
    now, clock = amount(world), _clock(world)
    before, then = world.thermo.marks.get(keyword, (0.0, 0.0))
    world.thermo.marks[keyword] = now, clock
    if clock == 0.0 or clock <= then:
        return 0.0
    return max(0.0, (now - before) / (clock - then))


def _time_left(world: World) -> float:
    """Return the wall time that the run still takes at its mean pace, s."""
    begin, end = world.begin_step, world.end_step
    if begin is None or end is None or world.step == begin:
        return 0.0
    return _clock(world) * (end - world.step) / (world.step - begin)


def _elapsed(world: World) -> float:
    return world.step - (world.begin_step or 0)


def _long_elapsed(world: World) -> float:
    """Return the steps since ``start`` of the command ``run``."""
    begin = world.begin_step if world.series is None else world.series[0]
    return world.step - (begin or 0)


def _spinning(world: World) -> float:
    """Return the rotational kinetic energy, J."""
    row, spin = world.state.row[: world.state.n], world.state.spin[: world.state.n]
    inertia = 0.4 * row[:, MASS] * row[:, RADIUS] ** 2
    return float(0.5 * (inertia * (spin[:, OMEGA] ** 2).sum(axis=1)).sum())


def _density(world: World) -> float:
    """Return the mass of all particles per volume of the box, kg/m3."""
    mass = float(world.state.row[: world.state.n, MASS].sum())
    return mass / world.need_box().volume


def _largest_force(world: World) -> float:
    """Return the largest component of a force, N."""
    force = world.state.force[: world.state.n, TOTAL_FORCE]
    return float(np.abs(force).max(initial=0.0))


def _norm_of_forces(world: World) -> float:
    """Return the root of the sum of all squared forces, N."""
    return float(np.sqrt((world.state.force[: world.state.n, TOTAL_FORCE] ** 2).sum()))


THERMO.register("step")(lambda world: world.step)
THERMO.register("elapsed")(_elapsed)
THERMO.register("elaplong")(_long_elapsed)
THERMO.register("dt")(lambda world: world.dt)
THERMO.register("time")(World.time)
THERMO.register("cpu")(_clock)
THERMO.register("cpuremain")(_time_left)
THERMO.register("tpcpu")(partial(_pace, "tpcpu", World.time))
THERMO.register("spcpu")(partial(_pace, "spcpu", lambda world: world.step))
THERMO.register("cu")(lambda world: world.state.n * _pace("cu", lambda world: world.step, world))
THERMO.register("part")(lambda world: 0.0)
THERMO.register("atoms")(lambda world: world.state.n)
THERMO.register("ke")(World.kinetic_energy)
THERMO.register("erotate")(_spinning)
THERMO.register("vol")(lambda world: world.need_box().volume)
THERMO.register("density")(_density)
THERMO.register("fmax")(_largest_force)
THERMO.register("fnorm")(_norm_of_forces)
THERMO.register("xy", "xz", "yz")(lambda world: 0.0)
THERMO.register("cellalpha", "cellbeta", "cellgamma")(lambda world: _UPRIGHT)


def _face(c: int, which: int, world: World) -> float:
    """Return lower face (0), upper face (1) or length (2) of the box along c, m."""
    box = world.need_box()
    return float((box.lo[c], box.hi[c], box.hi[c] - box.lo[c])[which])


def _spacing(c: int, world: World) -> float:
    """Return the spacing of the lattice along c, m."""
    return float(world.lattice.spacing[c])


for _c, _axis in enumerate("xyz"):
    THERMO.register(f"{_axis}lo")(partial(_face, _c, 0))
    THERMO.register(f"{_axis}hi")(partial(_face, _c, 1))
    THERMO.register(f"l{_axis}", f"cell{'abc'[_c]}")(partial(_face, _c, 2))
    THERMO.register(f"{_axis}lat")(partial(_spacing, _c))
