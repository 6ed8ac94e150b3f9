"""Curves by a few numbers: principal components of their values, each level with its own weight."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from calibrate.arrays import Array

__all__ = ["Components", "components_of"]

SHARE: Final = 1.0 - 1e-6
"""Share of the weighted variance that the components explain. What is cut off counts as what the
emulator does not know, though it is luck of single runs for the most part: a thousandth of the
variance of a time that doubles over the ranges is more than a scale's error."""
MOST: Final = 12


@dataclass(frozen=True)
class Components:
    """y = centre + basis @ scores + what is cut off.

    Attributes
    ----------
    centre : (L,) float64
    basis : (L, F) float64
    analysis : (F, L) float64
        Gives the scores of y - centre.
    truncation : (L,) float64
        Variance of what is cut off.
    """

    centre: Array
    basis: Array
    analysis: Array
    truncation: Array

    def scores(self, y: Array) -> Array:
        """Return the scores of n curves, (n, F)."""
        return np.asarray((y - self.centre) @ self.analysis.T)


def components_of(y: Array) -> Components:
    """Return the components of an output.

    Levels are weighted by their standard deviation, so that a late part of a curve, where all runs
    differ, does not hide the beginning. A single number is its own component.

    Parameters
    ----------
    y : (n, L) float64
        n >= 2 runs without nan.
    """
    if y.shape[1] == 1:
        one = np.ones((1, 1))
        return Components(np.zeros(1), one, one, np.zeros(1))
    centre, size = y.mean(axis=0), y.std(axis=0)
    size = np.where(size > 0.0, size, 1.0)
    _, singular, directions = np.linalg.svd((y - centre) / size, full_matrices=False)
    explained = np.cumsum(singular**2)
    enough = int(np.searchsorted(explained, SHARE * explained[-1])) + 1
    kept = directions[: min(enough, MOST)]
    basis, analysis = (kept * size).T, kept / size
    rest = (y - centre) - (y - centre) @ analysis.T @ basis.T
    return Components(centre, basis, analysis, np.asarray(np.mean(rest**2, axis=0)))
