"""Where a contact is and how its surfaces move: geometry and kinematics, with 3-vectors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np


class Body(NamedTuple):
    """A sphere, or a wall: then without radius and mass.

    Attributes
    ----------
    v, w : ndarray, shape (3,)
        Velocity (of a wall where the contact is), m/s, and spin, rad/s.
    kind : int
        Type, from 1.
    frozen : bool
        True if it does not give way; the effective mass is then that of the other.
    """

    v: np.ndarray
    w: np.ndarray
    kind: int
    radius: float | None = None
    mass: float | None = None
    frozen: bool = False


@dataclass(frozen=True)
class History:
    """What a contact remembers.

    Attributes
    ----------
    s, m : ndarray, shape (3,)
        Tangential displacement, m, and rolling torque, N m.
    impact : float
        Impact speed, m/s; 0: none yet.
    largest, latest, adhesion : float
        Of plastic models: largest overlap and that of the step before, m, stiffness of adhesion.
    """

    s: np.ndarray = field(default_factory=lambda: np.zeros(3))
    m: np.ndarray = field(default_factory=lambda: np.zeros(3))
    impact: float = 0.0
    largest: float = 0.0
    latest: float = 0.0
    adhesion: float = 0.0


@dataclass(frozen=True)
class Materials:
    """Material values by their LIGGGHTS names, see `scene.Scene.materials`."""

    values: Mapping[str, np.ndarray]

    def pair(self, name: str, a: int, b: int) -> float:
        """Return a value of a pair of types, or the only value there is."""
        values = self.values[name]
        return float(values[a - 1, b - 1] if np.ndim(values) == 2 else values)

    def young(self, a: int, b: int) -> float:
        """Return the effective Young's modulus, Pa."""
        Y, nu = self.values["youngsModulus"], self.values["poissonsRatio"]
        return 1.0 / sum((1.0 - nu[k - 1] ** 2) / Y[k - 1] for k in (a, b))

    def shear(self, a: int, b: int) -> float:
        """Return the effective shear modulus, Pa."""
        Y, nu = self.values["youngsModulus"], self.values["poissonsRatio"]
        return 1.0 / sum(2.0 * (2.0 - nu[k - 1]) * (1.0 + nu[k - 1]) / Y[k - 1] for k in (a, b))


@dataclass(frozen=True)
class Touch:
    """Geometry and kinematics of a contact.

    Attributes
    ----------
    d, n : ndarray, shape (3,)
        From the other body, and its direction.
    delta, radius, mass : float
        Overlap, effective radius and mass.
    arm, other_arm : float
        From the centres to the contact point; the second is 0 for a wall.
    v_n : float
        Normal relative velocity; negative while approaching.
    v_t : ndarray
        Relative velocity of the surfaces along each other.
    w_rel : ndarray
        Relative spin that the rolling models use.
    """

    i: Body
    j: Body
    d: np.ndarray
    n: np.ndarray
    delta: float
    radius: float
    mass: float
    arm: float
    other_arm: float
    v_n: float
    v_t: np.ndarray
    w_rel: np.ndarray

    @property
    def distance(self) -> float:
        """Distance of the centres, or of centre and wall, m."""
        return float(np.linalg.norm(self.d))

    @property
    def kinds(self) -> tuple[int, int]:
        """The types of both bodies."""
        return self.i.kind, self.j.kind

    @classmethod
    def of(cls, i: Body, j: Body, d: np.ndarray) -> Touch:
        """Work out a contact of sphere i with a sphere or wall j."""
        r = float(np.linalg.norm(d))
        n = d / r
        v = i.v - j.v
        v_n = float(v @ n)
        if j.radius is None:
            delta = i.radius - r
            radius, mass = i.radius, i.mass
            arm, other_arm = i.radius - delta / 2.0, 0.0
        else:
            delta = i.radius + j.radius - r
            radius = i.radius * j.radius / (i.radius + j.radius)
            mass = i.mass * j.mass / (i.mass + j.mass)
            mass = i.mass if j.frozen else j.mass if i.frozen else mass
            arm, other_arm = i.radius - delta / 2.0, j.radius - delta / 2.0
        w = (arm * i.w + other_arm * j.w) / r
        v_t = v - v_n * n - np.cross(w, d)
        w_rel = w if j.radius is None else i.w - j.w
        return cls(i, j, d, n, delta, radius, mass, arm, other_arm, v_n, v_t, w_rel)
