"""How far a cause is from everything that other parameters can do, wherever they are.

The non-centrality of a hidden cause is what the parameters cannot imitate where they are, straight
on. A strong cause lets them go further: restitution that falls with speed is, for one experiment,
a smaller restitution coefficient.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final, TypeAlias

import numpy as np
from scipy import optimize

from calibrate.arrays import Array
from calibrate.causes.candidates import Board
from calibrate.emulator.types import Inputs, Prediction
from calibrate.inference.priors import from_unit
from calibrate.inference.problem import Place

__all__ = ["unlike_any"]

Misfit: TypeAlias = Callable[[Array], Array]

STARTS: Final = 16
"""Parameter sets from which the best imitation is looked for, the truth among them."""
TRIED: Final = 256
"""Random ones, of which these are the nearest."""
EDGE: Final = 1e-6
STEP: Final = 1e-3


def unlike_any(board: Board, truth: Mapping[str, Any], rng: np.random.Generator) -> float:
    """Return how many standard errors the causes of a study are from the base model anywhere.

    Between what the emulators expect at the truth and what the base model expects at the
    parameters that come nearest to it, in errors of measurement and emulator at the truth. No
    luck is in it, and no measured value.

    Parameters
    ----------
    board : Board
    truth : mapping
        As `calibrate.challenge.truths.Truth.plain` gives it.
    rng : Generator

    Returns
    -------
    float
        0 where nothing of it was measured; nan where something is foreign, which no emulator knows.
    """
    known = {one.name: one for one in board.candidates}
    if truth["kind"] == "foreign":
        return float("nan")
    on: dict[int, dict[int, float]] = {}
    for hidden in truth["hidden"]:
        candidate = known.get(hidden["name"])
        if candidate is None:
            continue
        for k, column in candidate.acts:
            on.setdefault(k, {})[column] = hidden["strength"] / candidate.scale
    space = board.problem.space
    true = np.array([[truth["values"].get(name, 0.0) for name in space.names]])
    places = board.problem.places
    told = [_told(place, true, on.get(k, {})) for k, place in enumerate(places)]
    targets = [_scatter(place, one) for place, one in zip(places, told, strict=True)]
    whiten = [np.linalg.inv(np.linalg.cholesky(covariance)).T for _, covariance in targets]
    free = [k for k, one in enumerate(space.unknowns) if one.prior.bounded]

    def misfit(units: Array) -> Array:
        """Return what is left, (n, L), at parameters on their unit ranges (n, d)."""
        at = np.repeat(true, len(units), axis=0)
        for k, x in zip(free, units.T, strict=True):
            prior = space.priors[k]
            at[:, k] = from_unit(x, prior.low, prior.high, prior.spacing)
        rest = [
            (_told(place, at, {}).mean[:, _columns(place)] - mean) @ root
            for place, (mean, _), root in zip(places, targets, whiten, strict=True)
        ]
        return np.concatenate(rest, axis=1)

    start = np.clip(space.units(true)[0, free], EDGE, 1.0 - EDGE)
    return float(np.sqrt(min(_least(misfit, one) for one in _starts(misfit, start, rng))))


def _starts(misfit: Misfit, true: Array, rng: np.random.Generator) -> list[Array]:
    """Return the truth and the random parameters that come nearest."""
    tried = rng.uniform(EDGE, 1.0 - EDGE, (TRIED, len(true)))
    nearest = np.argsort(np.sum(misfit(tried) ** 2, axis=1), kind="stable")[: STARTS - 1]
    return [true, *tried[nearest]]


def _least(misfit: Misfit, start: Array) -> float:
    """Return the least sum of squares that is found from a start."""

    def slopes(u: Array) -> Array:
        step = np.where(u < 0.5, STEP, -STEP)
        rows = misfit(np.vstack([u, u + np.diag(step)]))
        return np.asarray(((rows[1:] - rows[0]) / step[:, None]).T)

    found = optimize.least_squares(
        lambda u: misfit(u[None])[0], start, jac=slopes, bounds=(0.0, 1.0), max_nfev=40
    )
    return 2.0 * float(found.cost)


def _columns(place: Place) -> Array:
    return np.concatenate([np.arange(r.columns.start, r.columns.stop) for r in place.readings])


def _told(place: Place, values: Array, on: Mapping[int, float]) -> Prediction:
    """Return what the emulator of a place expects where some causes act."""
    known = place.inputs(values)
    strengths = known.strengths.copy()
    for column, x in on.items():
        strengths[:, column] = x
    return place.emulator.predict(Inputs(known.u, strengths, known.seeds))


def _scatter(place: Place, told: Prediction) -> tuple[Array, Array]:
    """Return what the readings of a place are expected to be (L,), and their covariance (L, L)."""
    columns = _columns(place)
    factors = told.factors[0][columns]
    covariance = np.diag(told.variance[0][columns]) + factors @ factors.T
    row = 0
    for reading in place.readings:
        mine = slice(row, row + len(reading.y))
        covariance[mine, mine] += reading.covariance
        if reading.extra is not None:
            covariance[mine, mine] += reading.extra @ reading.extra.T
        row = mine.stop
    return told.mean[0][columns], covariance
