"""Measured against simulated, reading by reading, and how far each lies from what the rest says."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, fields

import numpy as np
import pandas as pd
from scipy import special

from calibrate.arrays import Array
from calibrate.causes.weighing.evidences import Evidences
from calibrate.causes.weighing.hypotheses import Weighed
from calibrate.causes.weighing.switched import predicted_at
from calibrate.emulator.types import Prediction
from calibrate.inference.problem import Reading
from calibrate.scales import Scale, backward, slope

__all__ = [
    "Group",
    "Residual",
    "View",
    "groups_left_out",
    "residual_table",
    "residuals",
    "views",
]


@dataclass(frozen=True)
class Residual:
    """One measured value; a curve has one row per level.

    Attributes
    ----------
    name : str
        Reading; ``NAME at X`` for a level of a curve.
    place : str
    measured, simulated : float
        In the observable's unit; simulated is the mean over the posterior.
    measured_sd, simulated_sd : float
        Standard errors in the same unit; the second is the emulator's.
    z : float
        Measured minus simulated over both errors.
    z_left_out : float
        The same when this reading had no part in the inference: how far it lies from what all
        others predict, the uncertainty of the parameters counted.
    """

    name: str
    place: str
    measured: float
    simulated: float
    measured_sd: float
    simulated_sd: float
    z: float
    z_left_out: float


@dataclass(frozen=True)
class Group:
    """Readings that are left out together: an experiment, a material, a wall.

    Attributes
    ----------
    kind, name : str
    z : float
        Root mean square of their distances from what the others predict, in standard errors.
    """

    kind: str
    name: str
    z: float


@dataclass(frozen=True)
class View:
    """A reading as a hypothesis expects it at n draws.

    Attributes
    ----------
    reading : Reading
    mean, variance : (n, L) float64
        On the model scale; the variance is the emulator's.
    covariance : (L, L) float64
        Of one measurement about the mean, on average over the draws.
    """

    reading: Reading
    mean: Array
    variance: Array
    covariance: Array

    def told(self, weights: Array) -> tuple[Array, Array, Array]:
        """Return mean, variance of the emulator, and variance of the mean over draws, (L,) each."""
        mean = weights @ self.mean
        return mean, weights @ self.variance, weights @ (self.mean - mean) ** 2


def views(
    found: Evidences, one: Weighed, rows: Array, places: Collection[int] | None = None
) -> list[View]:
    """Return every reading, or those of some places, at some draws of a hypothesis."""
    told = []
    strengths = one.strengths[rows]
    values = found.cloud.bench.points[rows]
    members = found.board.members(one.names)
    for k, seen in enumerate(found.cloud.bench.seen):
        if places is not None and k not in places:
            continue
        prediction = predicted_at(seen.rows(rows), k, members, strengths)
        for reading in seen.place.readings:
            told.append(_viewed(reading, prediction, values))
    return told


def _viewed(reading: Reading, prediction: Prediction, values: Array) -> View:
    own = prediction.columns(reading.columns)
    mean = own.mean.copy()
    for index, loading in reading.shared:
        mean += values[:, [index]] * loading
    extra = np.zeros((len(reading.y), 0)) if reading.extra is None else reading.extra
    common = np.einsum("nlf,nmf->lm", own.factors, own.factors) / max(len(mean), 1)
    alone = np.diag(own.variance.mean(axis=0)) + reading.covariance
    covariance = alone + common + extra @ extra.T
    return View(reading, mean, own.total + np.sum(extra**2, axis=1), covariance)


def _without(one: Weighed, which: Sequence[int]) -> Array:
    """Return weights of the draws when some readings have no part, (n,)."""
    less = one.log_weight - one.terms[:, list(which)].sum(axis=1)
    return np.asarray(special.softmax(less))


FEW: float = 1e-6
"""Share of all weight below which a draw has no part."""


def residuals(
    found: Evidences, names: tuple[str, ...], scales: Mapping[str, Scale] | None = None
) -> tuple[Residual, ...]:
    """Return the residuals of a hypothesis.

    Parameters
    ----------
    found : Evidences
    names : tuple of str
        Of its members.
    scales : mapping, optional
        Reading to the scale of its numbers; they are given as they are by default.
    """
    one = found.weighed[names]
    readings = list(found.board.problem.readings)
    places = [p.name for p in found.board.problem.places for _ in p.readings]
    weights = [one.weights, *(_without(one, [k]) for k in range(len(readings)))]
    rows = np.flatnonzero(np.max(weights, axis=0) > FEW)
    seen = views(found, one, rows)
    table: list[Residual] = []
    for k, view in enumerate(seen):
        here, out = (view.told(_share(w[rows])) for w in (weights[0], weights[k + 1]))
        table += _rows(
            places[k], view.reading, here, out, (scales or {}).get(view.reading.name, "linear")
        )
    return tuple(table)


def _share(weights: Array) -> Array:
    return np.asarray(weights / weights.sum())


def _rows(
    place: str,
    reading: Reading,
    here: tuple[Array, Array, Array],
    out: tuple[Array, Array, Array],
    scale: Scale,
) -> list[Residual]:
    z = (reading.y - here[0]) / np.sqrt(here[1] + reading.se**2)
    z_out = (reading.y - out[0]) / np.sqrt(out[1] + out[2] + reading.se**2)
    measured, simulated = backward(scale, reading.y), backward(scale, here[0])
    levels = reading.levels or tuple(range(len(reading.y)))
    many = len(reading.y) > 1
    return [
        Residual(
            f"{reading.name} at {levels[k]:g}" if many else reading.name,
            place,
            float(measured[k]),
            float(simulated[k]),
            float(reading.se[k]) / slope(scale, float(measured[k])),
            float(np.sqrt(here[1][k])) / slope(scale, float(simulated[k])),
            float(z[k]),
            float(z_out[k]),
        )
        for k in range(len(reading.y))
    ]


def groups_left_out(
    found: Evidences, groups: Mapping[tuple[str, str], Sequence[int]]
) -> list[Group]:
    """Return how far readings that are left out together lie from what the others predict.

    Parameters
    ----------
    found : Evidences
    groups : mapping
        Kind and name to numbers of readings, place by place.
    """
    one, rows_of = found.base, []
    for (kind, name), which in groups.items():
        weights = _without(one, which)
        rows = np.flatnonzero(weights > FEW)
        seen = views(found, one, rows)
        squares = []
        for k in which:
            mean, own, spread = seen[k].told(_share(weights[rows]))
            reading = seen[k].reading
            squares.append(np.mean((reading.y - mean) ** 2 / (own + spread + reading.se**2)))
        rows_of.append(Group(kind, name, float(np.sqrt(np.mean(squares)))))
    return rows_of


def residual_table(rows: Sequence[Residual]) -> pd.DataFrame:
    """Return residuals as a table, indexed by name."""
    columns = [one.name for one in fields(Residual)]
    return pd.DataFrame([vars(one) for one in rows], columns=columns).set_index("name")
