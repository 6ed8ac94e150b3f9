"""Outputs whose law is known, as an emulator takes them."""

from __future__ import annotations

import numpy as np
from scipy.stats import qmc

from calibrate.arrays import Array
from calibrate.emulator.covariance import Design, Hyper, covariance, fixed
from calibrate.emulator.types import Inputs, Output

ONE = (Output("y", slice(0, 1)),)


def spread_points(n: int, d: int, rng: np.random.Generator) -> Array:
    """Return n points that fill the unit cube evenly, (n, d)."""
    power = int(np.ceil(np.log2(n)))
    return np.asarray(qmc.Sobol(d, rng=rng).random_base2(power)[:n])


def runs_at(u: Array, effects: int = 0) -> Inputs:
    """Return runs without effects, a seed for each."""
    return Inputs(u, np.zeros((len(u), effects)), np.arange(len(u), dtype=float))


def with_repeats(points: Array, repeats: int) -> Inputs:
    """Return every point with the same few seeds."""
    u = np.repeat(points, repeats, axis=0)
    seeds = np.tile(np.arange(repeats, dtype=float), len(points))
    return Inputs(u, np.zeros((len(u), 0)), seeds)


def draw(hyper: Hyper, inputs: Inputs, rng: np.random.Generator) -> Array:
    """Draw outputs of inputs from the law of `hyper`, without noise of a run, (n,).

    The trend is drawn with the smooth part; seeds that are not nan give their offsets.
    """
    design = Design(inputs.u, inputs.strengths, inputs.seeds)
    total, _ = covariance(hyper, design, fixed(design), design.same_seed)
    rotated = np.linalg.cholesky(total + 1e-9 * np.eye(len(total)))
    return np.asarray(rotated @ rng.standard_normal(len(total)))
