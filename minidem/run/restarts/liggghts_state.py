"""What a restart file of LIGGGHTS says, as plain arrays."""

from __future__ import annotations

import numpy as np

from minidem.record import field, record
from minidem.run.restarts.binary import damaged
from minidem.world.state import Floats, Ints

__all__ = ["Kept", "LiggghtsState"]


@record(frozen=True)
class Kept:
    """What a fix keeps with each atom.

    Attributes
    ----------
    style : str
        Style of the fix.
    start, size : ndarray of int64, shape (n,)
        Where the numbers of an atom begin in `LiggghtsState.block`, and how many they are.
    """

    style: str
    start: Ints
    size: Ints


@record
class LiggghtsState:
    """A restart file of LIGGGHTS.

    Attributes
    ----------
    version : str
        The program that wrote it.
    units : str
    step, types : int
    boundary : tuple of str
        Two letters per direction: p, f, s or m.
    lo, hi : ndarray of float64, shape (3,)
        Corners of the box, m.
    groups : dict
        Name to bit.
    position, velocity, omega : ndarray of float64, shape (n, 3)
        m, m/s, rad/s; particles in the order of the file.
    radius, mass, density : ndarray of float64, shape (n,)
        m, kg, kg/m3.
    ids, kind, mask : ndarray of int64, shape (n,)
        Particle ids, atom types from 1, group bits.
    image : ndarray of int64, shape (n, 3)
        Crossings of periodic faces.
    fixes : dict
        Id of a fix to its style and what it wrote, float64.
    kept : dict
        Id of a fix to what it keeps with atoms.
    block : ndarray of float64
        All numbers of all atoms.
    """

    version: str = ""
    units: str = ""
    step: int = 0
    types: int = 0
    boundary: tuple[str, ...] = ()
    lo: Floats = field(default_factory=lambda: np.zeros(3))
    hi: Floats = field(default_factory=lambda: np.zeros(3))
    groups: dict[str, int] = field(default_factory=dict)
    position: Floats = field(default_factory=lambda: np.zeros((0, 3)))
    velocity: Floats = field(default_factory=lambda: np.zeros((0, 3)))
    omega: Floats = field(default_factory=lambda: np.zeros((0, 3)))
    radius: Floats = field(default_factory=lambda: np.zeros(0))
    mass: Floats = field(default_factory=lambda: np.zeros(0))
    density: Floats = field(default_factory=lambda: np.zeros(0))
    ids: Ints = field(default_factory=lambda: np.zeros(0, np.int64))
    kind: Ints = field(default_factory=lambda: np.zeros(0, np.int64))
    mask: Ints = field(default_factory=lambda: np.zeros(0, np.int64))
    image: Ints = field(default_factory=lambda: np.zeros((0, 3), np.int64))
    fixes: dict[str, tuple[str, Floats]] = field(default_factory=dict)
    kept: dict[str, Kept] = field(default_factory=dict)
    block: Floats = field(default_factory=lambda: np.zeros(0))

    def of_atoms(self, fix: str, width: int) -> Floats:
        """Return what a fix keeps with each atom if that is `width` numbers, shape (n, width)."""
        kept = self.kept[fix]
        if not (kept.size == width + 1).all():
            damaged(f"fix {fix} keeps another count of numbers with some atoms")
        found: Floats = self.block[kept.start[:, None] + 1 + np.arange(width)]
        return found
