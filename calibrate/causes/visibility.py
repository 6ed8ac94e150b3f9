"""What the data could show at all: absorbed shares, detection limits, look-alikes, bias.

Printed before any verdict. All numbers come from slopes and errors where the base model fits best,
not from the measured values.

With slopes J on the unit ranges, prior covariance C of the parameters, errors V and the signature
g of a candidate: K = V + J C J', I = g' K^-1 g, absorbed = 1 - I / (g' V^-1 g),
detectable = 2.8 / sqrt(I), bias = C J' K^-1 g.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from scipy import stats
from scipy.cluster.hierarchy import fcluster, linkage
from scipy.spatial.distance import squareform

from calibrate.arrays import Array
from calibrate.causes.candidates import Candidate
from calibrate.causes.hypotheses import Board, Hypothesis, Weighed
from calibrate.inference.problem import Problem, Reading

__all__ = ["Linear", "Visibility", "Visible", "linearised", "visibility"]

POWER80: Final = 2.80
"""Two-sided 5 % test with 80 % power: 1.96 + 0.84 standard deviations."""
TWO_SIDED: Final = 1.96
"""Standard deviations that chance exceeds in 5 % of cases."""
STRENGTHS: Final = 200
"""Strengths that stand for the prior of one."""
ALIKE: Final = 0.9
"""Residual signatures closer than this cannot be told apart by realistic data."""
STEP: Final = 0.02
"""Of the unit range: emulators are smooth over this."""
PRIOR_DRAWS: Final = 4000
_NOTHING: Final = 1e-20
_SHOWN: Final = ("absorbed", "detectable", "limit", "visible", "power")


@dataclass(frozen=True, eq=False)
class Linear:
    """The board, linear around a point; N is the number of all levels and known values.

    Attributes
    ----------
    slopes : (N, K) float64
        By unknowns of the base model, on their unit ranges.
    signatures : (N, c) float64
        By candidates, per ordinary strength.
    errors : (N, N) float64
        Covariance of data and emulators: Fisher's information where an error comes from repeats.
    prior : (K, K) float64
        Covariance of the unknowns on their unit ranges.
    """

    slopes: Array
    signatures: Array
    errors: Array
    prior: Array


@dataclass(frozen=True)
class Visible:
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
        Largest strength that is possible.
    power : float
        Chance that a 5 % test finds it at a strength drawn from its prior, 0.05 to 1.
    bias : dict of str to float
        Unknown to its change on [0, 1] per unit of strength when the cause is real and ignored.
    alike : tuple of str
        Candidates whose residual signature looks the same (absolute cosine above 0.9, average
        linkage).
    """

    candidate: str
    absorbed: float
    detectable: float
    limit: float
    power: float
    bias: dict[str, float]
    alike: tuple[str, ...]

    @property
    def visible(self) -> bool:
        """Whether it would be seen at a possible strength."""
        return self.detectable <= self.limit


@dataclass(frozen=True, eq=False)
class Visibility:
    """Visibility of every candidate.

    Attributes
    ----------
    candidates : tuple of Visible
    cosines : (c, c) float64
        Between their residual signatures.
    """

    candidates: tuple[Visible, ...]
    cosines: Array

    def of(self, candidate: str) -> Visible:
        """Return the row of one candidate."""
        return next(one for one in self.candidates if one.candidate == candidate)

    def table(self) -> pd.DataFrame:
        """Return a row for every candidate: absorbed, detectable, limit, visible, power, alike."""
        rows = [
            {
                "candidate": one.candidate,
                **{name: getattr(one, name) for name in _SHOWN},
                "alike": ", ".join(one.alike),
            }
            for one in self.candidates
        ]
        columns = ["candidate", *_SHOWN, "alike"]
        return pd.DataFrame(rows, columns=columns).set_index("candidate")


def visibility(board: Board, base: Weighed) -> Visibility:
    """Return what the data can say about every candidate, at the best values of the base model."""
    one = linearised(board, base.best)
    inverse = np.linalg.inv(one.errors + one.slopes @ one.prior @ one.slopes.T)
    g = one.signatures
    kept = np.einsum("ic,ij,jc->c", g, inverse, g)
    whole = np.einsum("ic,ij,jc->c", g, np.linalg.inv(one.errors), g)
    bias = one.prior @ one.slopes.T @ inverse @ g
    length = np.sqrt(np.maximum(kept, _NOTHING))
    seen = kept > _NOTHING
    cosines = np.where(np.outer(seen, seen), g.T @ inverse @ g / np.outer(length, length), 0.0)
    np.fill_diagonal(cosines, 1.0)
    labels = _groups(np.abs(np.clip(cosines, -1.0, 1.0)))
    rows = []
    for k, candidate in enumerate(board.candidates):
        changes = {
            board.problem.space.names[i]: float(bias[i, k]) / candidate.scale
            for i in board.problem.space.asked
        }
        alike = tuple(
            other.name
            for j, other in enumerate(board.candidates)
            if j != k and labels[j] == labels[k]
        )
        absorbed = float(1.0 - kept[k] / whole[k]) if whole[k] > 0.0 else 1.0
        limit = POWER80 * candidate.scale / float(length[k]) if seen[k] else float("inf")
        power = _power(candidate, float(length[k]) if seen[k] else 0.0)
        rows.append(
            Visible(candidate.name, absorbed, limit, candidate.limit, power, changes, alike)
        )
    return Visibility(tuple(rows), cosines)


