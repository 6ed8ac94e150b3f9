"""Materials with tied wall frictions, linear and normal: everything is known exactly."""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np
from scipy import special, stats

from calibrate.arrays import Array
from calibrate.inference.priors import Prior
from calibrate.inference.problem import Place, Problem, Reading, Source
from calibrate.inference.space import Space, Tie, Unknown
from tests.calibrate.inference.linear import linear

OWN, ROWS, SE, SCALE, SHARED = 3, 8, 0.05, 0.1, 0.05
FLAT = 3.0
"""Standard deviation of the normal that stands for a flat mean; all data lie within 0.1 of it."""
LEAST = 1e-4
"""Smallest spread of the quadrature; all below says the same."""


class Tied(NamedTuple):
    """A problem and its linear model, all materials one after another, the shared error last."""

    problem: Problem
    slopes: Array
    y: Array


class Exact(NamedTuple):
    """Log evidence; mean and deviation of the unknowns, then of the spreads."""

    log_evidence: float
    mean: Array
    sd: Array
    spread: Array
    spread_sd: Array


def tied(materials: int, ties: int, spread: float, seed: int = 0) -> Tied:
    """Return materials of three unknowns each and some tied ones, eight readings each."""
    rng = np.random.default_rng(seed)
    per = OWN + ties
    free, flat = Prior.normal(0.0, 1.0), Prior.uniform(0.0, 1.0)
    unknowns = [
        Unknown(f"x{k}", f"M{m}", free if k < OWN else flat)
        for m in range(materials)
        for k in range(per)
    ]
    unknowns.append(Unknown.shared_error("balance"))
    members = [tuple(m * per + k for m in range(materials)) for k in range(OWN, per)]
    space = Space(
        tuple(unknowns), tuple(Tie(f"x{OWN + k}", one, SCALE) for k, one in enumerate(members))
    )
    slopes = np.zeros((materials * ROWS, len(unknowns)))
    y, places = np.zeros(materials * ROWS), []
    walls = 0.5 + spread * rng.standard_normal((materials, ties))
    for m in range(materials):
        rows = slice(m * ROWS, (m + 1) * ROWS)
        own = rng.normal(size=(ROWS, per)) * np.repeat([0.3, 1.0], [OWN, ties])
        slopes[rows, m * per : (m + 1) * per] = own
        slopes[rows, -1] = SHARED * rng.normal(size=ROWS)
        truth = np.concatenate([rng.standard_normal(OWN), walls[m]])
        y[rows] = own @ truth + SE * rng.standard_normal(ROWS) + 0.7 * slopes[rows, -1]
        last = len(unknowns) - 1
        readings = tuple(
            Reading(f"t{k}", slice(k, k + 1), value[None], np.array([SE]), 0, ((last, load[None]),))
            for k, (value, load) in enumerate(zip(y[rows], slopes[rows, -1], strict=True))
        )
        sources = tuple(Source(m * per + k) for k in range(per))
        places.append(Place(f"M{m}", linear(own), sources, (), readings))
    return Tied(Problem(space, tuple(places)), slopes, y)


def exact(model: Tied, points: int = 24) -> Exact:
    """Return what sums over all spreads tell; given these, everything is linear and normal."""
    ties = model.problem.space.ties
    size = model.slopes.shape[1]
    x = np.linspace(np.log(LEAST), np.log(5.0 * SCALE), points)
    spreads, weight = np.exp(x), np.full(points, x[1] - x[0])
    weight[[0, -1]] *= 0.5
    prior = weight * spreads * stats.halfnorm.pdf(spreads, 0.0, SCALE)
    prior[0] += stats.halfnorm.cdf(LEAST, 0.0, SCALE)
    centre = np.zeros(size)
    for tie in ties:
        centre[list(tie.members)] = 0.5
    flat = np.log(FLAT * np.sqrt(2.0 * np.pi))
    logs, means, squares, used = [], [], [], []
    for chosen in itertools.product(range(points), repeat=len(ties)):
        before = np.eye(size)
        for k, tie in zip(chosen, ties, strict=True):
            at = np.ix_(tie.members, tie.members)
            before[at] = spreads[k] ** 2 * np.eye(len(tie.members)) + FLAT**2
        mean, covariance, log_p = _given(model, centre, before)
        logs.append(log_p + sum(np.log(prior[k]) + flat for k in chosen))
        means.append(mean)
        squares.append(np.diag(covariance) + mean**2)
        used.append(spreads[list(chosen)])
    total = special.logsumexp(logs)
    share = np.exp(np.array(logs) - total)
    mean, spread = share @ np.array(means), share @ np.array(used)
    sd = np.sqrt(share @ np.array(squares) - mean**2)
    spread_sd = np.sqrt(share @ np.array(used) ** 2 - spread**2)
    return Exact(float(total), mean, sd, spread, spread_sd)


def _given(model: Tied, centre: Array, before: Array) -> tuple[Array, Array, float]:
    """Return mean, covariance and log evidence under a normal prior."""
    root = np.linalg.inv(before)
    covariance = np.linalg.inv(root + model.slopes.T @ model.slopes / SE**2)
    away = model.y - model.slopes @ centre
    pull = model.slopes.T @ away / SE**2
    mean = covariance @ pull
    log_p = -0.5 * (away @ away / SE**2 - pull @ mean)
    log_p -= len(away) * (np.log(SE) + 0.5 * np.log(2.0 * np.pi))
    log_p -= 0.5 * (np.linalg.slogdet(before)[1] - np.linalg.slogdet(covariance)[1])
    return centre + mean, covariance, log_p
