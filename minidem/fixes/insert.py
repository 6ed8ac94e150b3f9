"""``fix ID GROUP insert/pack``, ``insert/rate/region`` and ``insert/stream``: new particles.

Where and how many is the business of `minidem.insertion`; here its particles join the simulation.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from minidem.errors import InputError, UnknownNameError
from minidem.fixes.integrate import nve_bit
from minidem.fixes.templates import DistributionFix
from minidem.insertion import STYLES
from minidem.insertion.factory import Surroundings, make_inserter
from minidem.insertion.inserter import Inserter
from minidem.insertion.particles import NewParticles, Present
from minidem.insertion.settings import Domain
from minidem.kernels.columns import (
    EDGE_BIT,
    FLIGHT,
    FLIGHT_FINAL,
    FLIGHT_FROM,
    FLIGHT_SPIN,
    FLIGHT_START,
    FLIGHT_STOP,
    FLIGHT_VELOCITY,
    MASS,
    POSITION,
    RADIUS,
    VELOCITY,
    three,
)
from minidem.record import record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.event import NEVER
from minidem.world.fix import FIXES, Fix, all_fixes
from minidem.world.state import Bools, Floats, Ints, NewRows
from minidem.world.values.flights import flight_values
from minidem.world.world import World

__all__ = ["Insert"]

_NO_IMAGES = np.empty((0, RADIUS + 1))


@FIXES.register(*STYLES)
@record
class Insert(Fix):
    """An insertion.

    Attributes
    ----------
    inserter : Inserter
        When, how many, which and where.
    distribution : DistributionFix
        The fix that gives its particles.
    """

    inserter: Inserter
    distribution: DistributionFix

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Insert:
        """Read the keywords of an insertion style."""
        found = world.of_kind(DistributionFix)
        around = Surroundings(
            {fix.name: fix.distribution for fix in found}, world.regions,
            lambda mesh: _face(world, mesh), world.step, world.dt, lambda mesh: _rim(world, mesh),
            lambda mesh: world.fixes[mesh].random,
        )  # fmt: skip
        inserter = make_inserter(head.name, head.style, words.rest(), around)
        drawn = inserter.settings.distribution
        return cls(*head, inserter, next(fix for fix in found if fix.distribution is drawn))

    def value(self, world: World, index: int) -> float:
        """Return number (1) and mass (2) inserted so far."""
        if not 1 <= index <= 2:
            return super().value(world, index)
        return float((self.inserter.inserted, self.inserter.inserted_mass)[index - 1])

    def per_atom(self, world: World, name: str) -> Floats | None:
        """Return what is known of the flights of all streams."""
        return flight_values(world, name) if self._is_stream() else None

    def remove(self, world: World) -> None:
        """Let particles of a stream go free that have not reached the face, if it is the last."""
        streams = [fix for fix in world.of_kind(Insert) if fix._is_stream()]
        if streams == [self]:
            flight = world.state.flight[: world.state.n]
            flight[:], flight[:, FLIGHT_STOP] = 0.0, -1.0

    def setup(self, world: World) -> None:
        """Work out rates and say what will be inserted."""
        given = self.inserter.settings.given
        if given is not None:
            _assign(world, given[0], np.zeros(0, np.int64), given[1])
        self.inserter.setup(world.dt, _domain(world))
        self._tell(world)

    def next_insertion(self) -> int:
        """Return the step of the next event."""
        step = self.inserter.next_step
        return NEVER if step is None else step

    def largest_inserted(self) -> float:
        """Return the largest radius of the distribution, m."""
        return float(self.distribution.distribution.max_radius)

    def compresses_ids(self) -> bool:
        """Return what ``compress_tags`` says."""
        return self.inserter.settings.compressed

    def insert(self, world: World) -> None:
        """Insert now."""
        state = world.state
        row = state.row[state.output_order() if self.inserter.ordered else slice(state.n)]
        if world.fresh[0] != world.step:
            world.fresh = (world.step, state.top_id)
        radius = float(self.distribution.distribution.max_radius)
        images = _images(world, radius)
        present = Present(row[:, POSITION], row[:, RADIUS], row[:, MASS], images)
        new = self.inserter.insert(world.step, present, _domain(world))
        self._tell(world)
        self._add(world, new)

    def state(self) -> dict[str, Any]:
        """Return generators and counters."""
        return dict(self.inserter.state())

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Take generators and counters."""
        self.inserter.restore(dict(saved))

    def steps_shifted(self, world: World, shift: int) -> None:
        """Follow a ``reset_timestep``.

        As in LIGGGHTS a stream that has not been set up since a restart has no velocity yet, so
        that its particles stand still.
        """
        self.inserter.shift_steps(shift)
        if self._is_stream():
            flying = world.state.flying()
            flight = world.state.flight[: world.state.n]
            flight[flying, three(FLIGHT_VELOCITY)] = self.inserter.flight_velocity

    def _is_stream(self) -> bool:
        """Tell whether its particles fly through a face before they are free."""
        return self.inserter.flight_velocity is not None

    def _tell(self, world: World) -> None:
        lines = self.inserter.take_messages()
        if lines:
            world.log("\n".join(lines))  # at once: each call writes to log and screen

    def _add(self, world: World, new: NewParticles) -> None:
        """Append the particles with their groups and flights."""
        state = world.state
        count = len(new.radius)
        if count == 0:
            return
        mask = self.bit | 1 | self.distribution.bit
        state.add(
            NewRows(
                new.position, new.radius, new.density, new.mass, new.type, new.velocity,
                new.omega, mask, _flights(new),
            )
        )  # fmt: skip
        at = slice(state.n - count, state.n)
        state.mask[at] |= np.array(self.distribution.member_bits, np.int32)[new.template]
        given = self.inserter.settings.given
        if given is not None:
            who = np.arange(at.start, at.stop)
            _assign(world, given[0], who, given[1])
        if new.flight is not None:
            following = world.step + self.inserter.every
            for fix in all_fixes(world):
                fix.particles_inserted(world, self.name, at, new.flight.release, following)


