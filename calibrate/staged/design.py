"""Where to simulate: Latin hypercubes and points spread over a cloud of samples."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray
from smt.sampling_methods import LHS

from calibrate.arrays import Array

__all__ = ["latin_hypercube", "spread"]


def latin_hypercube(bounds: Array, count: int, rng: np.random.Generator) -> Array:
    """Return a space-filling Latin hypercube.

    Each parameter's range is cut into `count` equal parts and each part holds exactly one point;
    among such designs smt looks for one whose points keep apart (enhanced stochastic evolution).

    Parameters
    ----------
    bounds : (d, 2) float64
        Lower and upper limit per parameter.
    count : int
        Number of points.
    rng : numpy.random.Generator
        Source of chance; equal states give equal designs.

    Returns
    -------
    (count, d) float64
        Points in the parameters' own units.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # smt warns about its own option names
        make: Any = LHS  # smt ships no annotations
        sampler = make(xlimits=np.asarray(bounds, float), criterion="ese", seed=rng)
        return np.asarray(sampler(count), float)


def spread(candidates: Array, start: Array, count: int) -> NDArray[np.intp]:
    """Choose points that keep apart: each new one is the farthest from all chosen so far.

    Parameters
    ----------
    candidates : (n, d) float64
        Points to choose from, scaled so that distances mean something.
    start : (m, d) float64
        Points that exist already, at least one.
    count : int
        How many to choose, at most n.

    Returns
    -------
    (count,) int
        Rows of `candidates`.
    """
    distance = np.min(np.linalg.norm(candidates[:, None] - start[None], axis=2), axis=1)
    chosen = np.empty(count, np.intp)
    for i in range(count):
        chosen[i] = int(np.argmax(distance))
        step = np.linalg.norm(candidates - candidates[chosen[i]], axis=1)
        distance = np.minimum(distance, step)
    return chosen
