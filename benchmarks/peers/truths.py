"""Planted truths: parameters, and what the bench would have measured with them.

Measured numbers are means over fresh seeds of the engine, as a bench's are means over repeats. The
standard error of a target is that of the paper's tables, or that of the mean where forty seeds do
not reach it (`plant`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.stats import qmc

from benchmarks.peers.apparatus import KEPT_BACK, PLACES, RANGES, TARGETS, UNSEEN, Place
from benchmarks.peers.problem import Array, draw_seed, observed
from benchmarks.peers.simulator import Simulator

SEED: Final = 20261121
SEEDS: Final = 40
MARGIN: Final = 0.05  # of a range at both its ends: a truth on the edge would help clipped answers


@dataclass(frozen=True)
class Truth:
    """What is hidden from the methods, and what they get.

    Attributes
    ----------
    number : int
    theta : (6,) float64
    measured, error : Mapping[str, float]
        Targets with their standard errors.
    unseen, unseen_error, unseen_spread : Mapping[str, float]
        What an answer has to predict: mean, standard error, and scatter of one run.
    """

    number: int
    theta: Array
    measured: Mapping[str, float]
    error: Mapping[str, float]
    unseen: Mapping[str, float]
    unseen_error: Mapping[str, float]
    unseen_spread: Mapping[str, float]


def parameters_of(number: int, count: int) -> Array:
    """Return truth `number` of a Latin hypercube of `count`, (6,)."""
    unit = qmc.LatinHypercube(len(RANGES), rng=np.random.default_rng(SEED)).random(count)[number]
    low, high = np.array(list(RANGES.values())).T
    return np.asarray(low + (high - low) * (MARGIN + (1.0 - 2.0 * MARGIN) * unit))


def plant(simulator: Simulator, number: int, theta: Array) -> Truth:
    """Simulate a truth over its own seeds.

    Parameters
    ----------
    simulator : Simulator
    number : int
        Chooses seeds and errors.
    theta : (6,) float64

    Returns
    -------
    Truth
        Where the mean over seeds is more exact than the paper's table, a normal error is added so
        that the table's standard error is right.
    """
    rng = np.random.default_rng([SEED, number])
    named = dict(zip(RANGES, map(float, theta), strict=True))
    seeds = [draw_seed(rng) for _ in range(SEEDS)]
    rows = _rows(simulator, {**PLACES, **KEPT_BACK}, named, seeds)
    values, errors = {}, {}
    for name, target in TARGETS.items():
        y = np.array([observed(row, [target])[0] for row in rows])
        own = mean_error(y)
        errors[name] = max(own, target.error)
        values[name] = float(np.nanmean(y) + rng.normal() * np.sqrt(errors[name] ** 2 - own**2))
    unseen = {
        name: np.array([observed(row, [hidden])[0] for row in rows])
        for name, hidden in UNSEEN.items()
    }
    return Truth(
        number,
        theta,
        values,
        errors,
        {name: float(np.nanmean(y)) for name, y in unseen.items()},
        {name: max(mean_error(y), UNSEEN[name].error) for name, y in unseen.items()},
        {name: float(np.nanstd(y, ddof=1)) for name, y in unseen.items()},
    )


def _rows(
    simulator: Simulator,
    places: Mapping[str, Place],
    parameters: Mapping[str, float],
    seeds: list[int],
) -> list[dict[str, Mapping[str, float]]]:
    """Return the observables of all places for each seed."""
    return [
        {name: simulator.run(place, parameters, seed).observables for name, place in places.items()}
        for seed in seeds
    ]


def predict(simulator: Simulator, theta: Array, seeds: list[int]) -> dict[str, Array]:
    """Return what an answer says about the unseen measurements, one value per seed."""
    rows = _rows(simulator, KEPT_BACK, dict(zip(RANGES, map(float, theta), strict=True)), seeds)
    return {
        name: np.array([observed(row, [hidden])[0] for row in rows])
        for name, hidden in UNSEEN.items()
    }


def mean_error(y: Array) -> float:
    """Return the standard error of the mean of the runs that did not fail."""
    return float(np.nanstd(y, ddof=1) / np.sqrt(np.isfinite(y).sum()))