def _assign(world: World, name: str, who: Ints, value: float) -> None:
    """Give particles the value of a ``property/atom``."""
    words = Words([f"{value:.17g}"], "set_property")
    if not any(fix.assign(world, name, who, words) for fix in all_fixes(world)):
        msg = f"set_property: no fix property/atom has '{name[:40]}'"
        raise InputError(msg)


def _flights(new: NewParticles) -> Floats | None:
    """Return rows of ``Particles.flight``, None if the particles are free at once."""
    if new.flight is None:
        return None
    flight = np.zeros((len(new.radius), FLIGHT))
    flight[:, three(FLIGHT_FROM)] = new.flight.origin
    flight[:, FLIGHT_START] = new.flight.start
    flight[:, FLIGHT_STOP] = new.flight.release
    flight[:, three(FLIGHT_VELOCITY)] = new.flight.velocity
    flight[:, three(FLIGHT_FINAL)] = new.flight.final_velocity
    flight[:, three(FLIGHT_SPIN)] = new.flight.final_omega
    return flight


def _face(world: World, mesh: str) -> Floats:
    """Return the triangles of a mesh, shape (n, 3, 3), m; UnknownNameError for an unknown one."""
    lo, hi = world.meshes.span(mesh) if mesh in world.meshes.names else (0, 0)
    if lo == hi:
        raise UnknownNameError(mesh)
    nodes: Floats = world.meshes.table.node[lo:hi].copy()
    return nodes


def _rim(world: World, mesh: str) -> Bools | None:
    """Return which edges of a planar mesh are not shared, shape (n, 3); None for other meshes."""
    if world.fixes[mesh].style != "mesh/surface/planar":
        return None
    lo, hi = world.meshes.span(mesh)
    flags = world.meshes.table.flags[lo:hi, None]
    edges: Bools = (flags & (1 << EDGE_BIT + np.arange(3))) != 0
    return edges


def _images(world: World, radius: float) -> Floats:
    """Return the images beyond periodic faces that a new sphere might overlap, shape (M, 4), m.

    LIGGGHTS looks at the images of the step before: they have not followed the last move yet, and
    particles that came in this step have none.

    Parameters
    ----------
    world : World
        Box and particles.
    radius : float
        Largest radius of a new sphere, m.
    """
    state, box = world.state, world.need_box()
    if not any(face[0] == "p" for face in box.boundary):
        return _NO_IMAGES
    period = box.period()
    who = state.ids[: state.n] <= world.fresh[1]
    row = state.row[: state.n][who]
    spheres = np.column_stack((row[:, POSITION], row[:, RADIUS]))
    moved = (state.mask[: state.n][who] & nve_bit(world)) != 0
    spheres[moved, POSITION] -= world.dt * row[moved, VELOCITY]
    near = radius + float(row[:, RADIUS].max(initial=0.0))
    own = len(spheres)
    for c, length in enumerate(period):
        if length == 0.0:
            continue
        low = spheres[spheres[:, c] < box.lo[c] + near].copy()
        high = spheres[spheres[:, c] > box.hi[c] - near].copy()
        low[:, c] += length
        high[:, c] -= length
        spheres = np.concatenate([spheres, low, high])
    return spheres[own:]


def _domain(world: World) -> Domain:
    """Return the box as the inserters want it."""
    box = world.need_box()
    x, y, z = ("".join(both) for both in box.boundary)
    return Domain(np.array([box.lo, box.hi]), boundary=(x, y, z))
