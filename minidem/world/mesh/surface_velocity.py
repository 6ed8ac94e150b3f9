"""``surface_vel`` and ``surface_ang_vel``: meshes that rub and stay in place."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from minidem.errors import InputError
from minidem.record import record
from minidem.words import Words, number
from minidem.world.state import Floats

__all__ = ["SurfaceVelocity"]


@record(frozen=True)
class SurfaceVelocity:
    """How fast the surface of a mesh runs.

    Attributes
    ----------
    values : tuple of float or str
        Velocity of a belt (3), m/s, or angular velocity about an axis (1), rad/s; a string is the
        name of a variable that gives it.
    origin, axis : ndarray or None, shape (3,)
        Point of the axis, m, and its unit vector; None for a belt.
    """

    values: tuple[float | str, ...]
    origin: Floats | None = None
    axis: Floats | None = None

    @classmethod
    def belt(cls, words: Words) -> SurfaceVelocity:
        """Read ``VX VY VZ``."""
        words.need(3, "surface_vel VX VY VZ")
        return cls(tuple(_speed(words) for _ in range(3)))

    @classmethod
    def turning(cls, words: Words) -> SurfaceVelocity:
        """Read ``origin X Y Z axis AX AY AZ omega W``."""
        words.need(10, "surface_ang_vel origin X Y Z axis AX AY AZ omega W")
        words.expect("origin")
        origin = np.array(words.numbers(3))
        words.expect("axis")
        axis = np.array(words.numbers(3))
        length = float(np.linalg.norm(axis))
        if not 0.0 < length < np.inf:
            msg = f"axis {' '.join(f'{c:g}' for c in axis)} has no direction"
            raise InputError(msg)
        words.expect("omega")
        return cls((_speed(words),), origin, axis / length)

    @property
    def varies(self) -> bool:
        """Whether a variable gives it."""
        return any(isinstance(value, str) for value in self.values)

    def of_nodes(self, nodes: Floats, normals: Floats, variable: Callable[[str], float]) -> Floats:
        """Return the velocity of nodes, projected on their facet and rescaled, (n, 3, 3), m/s.

        Parameters
        ----------
        nodes, normals : ndarray, shape (n, 3, 3) and (n, 3)
            Triangles, m, and their unit normals.
        variable : callable
            Name of a variable to its value.
        """
        now = [variable(v) if isinstance(v, str) else v for v in self.values]
        if self.origin is None or self.axis is None:
            wanted = np.broadcast_to(np.array(now), nodes.shape)
        else:
            wanted = np.cross(now[0] * self.axis, nodes - self.origin)
        facing = normals[:, None, :]
        along = wanted - (wanted * facing).sum(axis=2, keepdims=True) * facing
        left = np.linalg.norm(along, axis=2, keepdims=True)
        size = np.linalg.norm(wanted, axis=2, keepdims=True)
        found: Floats = along * np.divide(size, left, out=np.zeros_like(left), where=left > 0.0)
        return found


def _speed(words: Words) -> float | str:
    word = words.take("a number or v_NAME")
    return word[2:] if word.startswith("v_") else number(word, "surface velocity")
