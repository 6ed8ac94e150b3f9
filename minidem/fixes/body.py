"""Fixes that are only a few numbers: integrator, gravity, body forces, checks."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from minidem.fixes.gravity_field import GravityField
from minidem.world.fix import Fix
from minidem.world.state import Floats

__all__ = ["Adapt", "CheckTimestep", "Integrate", "Post", "PropertyGlobal"]


@dataclass
class Integrate(Fix):
    """``fix nve/sphere``."""


@dataclass
class PropertyGlobal(Fix):
    """``fix property/global``: material values, kept in the world's `Materials`."""

    key: str = ""


@dataclass
class Post(Fix):
    """A force added or set after contacts, see `minidem.kernels.motion.post.POST_KINDS`.

    Attributes
    ----------
    kind : int
        Index in `POST_KINDS`.
    value : ndarray, shape (4,) to (8,)
        Its numbers.
    flags : int
        A bit per component (setforce).
    variables : list
        Names of variables that give the components, None for constants.
    region : str
        Only particles in this region; empty for all.
    energy : str or None
        Atom-style variable that gives the potential energy (addforce).
    per_type : ndarray or None
        Coefficient of each atom type (viscous), N s/m.
    pull : GravityField or None
        Strength and direction of gravity.
    before : ndarray, shape (4,)
        Potential energy, J, and total force on the particles before it was changed, N.
    """

    kind: int = 0
    value: Floats = field(default_factory=lambda: np.zeros(4))
    flags: int = 7
    variables: list[str | None] = field(default_factory=lambda: [None, None, None])
    region: str = ""
    energy: str | None = None
    per_type: Floats | None = None
    pull: GravityField | None = None
    before: Floats = field(default_factory=lambda: np.zeros(4))

    def vector(self, index: int) -> float:
        """Return the potential energy (0) or the total force before this fix (1-3)."""
        values = {"gravity": (0,), "addforce": (0, 1, 2, 3), "setforce": (1, 2, 3)}
        if index not in values.get(self.style, (1, 2, 3) if self.style == "freeze" else ()):
            return super().vector(index)
        return float(self.before[index])


@dataclass
class Adapt(Fix):
    """``fix adapt``: diameters from a variable every so many steps, 0: at the start of a run."""

    every: int = 0
    variable: str = ""


@dataclass
class CheckTimestep(Fix):
    """``fix check/timestep/gran``: compares the step with Rayleigh and Hertz times."""

    every: int = 1
    rayleigh: float = 1.0
    hertz: float = 1.0
    values: Floats = field(default_factory=lambda: np.zeros(3))
    told: bool = False

    def vector(self, index: int) -> float:
        """Return dt/dt_Rayleigh, dt/dt_Hertz or vmax dt/skin."""
        if not 1 <= index <= 3:
            return super().vector(index)
        return float(self.values[index - 1])
