"""Measured against simulated, reading by reading, with every variance counted."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
import pandas as pd

from calibrate.arrays import Array
from calibrate.causes.hypotheses import Board, Weighed, weigh_hypothesis
from calibrate.inference.problem import Place, Reading
from calibrate.scales import Scale, backward, slope

__all__ = ["Residual", "predicted", "residual_table", "residuals", "without"]


@dataclass(frozen=True)
class Residual:
    """One measured value; a curve has one row per level.

    Attributes
    ----------
    name : str
        Reading; ``NAME@K`` for level K of a curve, counted from 0.
    place : str
    measured, simulated : float
        In the observable's unit; simulated at the most probable values.
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


def without(board: Board, place: int, reading: int | None = None) -> Board:
    """Return the board without one reading, or without all readings of a place."""
    places = list(board.problem.places)
    kept = tuple(
        one for k, one in enumerate(places[place].readings) if reading is not None and k != reading
    )
    places[place] = replace(places[place], readings=kept)
    return replace(board, problem=replace(board.problem, places=tuple(places)))


def predicted(place: Place, reading: Reading, samples: Array) -> tuple[Array, Array]:
    """Return mean and variance of a reading's expected values over posterior samples, (L,) each.

    The variance holds that of the emulator; the error of measurement is not in it.
    """
    own = place.predict(samples).columns(reading.columns)
    mean = own.mean.copy()
    for index, loading in reading.shared:
        mean += samples[:, [index]] * loading
    extra = 0.0 if reading.extra is None else np.sum(reading.extra**2, axis=1)
    return mean.mean(axis=0), mean.var(axis=0) + own.total.mean(axis=0) + extra


def residuals(
    weighed: Weighed, seed: int, scales: Mapping[str, Scale] | None = None
) -> tuple[Residual, ...]:
    """Return the residuals of a hypothesis.

    Parameters
    ----------
    weighed : Weighed
    seed : int
        Of the inferences that leave one reading out.
    scales : mapping, optional
        Reading to the scale of its numbers; they are given as they are by default.
    """
    rows: list[Residual] = []
    board, names = weighed.hypothesis.board, weighed.hypothesis.names
    for k, place in enumerate(weighed.problem.places):
        for i, reading in enumerate(place.readings):
            rest = weigh_hypothesis(without(board, k, i).hypothesis(*names), seed, weighed)
            here = predicted(place, reading, weighed.best[None])
            out = predicted(place, reading, rest.samples)
            scale = (scales or {}).get(reading.name, "linear")
            rows += _rows(place, reading, here, out, scale)
    return tuple(rows)


def _rows(
    place: Place,
    reading: Reading,
    here: tuple[Array, Array],
    out: tuple[Array, Array],
    scale: Scale,
) -> list[Residual]:
    z = (reading.y - here[0]) / np.sqrt(here[1] + reading.se**2)
    z_out = (reading.y - out[0]) / np.sqrt(out[1] + reading.se**2)
    measured, simulated = backward(scale, reading.y), backward(scale, here[0])
    many = len(reading.y) > 1
    return [
        Residual(
            f"{reading.name}@{k}" if many else reading.name,
            place.name,
            float(measured[k]),
            float(simulated[k]),
            float(reading.se[k]) / slope(scale, float(measured[k])),
            float(np.sqrt(here[1][k])) / slope(scale, float(simulated[k])),
            float(z[k]),
            float(z_out[k]),
        )
        for k in range(len(reading.y))
    ]


def residual_table(rows: Sequence[Residual]) -> pd.DataFrame:
    """Return residuals as a table, indexed by name."""
    columns = [one.name for one in fields(Residual)]
    return pd.DataFrame([vars(one) for one in rows], columns=columns).set_index("name")
