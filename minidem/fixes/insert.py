"""Fixes of particle insertion: templates, distributions and the inserters themselves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from minidem.insertion import Distribution, Domain, Inserter, NewParticles, Present, Template
from minidem.run.control import nve_bit
from minidem.world.fix import Fix
from minidem.world.state import Floats, Ints, NewRows

if TYPE_CHECKING:
    from minidem.world.world import World

__all__ = ["DistributionFix", "Insert", "TemplateFix", "domain_of"]


@dataclass
class TemplateFix(Fix):
    """``particletemplate/sphere``."""

    template: Template | None = None


@dataclass
class DistributionFix(Fix):
    """``particledistribution/...``."""

    distribution: Distribution | None = None
    member_bits: tuple[int, ...] = ()


@dataclass
class Insert(Fix):
    """``insert/pack``, ``insert/rate/region``, ``insert/stream``."""

    inserter: Inserter | None = None
    distribution: DistributionFix | None = None

    @property
    def next_step(self) -> int | None:
        """Step of the next event, None if there is none."""
        return None if self.inserter is None else self.inserter.next_step

    def vector(self, index: int) -> float:
        """Return number (1) and mass (2) inserted so far."""
        if self.inserter is None or not 1 <= index <= 2:
            return super().vector(index)
        return float((self.inserter.inserted, self.inserter.inserted_mass)[index - 1])

    def act(self, world: World, step: int) -> None:
        """Insert now."""
        if self.inserter is None:
            return
        state = world.state
        at = state.output_order()
        row = state.row[at]
        if world.fresh[0] != step:
            world.fresh = (step, state.top_id)
        present = Present(
            row[:, :3].copy(), row[:, 3].copy(), row[:, 7].copy(),
            images_of(world, at[state.ids[at] <= world.fresh[1]], self.largest()),
        )  # fmt: skip
        new = self.inserter.insert(step, present, domain_of(world))
        for line in self.inserter.take_messages():
            world.log(line)
        self._add(world, new)

    def largest(self) -> float:
        """Return the largest radius that may be inserted, m."""
        if self.distribution is None or self.distribution.distribution is None:
            return 0.0
        return float(self.distribution.distribution.max_radius)

    def _add(self, world: World, new: NewParticles) -> None:
        """Append the particles with their groups and flights."""
        state = world.state
        count = len(new.radius)
        if count == 0:
            return
        mask = self.bit | 1
        if self.distribution is not None:
            mask |= self.distribution.bit
        flight = None
        if new.flight is not None:
            flight = np.zeros((count, 16))
            flight[:, :3] = new.flight.origin
            flight[:, 3] = new.flight.start
            flight[:, 4] = new.flight.release
            flight[:, 5:8] = new.flight.velocity
            flight[:, 8:11] = new.flight.final_velocity
            flight[:, 11:14] = new.flight.final_omega
        state.add(
            NewRows(
                new.position, new.radius, new.density, new.type, new.velocity, new.omega, mask,
                flight,
            )
        )  # fmt: skip
        at = slice(state.n - count, state.n)
        state.row[at, 7] = new.mass
        if self.distribution is not None and self.distribution.member_bits:
            bits = np.array(self.distribution.member_bits, np.int32)
            state.mask[at] |= bits[new.template]


def images_of(world: World, who: Ints, radius: float) -> Floats:
    """Return the images beyond periodic faces that a new sphere might overlap, shape (M, 4), m.

    LIGGGHTS looks at the images of the step before: they have not followed the last move yet.

    Parameters
    ----------
    world : World
        Box and particles.
    who : ndarray of int
        Particles that were there in the step before.
    radius : float
        Largest radius of a new sphere, m.
    """
    state, box = world.state, world.need_box()
    if not any(box.period()[3:]):
        return np.empty((0, 4))
    row = state.row[who]
    spheres = np.ascontiguousarray(row[:, :4])
    moved = (state.mask[who] & nve_bit(world)) != 0
    spheres[moved, :3] -= world.dt * row[moved, 4:7]
    near = radius + float(row[:, 3].max(initial=0.0))
    period = box.period()
    own = len(spheres)
    for c in range(3):
        length = period[3 + c]
        if length == 0.0:
            continue
        low = spheres[spheres[:, c] < box.lo[c] + near].copy()
        high = spheres[spheres[:, c] > box.hi[c] - near].copy()
        low[:, c] += length
        high[:, c] -= length
        spheres = np.concatenate([spheres, low, high])
    return spheres[own:]


def domain_of(world: World) -> Domain:
    """Return the box as the inserters want it."""
    box = world.need_box()
    x, y, z = (both[0] for both in box.boundary)
    return Domain(np.array([box.lo, box.hi]), boundary=(x, y, z))
