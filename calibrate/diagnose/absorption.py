"""What the data could show at all: absorbed shares, detection limits, look-alikes.

Printed before any verdict. All numbers come from slopes and errors, not from the measured
values.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.cluster.hierarchy import fcluster, linkage
from scipy.spatial.distance import squareform

from calibrate.arrays import Array
from calibrate.diagnose.problem import Problem
from calibrate.diagnose.scores import Frame, marginal
from calibrate.diagnose.stack import PRIOR_SD

# Two-sided 5 % test with 80 % power: 1.96 + 0.84 standard deviations.
_POWER80 = 2.80
# Residual signatures closer than this cannot be told apart by realistic data.
_ALIKE = 0.9


@dataclass(frozen=True)
class Visibility:
    """What the data can say about one candidate.

    Attributes
    ----------
    candidate : str
    absorbed : float
        Share of its squared signature that the base parameters imitate, 0 to 1.
    detectable : float
        Smallest strength found with 80 % power in a 5 % test, in the candidate's unit; infinite
        for a signature of zero.
    limit : float
        Largest strength that is physically possible.
    visible : bool
        Whether `detectable` lies within `limit`.
    bias : mapping
        Parameter -> change on [0, 1] per unit strength when the effect is real and ignored.
    alike : tuple of str
        Candidates whose residual signature looks the same (absolute cosine above 0.9, average
        linkage).
    """

    candidate: str
    absorbed: float
    detectable: float
    limit: float
    visible: bool
    bias: dict[str, float]
    alike: tuple[str, ...]


@dataclass(frozen=True)
class Absorption:
    """Visibility of every candidate.

    Attributes
    ----------
    candidates : tuple of Visibility
    cosines : ndarray, shape (c, c)
        Cosines between their residual signatures.
    """

    candidates: tuple[Visibility, ...]
    cosines: Array

    def of(self, candidate: str) -> Visibility:
        """Row of one candidate."""
        return next(v for v in self.candidates if v.candidate == candidate)


def absorption(problem: Problem, one: Frame, held: Array) -> Absorption:
    """Compute the table in the frame of the base fit.

    Parameters
    ----------
    held : ndarray of bool, shape (d,)
        Parameters at their limit, which absorb nothing.
    """
    g = one.by_phi
    inverse = np.linalg.inv(marginal(one.covariance, one.by_u))
    plain = np.linalg.inv(one.covariance)
    kept = np.sum(g * (inverse @ g), axis=0)
    whole = np.sum(g * (plain @ g), axis=0)
    # Length of a signature in the metric K^-1 (parameters integrated out).
    normal = one.by_u.T @ plain @ one.by_u + np.eye(one.by_u.shape[1]) / PRIOR_SD**2
    bias = np.linalg.solve(normal, one.by_u.T @ plain @ g)
    length = np.sqrt(np.maximum(kept, 1e-30))
    cosines = (g.T @ inverse @ g) / np.outer(length, length)
    cosines = np.where(np.outer(kept > 1e-20, kept > 1e-20), cosines, 0.0)
    np.fill_diagonal(cosines, 1.0)
    groups = _groups(np.abs(np.clip(cosines, -1.0, 1.0)))
    names = [p.name for p, h in zip(problem.parameters, held, strict=True) if not h]
    rows = []
    for k, candidate in enumerate(problem.candidates):
        limit = max(abs(candidate.lower), abs(candidate.upper))
        detectable = float(_POWER80 / np.sqrt(kept[k])) if kept[k] > 1e-20 else float("inf")
        alike = tuple(
            c.name for j, c in enumerate(problem.candidates) if j != k and groups[j] == groups[k]
        )
        rows.append(
            Visibility(
                candidate=candidate.name,
                absorbed=float(1.0 - kept[k] / whole[k]) if whole[k] > 0.0 else 1.0,
                detectable=detectable,
                limit=limit,
                visible=detectable <= limit,
                bias=dict(zip(names, (float(b) for b in bias[:, k]), strict=True)),
                alike=alike,
            )
        )
    return Absorption(tuple(rows), cosines)


def _groups(alike: Array) -> Array:
    """Cluster labels by average linkage on one minus the absolute cosine."""
    if len(alike) < 2:
        return np.zeros(len(alike))
    distance = np.clip(1.0 - alike, 0.0, None)
    np.fill_diagonal(distance, 0.0)
    tree = linkage(squareform(distance, checks=False), method="average")
    return np.asarray(fcluster(tree, 1.0 - _ALIKE, criterion="distance"))
