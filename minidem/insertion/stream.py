"""``fix insert/stream``: particles that come through a planar face."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from minidem.errors import DemError, InputError
from minidem.insertion.grid import make_grid, search_bins
from minidem.insertion.inserter import Inserter
from minidem.insertion.particles import Flight, NewParticles, Present
from minidem.insertion.seeds import ParkMiller
from minidem.insertion.settings import Domain, Settings
from minidem.insertion.stream_face import FIRST, dot, length
from minidem.kernels.columns import LOWER, MEAN, SEED, UPPER, A
from minidem.kernels.insertion.grid import Bins
from minidem.kernels.insertion.place import Batch, Generators, Rules, draw_velocity_of
from minidem.kernels.insertion.stream import (
    Face,
    Layer,
    count_behind_face,
    place_behind_face,
    project_on_face,
)
from minidem.record import replace

__all__ = ["Stream"]

TINY: Final = 1e-14


class Stream(Inserter):
    """Insertion behind a face, from which particles fly through it.

    Parameters
    ----------
    name, settings
        See `Inserter`.
    face : tuple
        Face and its unit normal, see `minidem.insertion.stream_face.make_face`.
    extrude_length : float
        Depth behind the face in which particles are placed, m; 0 if `insert_every` is given.
    duration : int
        Steps an event fills with `insert_every`, 0 for all.
    tries : int
        Random points with which LIGGGHTS finds the share of a process.
    mesh_random : ParkMiller
        Generator of the mesh, which its streams share.
    """

    style = "insert/stream"

    def __init__(
        self,
        name: str,
        settings: Settings,
        face: tuple[Face, NDArray[np.float64]],
        extrude_length: float,
        duration: int,
        tries: int,
        mesh_random: ParkMiller,
    ) -> None:
        super().__init__(name, settings)
        self._face, self._normal = face
        self._corners = self._face.nodes.reshape(-1, 3)
        self._length = extrude_length
        self._duration = duration
        self._tries = tries
        self._mesh_random = mesh_random
        self._shared = False
        self._dt = 0.0
        self._speed = np.zeros(3)

    @property
    def flight_velocity(self) -> NDArray[np.float64]:
        """Velocity towards the face, (3,) in m/s; zero before the first run."""
        return self._speed

    def prepare(self, dt: float, domain: Domain) -> None:
        """Find the direction of flight, the interval and the rates."""
        del domain
        s = self.settings
        self._dt = dt
        velocity = s.velocity[MEAN]
        if dot(velocity, self._normal) < 0.0:
            self._normal = -1.0 * self._normal
        self._speed = self._normal * dot(velocity, self._normal)
        if length(self._speed) < 1e-3:
            msg = f"{self.style}: the velocity through the face is below 1e-3; set 'vel'"
            raise InputError(msg)
        self._interval(dt)
        self.rates(dt)

    def _interval(self, dt: float) -> None:
        """Compute insert_every from extrude_length or the other way round."""
        s, progress = self.settings, self._progress
        largest = s.distribution.max_radius
        speed = length(self._speed)
        if (s.every < 0) == (self._length == 0.0):
            msg = f"{self.style}: give either 'insert_every' or 'extrude_length'"
            raise InputError(msg)
        if s.every < 0:
            if self._duration:
                msg = f"{self.style}: 'duration' goes with 'insert_every', not 'extrude_length'"
                raise InputError(msg)
            if self._length < 3.0 * largest and (s.all_in or s.check_overlap):
                msg = (
                    f"{self.style}: extrude_length {self._length:g} must be at least "
                    f"{3.0 * largest:g}, three times the largest radius"
                )
                raise InputError(msg)
            progress.every = int((self._length + TINY) / (dt * speed))
            if progress.every == 0:
                msg = f"{self.style}: velocity too high or extrude_length too small for the step"
                raise InputError(msg)
            return
        duration = self._duration or s.every
        if not 0 < duration <= s.every:
            msg = f"{self.style}: insert_every must be positive and not below 'duration'"
            raise InputError(msg)
        self._length = float(duration) * dt * speed
        if self._length < 2.0 * largest:
            msg = f"{self.style}: 'insert_every' or 'vel' is too small for particles of this size"
            raise InputError(msg)

    def number_of_mass(self, mass: float, mean: float) -> int:
        """Return the number of particles of a total mass; a stream rounds off a little up."""
        return int((mass + TINY) / mean)

    def wanted(self, present: Present, domain: Domain) -> int:
        """Return the number of one event at the given rate."""
        del present
        corners = np.concatenate([self._corners, self._corners - self._normal * self._length])
        if np.any(corners < domain.box[LOWER]) or np.any(corners > domain.box[UPPER]):
            self._progress.warn(
                "Fix insert/stream: Extruded insertion face extends outside domain, may not insert "
                "all particles correctly"
            )
        return self.by_rate()

    def divide(self, domain: Domain) -> None:
        """Draw what LIGGGHTS draws to find the share of a process, once per box."""
        if self._shared and not domain.changes:
            return
        self._shared = True
        hits = count_behind_face(
            self._face,
            self._normal,
            self._length,
            domain.box,
            self._mesh_random.state,
            self.random.state,
            self._tries,
        )
        if hits < 0.9 * self._tries:
            msg = f"fix {self.name}: the extruded insertion face is outside the simulation box"
            raise DemError(msg)

    def place(
        self, chosen: NDArray[np.int64], present: Present, domain: Domain
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Place particles behind the face; all fly with the same velocity."""
        s = self.settings
        radii = self.radii(chosen)
        bins = self._bins(domain)
        near = self._near(present, bins)
        depth = self._normal * (self._length + 3.0 * s.distribution.max_radius)
        corners = np.concatenate([self._corners, self._corners - depth])
        bounds = np.array([corners.min(axis=0), corners.max(axis=0)])
        grid = make_grid(present, near, bounds, radii, bins)
        position = np.empty((len(radii), 3))
        count = place_behind_face(
            self._face,
            Rules(s.all_in, s.check_overlap, True, 0, s.turned),
            Layer(self._normal, self._length),
            domain.box,
            Batch(radii, len(radii) * s.attempts, int(near.sum()), position, np.empty((0, 3))),
            Generators(self._mesh_random.state, self.random.state),
            grid,
        )
        return position[:count], np.tile(self._speed, (count, 1))

    def _bins(self, domain: Domain) -> Bins:
        """Return the bins over what lies behind the face, twice as far as it is looked at."""
        largest = self.settings.distribution.max_radius
        low, high = self._corners.min(axis=0), self._corners.max(axis=0)
        way = -(self._length + 6.0 * largest) * self._normal
        place = np.array([np.minimum(low, low + way), np.maximum(high, high + way)])
        return search_bins(place, domain.box, largest, 3.0 * largest + 2.0 * largest)

    def _near(self, present: Present, bins: Bins) -> NDArray[np.bool_]:
        """Select the particles whose projection lies on the face, as LIGGGHTS does, shape (N,)."""
        if not self.settings.check_overlap or not len(present.radius):
            return np.zeros(len(present.radius), dtype=np.bool_)
        largest = self.settings.distribution.max_radius
        position = np.ascontiguousarray(present.position, dtype=np.float64)
        found = np.empty(len(position), dtype=np.bool_)
        below = -(self._length + 3.0 * largest)
        project_on_face(self._face, self._normal, position, largest, below, found)
        low, high = bins.bounds
        found &= np.all((position >= low) & (position <= high), axis=1)
        return found

    def collect(
        self,
        chosen: NDArray[np.int64],
        position: NDArray[np.float64],
        velocity: NDArray[np.float64],
        step: int,
    ) -> NewParticles:
        """Add when each particle reaches the face and how it goes on."""
        s = self.settings
        new = super().collect(chosen, position, velocity, step)
        reference = self._face.nodes[FIRST, A]
        release = np.empty(len(position), dtype=np.int64)
        final = np.empty((len(position), 3))
        pace = length(self._speed) * self._dt
        for i, place in enumerate(position):
            distance = dot(reference - place, self._normal)
            release[i] = step + int((distance + TINY) / pace)
            draw_velocity_of(s.velocity_style, self.random.state, s.velocity, final[i])
        flight = Flight(position.copy(), step, release, self._speed.copy(), final, new.omega)
        return replace(new, omega=np.zeros_like(new.omega), flight=flight)

    def state(self) -> dict[str, float]:
        """Return what a restart needs, the mesh's generator included."""
        return {
            **super().state(),
            "mesh_seed": float(self._mesh_random.state[SEED]),
            "shared": float(self._shared),
        }

    def apply_state(self, state: dict[str, float]) -> None:
        """Set generators and counters, the mesh's generator included."""
        super().apply_state(state)
        self._mesh_random.reset(int(state["mesh_seed"]))
        self._shared = bool(state["shared"])
