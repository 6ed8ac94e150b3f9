"""What responds to what: shares of an observable's variance over the ranges of the parameters."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd
from scipy import stats

from calibrate.arrays import Array
from calibrate.inference.problem import Place as Seen
from calibrate.inference.problem import Problem
from calibrate.planning.points import spread

__all__ = ["sensitivity"]

POINTS: Final = 1024
"""Base points; each costs as many predictions as there are inputs, and two."""


def sensitivity(problem: Problem, rng: np.random.Generator) -> pd.DataFrame:
    """Return first-order and total Sobol indices of every measured target.

    Parameters
    ----------
    problem : Problem
    rng : numpy Generator

    Returns
    -------
    DataFrame
        Columns target, name, first and total; a curve counts with all its levels together.

    References
    ----------
    A. Saltelli et al., Computer Physics Communications 181, 259 (2010); as scipy computes them.
    """
    rows = []
    for place in problem.places:
        columns = sorted({s.index for s in (*place.u, *place.strengths) if s.index is not None})
        if not columns:
            continue
        indices = _indices(problem, place, columns, rng)
        for reading in place.readings:
            first, total, weight = (part[reading.columns] for part in indices)
            share = weight / weight.sum() if weight.sum() > 0.0 else weight
            for k, column in enumerate(columns):
                rows.append(
                    {
                        "target": reading.name,
                        "name": problem.space.names[column],
                        "first": float(share @ first[:, k]),
                        "total": float(share @ total[:, k]),
                    }
                )
    return pd.DataFrame(rows, columns=["target", "name", "first", "total"])


def _indices(
    problem: Problem, place: Seen, columns: list[int], rng: np.random.Generator
) -> tuple[Array, Array, Array]:
    """Return first-order and total indices, (M, d) each, and the variances, (M,)."""
    d = len(columns)
    both = spread(POINTS, 2 * d, rng)
    a, b = both[:, :d], both[:, d:]

    def outputs(units: Array) -> Array:
        every = np.full((len(units), problem.space.size), 0.5)
        every[:, columns] = units
        return np.asarray(place.predict(problem.space.values_of(every)).mean.T)

    mixed = []
    for k in range(d):
        ab = a.copy()
        ab[:, k] = b[:, k]
        mixed.append(outputs(ab))
    values = {"f_A": outputs(a), "f_B": outputs(b), "f_AB": np.array(mixed)}
    variance = np.concatenate([values["f_A"], values["f_B"]], axis=1).var(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        found = stats.sobol_indices(func=values, n=POINTS)
    first, total = np.atleast_2d(found.first_order), np.atleast_2d(found.total_order)
    return np.nan_to_num(first), np.nan_to_num(total), variance
