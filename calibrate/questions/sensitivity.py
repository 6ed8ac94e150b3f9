"""What responds to what: shares of a target's variance over the ranges of the parameters."""

from __future__ import annotations

import numpy as np
import pandas as pd

from calibrate.arrays import Array
from calibrate.inference.problem import Place, Problem
from calibrate.inference.sensitivity import sobol
from calibrate.inference.space import Space

__all__ = ["sensitivity"]


def sensitivity(problem: Problem, rng: np.random.Generator) -> pd.DataFrame:
    """Return first-order and total Sobol indices of every measured target.

    Parameters
    ----------
    problem : Problem
    rng : numpy Generator

    Returns
    -------
    DataFrame
        Columns target, level (position in a curve, 0 for a number), name, first and total. What is
        tied varies on its own here.
    """
    parts = [_of_place(problem, place, rng) for place in problem.places]
    return pd.concat(parts, ignore_index=True)


def _of_place(problem: Problem, place: Place, rng: np.random.Generator) -> pd.DataFrame:
    """Return the indices of one place by the unknowns that act there."""
    columns = sorted({s.index for s in (*place.u, *place.strengths) if s.index is not None})
    outputs = [(reading.name, k) for reading in place.readings for k in range(len(reading.y))]
    if not (columns and outputs):
        return pd.DataFrame(columns=["target", "level", "name", "first", "total"])
    middle = problem.space.values_of(np.full((1, problem.space.size), 0.5))

    def expected(values: Array) -> Array:
        every = np.repeat(middle, len(values), axis=0)
        every[:, columns] = values
        mean = place.predict(every).mean
        return np.hstack([mean[:, reading.columns] for reading in place.readings])

    own = Space(tuple(problem.space.unknowns[k] for k in columns))
    names = [f"{name}@{k}" for name, k in outputs]
    found = sobol(own, expected, names, rng).rename(columns={"unknown": "name"})
    found.insert(0, "target", found["output"].str.rpartition("@")[0])
    found.insert(1, "level", found.pop("output").str.rpartition("@")[2].astype(int))
    return found
