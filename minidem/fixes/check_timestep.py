"""``fix ID all check/timestep/gran NEVERY FRACTION_R FRACTION_H``: fractions of critical steps.

A fraction that is exceeded gives a warning, or ends the run with ``error yes``; ``warn no`` is
silent. The numbers are ``f_ID[1]`` to ``f_ID[3]``.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np

from minidem.errors import SimulationError
from minidem.fixes.motions import moving_meshes
from minidem.kernels.columns import MASS, RADIUS, VELOCITY
from minidem.record import field, record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.event import next_multiple
from minidem.world.fix import FIXES, Fix
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["CheckTimestep", "critical_fractions"]


@FIXES.register("check/timestep/gran")
@record
class CheckTimestep(Fix):
    """Compares the time step with Rayleigh and Hertz times.

    Attributes
    ----------
    every : int
        Interval in steps.
    limits : tuple of float
        Largest fractions of Rayleigh and Hertz time.
    warns, stops : bool
        ``warn yes`` and ``error yes``: what happens beyond the limits.
    speed : float
        ``vmax``: particles are taken to be no slower, m/s.
    fractions : ndarray, shape (3,)
        See `critical_fractions`.
    """

    every: int = 1
    limits: tuple[float, float] = (1.0, 1.0)
    warns: bool = True
    stops: bool = False
    speed: float = 0.0
    fractions: Floats = field(default_factory=lambda: np.zeros(3))

    extensive: ClassVar[tuple[bool, bool]] = (False, True)  # so has LIGGGHTS

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> CheckTimestep:
        """Read the interval, the limits and what happens beyond them."""
        del world
        words.need(3, "fix ID all check/timestep/gran NEVERY FRACTION_R FRACTION_H")
        if words.peek() == "check_every_time":
            words.expect("check_every_time")
        made = cls(*head, words.interval())
        rayleigh, hertz = words.numbers(2)
        made.limits = rayleigh, hertz
        while not words.done():
            key = words.choice(("warn", "error", "vmax"))
            if key == "warn":
                made.warns = words.yes_no()
            elif key == "error":
                made.stops = words.yes_no()
            else:
                made.speed = abs(words.number())
        return made

    def value(self, world: World, index: int) -> float:
        """Return dt/dt_Rayleigh, dt/dt_Hertz or vmax dt/skin."""
        if not 1 <= index <= len(self.fractions):
            return super().value(world, index)
        return float(self.fractions[index - 1])

    def next_step(self, step: int) -> int:
        """Return the next multiple of the interval."""
        return next_multiple(step, self.every)

    def act(self, world: World) -> None:
        """Compare now; warn or stop as LIGGGHTS does."""
        self.fractions = critical_fractions(world, self.speed)
        if not (self.warns or self.stops):
            return
        for name, limit, fraction in zip(
            ("rayleigh", "hertz"), self.limits, self.fractions[:2], strict=True
        ):
            if fraction > limit:
                self._tell(world, f"time-step is {100.0 * fraction:f} % of {name} time")
        travel = float(self.fractions[2]) * world.neighbor.skin
        if self.fractions[2] > 1.0:
            self._tell(
                world,
                "time step too large or skin too small - particles may relatively travel a "
                f"distance of {travel:f} per time-step, but skin is {world.neighbor.skin:f}",
            )
        if travel > world.state.row[: world.state.n, RADIUS].min(initial=np.inf):
            self._tell(
                world,
                "time step way too large - particles relativley move further than the minimum "
                "radius in one step",
            )

    def _tell(self, world: World, text: str) -> None:
        """Warn or stop."""
        if self.stops:
            raise SimulationError(world.step, None, f"fix {self.name}: {text}")
        world.warn(text)

    def state(self) -> dict[str, Any]:
        """Return the latest fractions."""
        return {"fractions": self.fractions.tolist()}

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Take the latest fractions."""
        self.fractions = np.array(saved["fractions"], dtype=np.float64)


def critical_fractions(world: World, least_speed: float = 0.0) -> Floats:
    """Return dt/dt_Rayleigh, dt/dt_Hertz and vmax dt/skin.

    The largest speed of particles is taken to be `least_speed`, m/s, where it is smaller.

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
    wave = np.pi * row[:, RADIUS] * np.sqrt(state.density[:n] / shear[kind])
    rayleigh = float(np.min(wave / (0.1631 * nu[kind] + 0.8766)))
    speed = np.sqrt((row[:, VELOCITY] ** 2).sum(axis=1))
    fastest = max(float(speed.max()), least_speed)
    vmax = max(2.0 * fastest, fastest + _mesh_speed(world))
    soft = (1.0 - nu**2) / young
    effective = (1.0 / (soft + soft))[kind]
    hertz = 0.0
    if vmax > 0.0:
        time = 2.87 * (row[:, MASS] ** 2 / (0.5 * row[:, RADIUS] * effective**2 * vmax)) ** 0.2
        hertz = world.dt / float(time.min())
    return np.array([world.dt / rayleigh, hertz, vmax * world.dt / world.neighbor.skin])


def _mesh_speed(world: World) -> float:
    """Return the largest node velocity of the meshes that move, m/s.

    LIGGGHTS leaves out meshes whose surface alone moves, such as conveyor belts.
    """
    speeds = [0.0]
    for name in moving_meshes(world):
        lo, hi = world.meshes.span(name)
        speeds.append(
            float(np.sqrt((world.meshes.table.vel[lo:hi] ** 2).sum(axis=2)).max(initial=0))
        )
    return max(speeds)
