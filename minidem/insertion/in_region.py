"""``fix insert/pack`` and ``fix insert/rate/region``."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from minidem.errors import DemError, InputError
from minidem.insertion.grid import MOST_CELLS
from minidem.insertion.inserter import Inserter
from minidem.insertion.particles import Present
from minidem.insertion.region import Region
from minidem.insertion.room import Room
from minidem.insertion.settings import Domain, Settings
from minidem.kernels.columns import DRAWN, LOWER, UPPER
from minidem.kernels.insertion.place import (
    STUCK,
    Batch,
    Generators,
    Rules,
    count_in_region,
    place_in_region,
)
from minidem.kernels.insertion.stock import There, stock

__all__ = ["Pack", "RateRegion"]

SEED_OFFSET: Final = 12


class _InRegion(Inserter):
    """Insertion at random points of a region.

    Parameters
    ----------
    name, settings
        See `Inserter`.
    region : Region
        Where.
    tries : int
        Random points with which the volume of the region is measured.
    check_border : bool
        Whether spheres must lie within the simulation box.
    """

    def __init__(
        self, name: str, settings: Settings, region: Region, tries: int, check_border: bool
    ) -> None:
        super().__init__(name, settings)
        if region.extent is None:
            msg = f"{self.style}: the region has no bounding box; use one with side in"
            raise InputError(msg)
        if region.moves():
            msg = f"{self.style}: the region moves or changes its radius; use one at rest"
            raise InputError(msg)
        if settings.all_in and not region.volume and region.faceless(outer=False):
            msg = (
                f"{self.style}: with 'all_in yes' a mesh/tet, or a wedge with side out, cannot be "
                "a part of a region; use it alone, or 'all_in no'"
            )
            raise InputError(msg)
        self._region = region
        self._extent = region.extent
        self._tries = tries
        self._boxed = region.faceless(outer=True)
        self._volume = 0.0
        self._room = Room(name, region.extent, settings)
        self._rules = Rules(
            settings.all_in, settings.check_overlap, check_border, settings.velocity_style,
            settings.turned,
        )  # fmt: skip
        self._generators = Generators(region.random.state, self.random.state)

    def prepare(self, dt: float, domain: Domain) -> None:
        self._region.random.reset(self.settings.seed + SEED_OFFSET)
        self._measure(domain)
        if self.settings.every < 0:
            msg = f"{self.style}: keyword 'insert_every' is missing"
            raise InputError(msg)
        self.check_keywords(dt)

    def check_keywords(self, dt: float) -> None:
        """Check and use the keywords of the command."""
        raise NotImplementedError

    def divide(self, domain: Domain) -> None:
        if domain.changes:
            self._measure(domain)

    def attempts(self, count: int) -> int:
        """Return how many points may be tried for `count` particles."""
        return count * self.settings.attempts

    def place(
        self, chosen: NDArray[np.int64], present: Present, domain: Domain
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        radii = self.radii(chosen)
        largest = float(radii.max())
        spheres = len(present.radius) + len(radii)
        corners, grid = self._room.within(domain.box, largest, spheres)
        near = stock(
            self._region.table, self._there(present), corners[DRAWN], MOST_CELLS, largest, grid
        )
        position, velocity = np.empty((len(radii), 3)), np.empty((len(radii), 3))
        count, outcome = place_in_region(
            self._region.table,
            self._rules,
            corners,
            Batch(radii, self.attempts(len(radii)), near, position, velocity),
            self.settings.velocity,
            self._generators,
            grid,
        )
        if outcome == STUCK:
            msg = f"fix {self.name}: no admissible point found in the insertion region"
            raise DemError(msg)
        return position[:count], velocity[:count]

    def state(self) -> dict[str, float]:
        """Return what a restart needs, the generator and volume of the region included."""
        seed, saved, gauss = self._region.random.state.tolist()
        region = {"region_seed": seed, "region_saved": saved, "region_gauss": gauss}
        return {**super().state(), **region, "volume": self._volume}

    def apply_state(self, state: dict[str, float]) -> None:
        """Set generators and counters, those of the region included."""
        super().apply_state(state)
        words = ("region_seed", "region_saved", "region_gauss")
        self._region.random.state[:] = [state[word] for word in words]
        self._volume = state["volume"]

    def _there(self, present: Present) -> There:
        """Return the particles, and which of them LIGGGHTS looks at."""
        s = self.settings
        position, radius = present.position, present.radius
        if not s.check_overlap:
            position, radius = position[:0], radius[:0]
        return There(
            np.ascontiguousarray(position, dtype=np.float64),
            np.ascontiguousarray(radius, dtype=np.float64),
            self._extent,
            s.distribution.max_radius,
            not s.all_in,
            self._boxed,  # then more are looked at than need be
        )

    def _measure(self, domain: Domain) -> None:
        """Measure the volume of the region by random points, as LIGGGHTS does."""
        if self._region.volume:
            self._volume = self._region.volume
            return
        hits = count_in_region(
            self._region.table, self._extent, domain.box, self._region.random.state, self._tries
        )
        if hits == 0:
            msg = (
                f"fix {self.name}: no volume found in the insertion region; it is too thin or "
                "outside the simulation box"
            )
            raise InputError(msg)
        x, y, z = (self._extent[UPPER] - self._extent[LOWER]).tolist()
        self._volume = float(hits) / float(self._tries) * (x * y * z)


class RateRegion(_InRegion):
    """Insertion at a constant rate: ``fix insert/rate/region``."""

    style = "insert/rate/region"

    def check_keywords(self, dt: float) -> None:
        """Compute the rates."""
        if self.settings.every == 0:
            msg = f"{self.style}: 'insert_every once' is not possible; give a number of steps"
            raise InputError(msg)
        self.rates(dt)

    def wanted(self, present: Present, domain: Domain) -> int:
        """Return the number of one event at the given rate."""
        del present
        self._room.check(domain)
        return self.by_rate()


class Pack(_InRegion):
    """Filling of a region: ``fix insert/pack``.

    Parameters
    ----------
    name, settings, region, tries, check_border
        See `_InRegion`.
    target : tuple of str and float
        One of ``volumefraction_region``, ``particles_in_region``, ``mass_in_region``, and its
        value.
    warn_region : bool
        Whether a region that extends over a fixed face of the box is an error.
    """

    style = "insert/pack"
    limited = False
    ordered = True

    def __init__(
        self,
        name: str,
        settings: Settings,
        region: Region,
        tries: int,
        check_border: bool,
        *,
        target: tuple[str, float],
        warn_region: bool,
    ) -> None:
        super().__init__(name, settings, region, tries, check_border)
        self._target = target
        self._warn_region = warn_region
        self._filled = 0.0

    def check_keywords(self, dt: float) -> None:
        """Refuse keywords of the other commands."""
        del dt
        s = self.settings
        if s.number or s.mass or s.particle_rate or s.mass_rate:
            msg = f"{self.style}: takes no 'nparticles', 'mass', 'particlerate' or 'massrate'"
            raise InputError(msg)

    def wanted(self, present: Present, domain: Domain) -> int:
        """Return the number that is missing in the region."""
        if self._warn_region:
            self._room.check(domain)
        inside = self._region.match(present.position)
        radius = present.radius[inside]
        keyword, target = self._target
        distribution = self.settings.distribution
        if keyword == "particles_in_region":
            there = float(inside.sum())
            missing = int(target) - int(there)
            target = float(int(target))
        elif keyword == "volumefraction_region":
            target *= self._volume
            there = _sum(4.0 * np.pi / 3.0 * radius * radius * radius)
            missing = int((target - there) / distribution.mean_volume + self.random.uniform())
        else:
            if present.mass is None:
                msg = "insert/pack with mass_in_region needs the masses of the particles"
                raise TypeError(msg)
            there = _sum(present.mass[inside])
            missing = int((target - there) / distribution.mean_mass + self.random.uniform())
        self._filled = min(max(there / target, 0.0), 1.0)
        if missing > 2_000_000_000:
            msg = f"fix {self.name}: more than 2e9 particles to insert in one step"
            raise DemError(msg)
        return max(missing, 0)

    def attempts(self, count: int) -> int:
        """Try the longer the fuller the region is."""
        tries = count * self.settings.attempts
        return tries if self._filled >= 1.0 else int(float(tries) / (1.0 - self._filled))


def _sum(values: NDArray[np.float64]) -> float:
    """Add in order, so that the result has the same bits as a loop over the particles."""
    total = 0.0
    for value in values.tolist():
        total += value
    return total
