"""Measured against simulated, reading by reading, and how far each lies from what the rest says."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields

import numpy as np
import pandas as pd

from calibrate.arrays import Array
from calibrate.causes.left_out import views, views_without
from calibrate.causes.weighing.evidences import Evidences
from calibrate.inference.problem import Reading
from calibrate.scales import Scale, backward, slope

__all__ = [
    "Group",
    "Residual",
    "groups_left_out",
    "residual_table",
    "residuals",
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
    places = [p.name for p in found.board.problem.places for _ in p.readings]
    rows = np.flatnonzero(one.weights > FEW)
    share = one.weights[rows] / one.weights[rows].sum()
    table: list[Residual] = []
    for k, view in enumerate(views(found, one, rows)):
        (unseen,) = views_without(found, names, (k,))
        scale = (scales or {}).get(view.reading.name, "linear")
        table += _rows(places[k], view.reading, view.told(share), unseen.told(), scale)
    return tuple(table)


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
    rows_of = []
    for (kind, name), which in groups.items():
        squares = []
        for view in views_without(found, (), which):
            mean, own, spread = view.told()
            reading = view.reading
            squares.append(np.mean((reading.y - mean) ** 2 / (own + spread + reading.se**2)))
        rows_of.append(Group(kind, name, float(np.sqrt(np.mean(squares)))))
    return rows_of


def residual_table(rows: Sequence[Residual]) -> pd.DataFrame:
    """Return residuals as a table, indexed by name."""
    columns = [one.name for one in fields(Residual)]
    return pd.DataFrame([vars(one) for one in rows], columns=columns).set_index("name")
