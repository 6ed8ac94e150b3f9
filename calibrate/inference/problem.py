"""What is to be explained: unknowns, places with an emulator each, and what was measured there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.emulator.types import Emulator, Inputs, Prediction
from calibrate.errors import CalibrationError
from calibrate.inference.priors import Spacing, to_unit
from calibrate.inference.space import Space

__all__ = ["Discrepancy", "Known", "Place", "Problem", "Reading", "Source", "together_as_runs"]

ALONE: Final = 0.005
"""Part of the squared error of a level that is its own, whatever the runs say: reading it off. With
0.02 curves that a laboratory of runs measures are less certain than they are, by 0.3 nats each."""


@dataclass(frozen=True)
class Source:
    """Where an input of an emulator comes from: an unknown or a number.

    Attributes
    ----------
    index : int or None
        Column of the values; None for a number.
    value : float
        The number, in the unit of the range.
    low, high : float
        Range that the emulator calls [0, 1]. As it is by default, for strengths of effects.
    spacing : {"linear", "log"}
    """

    index: int | None = None
    value: float = 0.0
    low: float = 0.0
    high: float = 1.0
    spacing: Spacing = "linear"

    def of(self, values: Array) -> Array:
        """Return the input, (n,), for values (n, K)."""
        raw = np.full(len(values), self.value) if self.index is None else values[:, self.index]
        return to_unit(raw, self.low, self.high, self.spacing)


@dataclass(frozen=True, eq=False)
class Discrepancy:
    """Chance that the simulation misses a reading for a reason that is not in it, and by how much.

    Attributes
    ----------
    chance : float
        Probability before the data, above 0 and below 1.
    loading : (L,) float64
        Ordinary size of the discrepancy, on the model scale; `likelihood.SIZES` has its tails.
    """

    chance: float
    loading: Array


@dataclass(frozen=True, eq=False)
class Reading:
    """One measured target, a number or a curve, on the model scale.

    Attributes
    ----------
    name : str
    columns : slice
        Columns of its place's emulator.
    y, se : (L,) float64
        Measured mean and its standard error.
    repeats : int
        Measurements behind mean and error; their scatter tells the error with repeats - 1 degrees
        of freedom. 0: unknown, the error is taken as known.
    shared : tuple of (int, (L,) float64)
        Errors in common with other readings: column of the unit-normal nuisance, and what one
        standard deviation of it adds to the reading. Exact also for a common covariance B B'.
    extra : (L, F) float64 or None
        More uncertainty of its own: adds extra extra' to the covariance.
    discrepancy : Discrepancy or None
        Whether the model may be wrong about it. None: it holds without doubt.
    levels : tuple of float
        At which a curve was read, for words; empty for a number.
    together : (L, L) float64 or None
        How the errors of the levels go together, as a correlation. None: each by itself.

    Raises
    ------
    CalibrationError
        If lengths differ, a number is missing, an error is not above 0 or there is one repeat.
    """

    name: str
    columns: slice
    y: Array
    se: Array
    repeats: int = 0
    shared: tuple[tuple[int, Array], ...] = ()
    extra: Array | None = None
    discrepancy: Discrepancy | None = None
    levels: tuple[float, ...] = ()
    together: Array | None = None

    @property
    def covariance(self) -> Array:
        """Covariance of the errors of measurement, (L, L)."""
        if self.together is None:
            return np.diag(self.se**2)
        return np.asarray(self.se[:, None] * self.together * self.se)

    @cached_property
    def root(self) -> Array:
        """Lower Cholesky factor of the covariance, (L, L)."""
        return np.asarray(np.linalg.cholesky(self.covariance))

    def standard(self, difference: Array) -> Array:
        """Return differences (..., L) as independent numbers of unit variance."""
        if self.together is None:
            return np.asarray(difference / self.se)
        return np.asarray(difference @ np.linalg.inv(self.root).T)

    def __post_init__(self) -> None:
        """Check what everything behind relies on."""
        y, se = np.asarray(self.y, dtype=float), np.asarray(self.se, dtype=float)
        count = self.columns.stop - self.columns.start
        if y.shape != (count,) or se.shape != (count,):
            msg = f"reading '{self.name}': {y.shape} values, {se.shape} errors for {count} levels"
            raise CalibrationError(msg)
        if not (np.isfinite(y).all() and np.isfinite(se).all() and (se > 0.0).all()):
            msg = f"reading '{self.name}': every value needs a standard error above 0"
            raise CalibrationError(msg)
        if self.repeats == 1 or self.repeats < 0:
            msg = (
                f"reading '{self.name}': {self.repeats} repeats tell no scatter; give at least 2, "
                "or 0 where the error is known otherwise"
            )
            raise CalibrationError(msg)


def together_as_runs(reading: Reading, emulator: Emulator) -> Reading:
    """Return a curve whose errors go together from level to level as far as luck explains them.

    What makes one measured curve differ from the next is what makes one run differ from another:
    grains that lie otherwise. As much of a level's squared error as a single run scatters goes
    together as that does; what is more is the level's own. Who states an error that all levels of
    one curve share has said how they go together.

    Parameters
    ----------
    reading : Reading
    emulator : Emulator
        One that knows how single runs scatter has a method ``luck``.
    """
    if len(reading.y) == 1 or reading.extra is not None or not hasattr(emulator, "luck"):
        return reading
    luck = emulator.luck(reading.columns)
    size = np.sqrt(np.diag(luck))
    explained = np.minimum(size / reading.se, 1.0)
    scale = np.where(size > 0.0, size, 1.0)
    alike = luck / scale[:, None] / scale
    together = (1.0 - ALONE) * explained[:, None] * alike * explained
    together[np.diag_indices_from(together)] = 1.0
    return replace(reading, together=together)


@dataclass(frozen=True)
class Known:
    """An independent measurement of an unknown.

    Attributes
    ----------
    index : int
        Column of the values.
    value, se : float
        In the unknown's unit.
    """

    index: int
    value: float
    se: float


@dataclass(frozen=True, eq=False)
class Place:
    """One experiment on one kind of surface with one material, and what was read there.

    Attributes
    ----------
    name : str
    emulator : Emulator
    u, strengths : tuple of Source
        Inputs of the emulator, in its order.
    readings : tuple of Reading
    experiment : str
        What is done there; the same at other places with other walls or materials.
    """

    name: str
    emulator: Emulator
    u: tuple[Source, ...]
    strengths: tuple[Source, ...]
    readings: tuple[Reading, ...]
    experiment: str = ""

    def predict(self, values: Array) -> Prediction:
        """Return what the emulator expects for values (n, K)."""
        return self.emulator.predict(self.inputs(values))

    def inputs(self, values: Array, on: Mapping[int, float] | None = None) -> Inputs:
        """Return the inputs of the emulator.

        Parameters
        ----------
        values : (n, K) float64
        on : mapping, optional
            Strengths of what acts besides, by column of the strengths.
        """
        n = len(values)
        columns = [
            np.column_stack([s.of(values) for s in group]) if group else np.zeros((n, 0))
            for group in (self.u, self.strengths)
        ]
        for column, strength in (on or {}).items():
            columns[1][:, column] = strength
        return Inputs(columns[0], columns[1], np.full(n, np.nan))

    @property
    def indices(self) -> tuple[int, ...]:
        """Columns of the values that matter here."""
        sources = {s.index for s in (*self.u, *self.strengths) if s.index is not None}
        shared = {index for reading in self.readings for index, _ in reading.shared}
        return tuple(sorted(sources | shared))


@dataclass(frozen=True, eq=False)
class Problem:
    """Unknowns and data; `calibrate.inference.likelihood` says how probable the data are.

    Attributes
    ----------
    space : Space
    places : tuple of Place
    known : tuple of Known
    """

    space: Space
    places: tuple[Place, ...]
    known: tuple[Known, ...] = field(default=())

    @property
    def readings(self) -> tuple[Reading, ...]:
        """All readings, place by place."""
        return tuple(reading for place in self.places for reading in place.readings)
