"""Fixes that are only a few numbers: integrator, gravity, body forces, checks."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from minidem.fixes.base import Fix
from minidem.state import Floats

__all__ = ["CheckTimestep", "Integrate", "Post", "PropertyGlobal"]


@dataclass
class Integrate(Fix):
    """``fix nve/sphere``."""


@dataclass
class PropertyGlobal(Fix):
    """``fix property/global``: material values, kept in the world's `Materials`."""

    key: str = ""


@dataclass
class Post(Fix):
    """A force added or set after contacts, see `minidem.kernels.post.POST_KINDS`.

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
    """

    kind: int = 0
    value: Floats = field(default_factory=lambda: np.zeros(4))
    flags: int = 7
    variables: list[str | None] = field(default_factory=lambda: [None, None, None])


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
