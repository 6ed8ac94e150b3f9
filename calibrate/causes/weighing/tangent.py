"""Everything measured, straight around a point.

Coordinates z have the unit normal as prior. Around a point everything measured is

    y = J (z' - z) + what causes add + errors of unit variance

so that the parameters integrate out: what is left has the covariance 1 + J J^T, in which a cause
is judged by what the parameters cannot imitate.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.candidates import Candidate
from calibrate.causes.weighing.bench import Bench, bench_at
from calibrate.causes.weighing.effects import Added, added_by
from calibrate.causes.weighing.switched import terms_with
from calibrate.inference.problem import Problem

__all__ = ["Tangent", "tangent_at"]

STEP: Final = 1e-3
"""Of a prior deviation, for slopes."""


@dataclass(frozen=True, eq=False)
class Tangent:
    """Everything measured, straight around a point; N numbers of unit variance.

    Attributes
    ----------
    z : (K,) float64
    bench : Bench
        n = 1.
    near : Bench
        The point, and for each coordinate one a `STEP` away.
    left : (N,) float64
        Measured minus expected; the independent measurements of unknowns behind the readings.
    slopes : (N, K) float64
        Of what is expected, by z.
    spans : tuple of slice
        Of each reading.
    shares : tuple of float
        By which numbers of each reading are stretched, see `tangent_at`.
    """

    z: Array
    bench: Bench
    near: Bench
    left: Array
    slopes: Array
    spans: tuple[slice, ...]
    shares: tuple[float, ...]

    def stacked(self, added: Added) -> tuple[Array, Array]:
        """Return slope and bend of a cause over everything measured, (N,) each."""
        slope, bend = np.zeros((2, len(self.left)))
        for k, part in added.slopes.items():
            slope[self.spans[k]] = self.shares[k] * part[0]
            bend[self.spans[k]] = self.shares[k] * added.bends[k][0]
        return slope, bend

    def added(self, candidate: Candidate) -> tuple[Array, Array]:
        """Return what a cause adds at the point, see `stacked`."""
        return self.stacked(added_by(self.bench, candidate))

    def stretched(self, added: Array) -> Tangent:
        """Return the same with errors as large as what is left beside a cause suggests.

        Parameters
        ----------
        added : (N,) float64
            What causes add, in units of this tangent.
        """
        factors, shares = np.ones(len(self.left)), []
        left = self.left - added
        for span, own, degrees in zip(self.spans, self.shares, self.bench.freedom, strict=True):
            shares.append(_share(left[span] / own, float(degrees[0])))
            factors[span] = shares[-1] / own
        return replace(
            self,
            left=factors * self.left,
            slopes=factors[:, None] * self.slopes,
            shares=tuple(shares),
        )

    def uphill(self, members: Sequence[Candidate], strengths: Array) -> Array:
        """Return the slope of the log likelihood by z, (K,), with causes of given strengths."""
        points = np.arange(len(self.near))
        x = np.broadcast_to(strengths, (len(points), len(members)))
        height = terms_with(self.near, members, x, points).sum(axis=1) + self.near.known
        return np.asarray((height[1:] - height[0]) / STEP)

    @property
    def covariance(self) -> Array:
        """Covariance of what is left, the prior of the parameters counted, (N, N)."""
        return np.asarray(np.eye(len(self.left)) + self.slopes @ self.slopes.T)


def _share(left: Array, freedom: float) -> float:
    """Return what the numbers of a reading, (L,), are stretched by.

    An error that repeats told is taken to be as large as what is left there suggests (the normal
    that touches Student's t).
    """
    return math.sqrt((freedom + len(left)) / (freedom + float(left @ left))) if freedom else 1.0


def tangent_at(problem: Problem, z: Array) -> Tangent:
    """Return everything measured, straight around a point z, (K,)."""
    size = len(z)
    points = np.vstack([z, z + STEP * np.eye(size)])
    bench = bench_at(problem, problem.space.from_normal(points))
    left, slopes, spans, shares, first = [], [], [], [], 0
    whitening = bench.whitening
    for turned, own, degrees in zip(whitening, bench.left, bench.freedom, strict=True):
        # Slopes in units of the errors at the point itself.
        back = np.linalg.solve(turned, own[:, :, None])[:, :, 0]
        same = back @ turned[0].T
        shares.append(_share(same[0], float(degrees[0])))
        same = same * shares[-1]
        left.append(same[0])
        slopes.append((same[0] - same[1:]).T / STEP)
        spans.append(slice(first, first + own.shape[1]))
        first += own.shape[1]
    for known in problem.known:
        away = (known.value - bench.points[:, known.index]) / known.se
        left.append(away[:1])
        slopes.append((away[0] - away[1:])[None] / STEP)
    rows = np.concatenate(left) if left else np.zeros(0)
    table = np.vstack(slopes) if slopes else np.zeros((0, size))
    return Tangent(z, bench.rows(np.array([0])), bench, rows, table, tuple(spans), tuple(shares))
