"""Model discrepancy: readings that the simulation may miss whatever its parameters are.

A simulation with one diameter, no air and rigid plates cannot meet everything that was measured. If
it had to, the one reading that it cannot meet would bend all parameters, and draw them to where the
emulators know least. So each reading has a small chance to be off by a shift of unknown origin.

References
----------
Kennedy & O'Hagan, Journal of the Royal Statistical Society B 63, 425-464 (2001): calibration with a
discrepancy. Box & Tiao, Biometrika 55, 119-129 (1968): a mixture for observations that do not fit.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.inference.likelihood import discrepancy_probability
from calibrate.inference.problem import Discrepancy, Place, Problem

__all__ = ["SHARE", "discrepancy_probabilities", "reaches", "with_discrepancy"]

SHARE: Final = 0.25
"""Standard deviation of a shift of unknown origin, in those of what the ranges allow."""
PRIOR_DRAWS: Final = 512


def reaches(problem: Problem, rng: np.random.Generator) -> list[list[float]]:
    """Return the standard deviation of a shift of unknown origin, per place and reading.

    Parameters
    ----------
    problem : Problem
    rng : Generator
        For draws of the prior.

    Returns
    -------
    list of list of float
        `SHARE` of what the emulators' means scatter over the prior, on the model scale and averaged
        over the levels of a curve, which is shifted as a whole.
    """
    values = problem.space.draw(PRIOR_DRAWS, rng)
    found = []
    for place in problem.places:
        mean = place.predict(values).mean
        spreads = [mean[:, reading.columns].std(axis=0) for reading in place.readings]
        found.append([SHARE * float(np.sqrt(np.mean(one**2))) for one in spreads])
    return found


def with_discrepancy(problem: Problem, chance: float, rng: np.random.Generator) -> Problem:
    """Return the problem with a chance for each reading that the model is wrong about it.

    Parameters
    ----------
    problem : Problem
    chance : float
        Probability for each reading before the data; 0 for none.
    rng : Generator
        For draws of the prior.
    """
    if chance == 0.0:
        return problem
    places = []
    for place, sizes in zip(problem.places, reaches(problem, rng), strict=True):
        readings = tuple(
            replace(one, discrepancy=Discrepancy(chance, np.maximum(size, one.se)))
            for one, size in zip(place.readings, sizes, strict=True)
        )
        places.append(replace(place, readings=readings))
    return replace(problem, places=tuple(places))


def discrepancy_probabilities(place: Place, values: Array) -> Array:
    """Return how probable it is at n points that the model is wrong, (n, readings)."""
    prediction = place.predict(values)
    columns = [discrepancy_probability(one, prediction, values) for one in place.readings]
    return np.column_stack(columns) if columns else np.zeros((len(values), 0))