def _power(candidate: Candidate, length: float) -> float:
    """Return the chance of a 5 % test over the prior of the strength.

    Parameters
    ----------
    candidate : Candidate
    length : float
        Standard deviations by which one ordinary strength stands out.
    """
    middles = (np.arange(STRENGTHS) + 0.5) / STRENGTHS
    away = candidate.prior.quantile(middles) / candidate.scale * length
    found = stats.norm.sf(TWO_SIDED - away) + stats.norm.cdf(-TWO_SIDED - away)
    return float(np.mean(found))


def linearised(board: Board, values: Array) -> Linear:
    """Return the board, linear around values (K,) of the base model."""
    problem = board.problem
    units = problem.space.units(values[None])[0]
    slopes = np.column_stack([_slope(problem, units, i) for i in range(problem.space.size)])
    signatures = [_signature(board, values, one) for one in board.candidates]
    drawn = problem.space.units(problem.space.draw(PRIOR_DRAWS, np.random.default_rng(0)))
    return Linear(
        slopes,
        np.column_stack([np.zeros((len(slopes), 0)), *signatures]),
        _errors(board, values),
        np.atleast_2d(np.cov(drawn, rowvar=False)),
    )


def _expected(problem: Problem, values: Array, known: Sequence[tuple[int, float]]) -> Array:
    """Return what readings and known values are expected to be, (n, N)."""
    parts = []
    for place in problem.places:
        mean = place.predict(values).mean
        for reading in place.readings:
            own = mean[:, reading.columns].copy()
            for index, loading in reading.shared:
                own += values[:, [index]] * loading
            parts.append(own)
    parts += [values[:, [index]] / se for index, se in known]
    return np.concatenate(parts, axis=1)


def _slope(problem: Problem, units: Array, column: int) -> Array:
    """Return the slopes of everything expected by one unit coordinate, (N,)."""
    moved = np.repeat(units[None], 2, axis=0)
    moved[:, column] += STEP * np.array([-1.0, 1.0])
    if problem.space.priors[column].bounded:
        moved[:, column] = np.clip(moved[:, column], 0.0, 1.0)
    known = [(one.index, one.se) for one in problem.known]
    low, high = _expected(problem, problem.space.values_of(moved), known)
    return np.asarray((high - low) / (moved[1, column] - moved[0, column]))


def _signature(board: Board, values: Array, candidate: Candidate) -> Array:
    """Return the slopes of everything expected by one ordinary strength, (N,)."""
    problem = Hypothesis(board, (candidate,)).problem
    at = len(board.problem.space.unknowns)
    moved = np.insert(np.repeat(values[None], 2, axis=0), at, 0.0, axis=1)
    size = min(candidate.scale, candidate.limit)
    moved[1, at] = size if candidate.high > 0.0 else -size
    known = [(one.index, one.se) for one in board.problem.known]
    off, on = _expected(problem, moved, known)
    return np.asarray((on - off) * candidate.scale / moved[1, at])


def _errors(board: Board, values: Array) -> Array:
    """Return the covariance of data and emulators, (N, N); known values have unit variance."""
    problem = board.problem
    blocks = []
    for place in problem.places:
        own = place.predict(values[None])
        for reading in place.readings:
            part = own.columns(reading.columns)
            factors = part.factors[0]
            block = np.diag(part.variance[0] + _information(reading)) + factors @ factors.T
            if reading.extra is not None:
                block = block + reading.extra @ reading.extra.T
            blocks.append(block)
    count = sum(len(block) for block in blocks)
    found = np.eye(count + len(problem.known))
    first = 0
    for block in blocks:
        found[first : first + len(block), first : first + len(block)] = block
        first += len(block)
    return found


def _information(reading: Reading) -> Array:
    """Return one over Fisher's information of the mean: that of Student's t after repeats."""
    if reading.repeats == 0:
        return reading.se**2
    dof, count = reading.repeats - 1, len(reading.se)
    return np.asarray(reading.se**2 * (dof + count + 2.0) / (dof + count))


def _groups(alike: Array) -> Array:
    """Return cluster labels by average linkage on one minus the absolute cosine."""
    if len(alike) < 2:
        return np.zeros(len(alike))
    distance = np.clip(1.0 - alike, 0.0, None)
    np.fill_diagonal(distance, 0.0)
    tree = linkage(squareform(distance, checks=False), method="average")
    return np.asarray(fcluster(tree, 1.0 - ALIKE, criterion="distance"))
