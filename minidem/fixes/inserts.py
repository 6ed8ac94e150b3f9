"""Fixes of particle insertion: templates, distributions and the inserters themselves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from minidem.fixes.base import Fix
from minidem.insertion import Distribution, Domain, Inserter, NewParticles, Present, Template
from minidem.state import NewRows

if TYPE_CHECKING:
    from minidem.world import World

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
        present = Present(row[:, :3].copy(), row[:, 3].copy(), row[:, 7].copy())
        new = self.inserter.insert(step, present, domain_of(world))
        for line in self.inserter.take_messages():
            world.log(line)
        self._add(world, new)

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


def domain_of(world: World) -> Domain:
    """Return the box as the inserters want it."""
    box = world.need_box()
    x, y, z = (both[0] for both in box.boundary)
    return Domain(np.array([box.lo, box.hi]), boundary=(x, y, z))
