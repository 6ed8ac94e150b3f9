"""Particles that are there and particles that are added."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from minidem.kernels.columns import POSITION, RADIUS
from minidem.record import record

__all__ = ["Flight", "NewParticles", "Present"]


@record(frozen=True)
class Present:
    """The particles that are there, in the order of output where a command needs that.

    Attributes
    ----------
    position : (N, 3) ndarray
        m.
    radius : (N,) ndarray
        m.
    mass : (N,) ndarray or None
        kg; needed by ``mass_in_region`` only.
    images : (M, 4) ndarray or None
        Centres and radii of the images of particles beyond periodic faces, m. New particles must
        not overlap them, but they do not count.
    """

    position: NDArray[np.float64]
    radius: NDArray[np.float64]
    mass: NDArray[np.float64] | None = None
    images: NDArray[np.float64] | None = None

    def with_images(self) -> Present:
        """Return particles and images alike."""
        if self.images is None or not len(self.images):
            return self
        return Present(
            np.concatenate([self.position, self.images[:, POSITION]]),
            np.concatenate([self.radius, self.images[:, RADIUS]]),
        )


@record(frozen=True)
class Flight:
    """How particles of a stream move until they reach the insertion face.

    Attributes
    ----------
    origin : (n, 3) ndarray
        Place of insertion, m.
    start : int
        Step of insertion.
    release : (n,) ndarray of int
        Step at which they are set free.
    velocity : (3,) ndarray
        Velocity until then, m/s.
    final_velocity, final_omega : (n, 3) ndarray
        Velocity and spin from then on, m/s and rad/s.
    """

    origin: NDArray[np.float64]
    start: int
    release: NDArray[np.int64]
    velocity: NDArray[np.float64]
    final_velocity: NDArray[np.float64]
    final_omega: NDArray[np.float64]


@record(frozen=True)
class NewParticles:
    """Particles to add, in LIGGGHTS' order of insertion.

    Attributes
    ----------
    position, velocity, omega : (n, 3) ndarray
        m, m/s, rad/s.
    radius, density, mass : (n,) ndarray
        m, kg/m3, kg.
    type : (n,) ndarray of int
        Material types, from 1.
    template : (n,) ndarray of int
        Index into the templates of the distribution (their groups).
    flight : Flight or None
        For streams.
    """

    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    omega: NDArray[np.float64]
    radius: NDArray[np.float64]
    density: NDArray[np.float64]
    mass: NDArray[np.float64]
    type: NDArray[np.int64]
    template: NDArray[np.int64]
    flight: Flight | None = None
