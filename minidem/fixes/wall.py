"""``mesh/surface``, ``wall/gran``, ``move/mesh`` and ``massflow/mesh``."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from minidem.world.fix import Fix
from minidem.world.state import Floats

__all__ = ["MassFlow", "MeshSurface", "MoveMesh", "WallGran"]


@dataclass
class MeshSurface(Fix):
    """A mesh; its triangles are in the world's `MeshStore`.

    Attributes
    ----------
    kind : int
        Atom type, from 1.
    limit : float
        Cosine above which facets are coplanar.
    slides : bool
        True with ``surface_vel`` or ``surface_ang_vel``.
    stress : bool
        True for ``mesh/surface/stress``: forces on the mesh are output.
    tolerant, heal : bool
        ``curvature_tolerant yes`` and ``heal auto_remove_duplicates``.
    load : ndarray, shape (6,)
        Force, N, and torque, N m, of the particles on the mesh.
    """

    kind: int = 1
    limit: float = 1.0
    slides: bool = False
    stress: bool = False
    tolerant: bool = False
    heal: bool = False
    load: Floats = field(default_factory=lambda: np.zeros(6))

    def vector(self, index: int) -> float:
        """Return force (1-3) and torque (4-6) on the mesh."""
        if not self.stress or not 1 <= index <= 6:
            return super().vector(index)
        return float(self.load[index - 1])


@dataclass
class WallGran(Fix):
    """A wall of meshes or one primitive wall.

    Attributes
    ----------
    switches : list of int
        Model, see `minidem.kernels.contact.law.SWITCHES`.
    meshes : list of str
        Mesh ids, empty for a primitive wall.
    shape, axis : int
        0 plane 1 cylinder; direction.
    kind : int
        Atom type, from 1.
    value : ndarray, shape (8,)
        See `minidem.kernels.tables.Walls.value`.
    turning : bool
        True if a cylinder turns about its axis.
    """

    switches: list[int] = field(default_factory=list)
    meshes: list[str] = field(default_factory=list)
    shape: int = 0
    axis: int = 2
    kind: int = 1
    value: Floats = field(default_factory=lambda: np.zeros(8))
    turning: bool = False


@dataclass
class MoveMesh(Fix):
    """A motion of a mesh, see `minidem.kernels.motion.motion.KINDS`."""

    mesh: str = ""
    kind: int = 0
    order: int = 0
    value: Floats = field(default_factory=lambda: np.zeros(104))
    clock: float = 0.0
    variables: list[str] = field(default_factory=list)


@dataclass
class MassFlow(Fix):
    """A counter of particles through a mesh.

    Attributes
    ----------
    mesh : str
        Mesh id.
    once : bool
        Count each particle at most once.
    side : ndarray, shape (3,)
        Side to which particles are counted.
    file : Any
        Open text file or None.
    """

    mesh: str = ""
    once: bool = False
    side: Floats = field(default_factory=lambda: np.zeros(3))
    file: Any = None
    write_time: bool = False
    screen: bool = False
    delete: bool = False
    mass: float = 0.0
    number: int = 0
    deleted_mass: float = 0.0
    deleted_number: int = 0
    doomed: set[int] = field(default_factory=set)
    rates: tuple[float, float] = (0.0, 0.0)
    base: tuple[int, float, int] = (0, 0.0, 0)

    def access(self, step: int, dt: float) -> None:
        """Work out the rates since the last access in an earlier step."""
        before, mass, number = self.base
        if step != before:
            passed = (step - before) * dt
            self.rates = ((self.mass - mass) / passed, (self.number - number) / passed)
            self.base = (step, self.mass, self.number)

    def vector(self, index: int) -> float:
        """Return mass, number, their rates since the last output, mass and number deleted."""
        values = (
            self.mass, float(self.number), *self.rates, self.deleted_mass,
            float(self.deleted_number),
        )  # fmt: skip
        if not 1 <= index <= len(values):
            return super().vector(index)
        return values[index - 1]
