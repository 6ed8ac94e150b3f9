"""The motion of a plate from a measured profile: period, amplitudes, phases, what remains.

The plate's way is x(t) = sum over k of A_k cos(2 pi k t / T + phi_k), whichever of position and
acceleration was measured; the clock starts so that phi_1 is a quarter of a turn.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.errors import CalibrationError
from calibrate.laboratory.instrument.quantities import ACCELERATION, POSITION, Quantity
from calibrate.laboratory.instrument.series import Form, Series, read_series
from calibrate.laboratory.motion.choice import most_harmonics, prediction_errors, worth_keeping
from calibrate.laboratory.motion.harmonics import Fit, best_period, covariance, refined
from liggghts_io.experiments.plate_motion import HARMONICS

__all__ = ["MOST_HARMONICS", "PlateMotion", "plate_motion_in"]

MOST_HARMONICS: Final = 30
"""Cosines that LIGGGHTS takes."""
_LEAST_READINGS: Final = 16
_LEAST_PERIODS_FOUND: Final = 1.9
_LEAST_PERIODS_GIVEN: Final = 0.95
_NOTHING_FOUND: Final = 0.7
"""Part of the readings' scatter that remains where there is no motion of that period."""
_STILL: Final = 1e-12
_SMALL: Final = 1e-6
"""Part of a number by which it is changed to see what follows from it."""


@dataclass(frozen=True)
class PlateMotion:
    """A fitted motion; arrays have shape (K,) unless said otherwise.

    Attributes
    ----------
    path : Path
    quantity : Quantity
        Position or acceleration, as measured.
    time_s, measured : (n,) ndarray
        Readings, in m or m/s2 along the way of the grains.
    fit : Fit
        Of the readings.
    period_s, period_se_s : float
        The error is zero where the period was given.
    amplitudes_m, phases_rad : ndarray
        Of the plate's way.
    amplitudes_se_m, phases_se_rad : ndarray
    errors : (K_tried, 10) ndarray
        Mean squares by which pieces of the record are missed, for each number of harmonics.
    worth : int
        Number of harmonics worth keeping.
    """

    path: Path
    quantity: Quantity
    time_s: Array
    measured: Array
    fit: Fit
    period_s: float
    period_se_s: float
    amplitudes_m: Array
    phases_rad: Array
    amplitudes_se_m: Array
    phases_se_rad: Array
    errors: Array
    worth: int

    @property
    def harmonics(self) -> int:
        """Number of cosines."""
        return len(self.amplitudes_m)

    @property
    def share(self) -> float:
        """What remains, as a part of the root mean square of the motion."""
        return self.fit.rms / float(np.sqrt(np.mean(self.fit.motion(self.time_s) ** 2)))

    @property
    def start_s(self) -> float:
        """When the clock of the phases starts, as the record counts."""
        first = _phasors(self.fit, self.quantity)[0]
        rate = 2.0 * np.pi / self.period_s
        return self.fit.origin_s + float(0.5 * np.pi - np.angle(first)) / rate

    def position(self, time: Array) -> Array:
        """Return the plate's way at times of its own clock [m], the mean taken off."""
        return np.asarray(np.cos(self._angles(time)) @ self.amplitudes_m)

    def acceleration(self, time: Array) -> Array:
        """Return the plate's acceleration at times of its own clock [m/s2]."""
        rates = 2.0 * np.pi * np.arange(1, self.harmonics + 1) / self.period_s
        return np.asarray(-np.cos(self._angles(time)) @ (self.amplitudes_m * rates**2))

    def _angles(self, time: Array) -> Array:
        orders = np.arange(1, self.harmonics + 1)
        return np.multiply.outer(2.0 * np.pi * time / self.period_s, orders) + self.phases_rad


def plate_motion_in(
    path: Path, form: Form, *, period_s: float = 0.0, harmonics: int = 0, reverse: bool = False
) -> PlateMotion:
    """Read a profile and fit a sum of cosines to it.

    Parameters
    ----------
    path : Path
        CSV file with columns of time and of position or acceleration.
    form : Form
    period_s : float
        Zero: it is found.
    harmonics : int
        Zero: as many as are worth keeping.
    reverse : bool
        Whether the sensor points against the way of the grains.

    Raises
    ------
    CalibrationError
        With file, line, value and remedy.
    """
    series = read_series(path, [POSITION, ACCELERATION], form)
    time, values = series.time_s, series.values * (-1.0 if reverse else 1.0)
    _check(series, values)
    found = period_s or best_period(time, values, HARMONICS)
    _check_length(series, found, given=bool(period_s))
    most = most_harmonics(time, found, max(harmonics, HARMONICS))
    if harmonics > most:
        msg = f"--harmonics {harmonics}: {len(time)} readings tell {most} at most; give fewer"
        raise CalibrationError(msg)
    if not period_s:
        found = refined(time, values, found, most).period_s
    errors = prediction_errors(time, values, found, most)
    worth = worth_keeping(errors)
    fit = refined(time, values, found, harmonics or worth, free=not period_s)
    left = values - fit.slow(time)
    if fit.rms > _NOTHING_FOUND * float(np.sqrt(np.mean(left**2))):
        msg = (
            f"{path}: shows no motion with a period of {fit.period_s:.4g} s; give the period with "
            "--period, or check the column"
        )
        raise CalibrationError(msg)
    return _motion(series, values, fit, errors, worth, given=bool(period_s))


def _check(series: Series, values: Array) -> None:
    if (count := len(np.unique(series.time_s))) < _LEAST_READINGS:
        msg = (
            f"{series.path}: readings at {count} different times; at least {_LEAST_READINGS} are "
            "needed: record faster"
        )
        raise CalibrationError(msg)
    if float(np.ptp(values)) <= _STILL * max(1.0, float(np.abs(values).max())):
        msg = (
            f"{series.path}: the {series.quantity.name} does not change; is this the right column?"
        )
        raise CalibrationError(msg)


def _check_length(series: Series, period_s: float, *, given: bool) -> None:
    periods = float(series.time_s[-1] - series.time_s[0]) / period_s
    if given and periods < _LEAST_PERIODS_GIVEN:
        msg = f"--period {period_s:g}s: the record holds {periods:.2g} of them; record at least one"
        raise CalibrationError(msg)
    if not given and periods < _LEAST_PERIODS_FOUND:
        msg = (
            f"{series.path}: holds {periods:.2g} periods of {period_s:.3g} s; to find a period, "
            "record two or more, or give it with --period"
        )
        raise CalibrationError(msg)


def _motion(
    series: Series, values: Array, fit: Fit, errors: Array, worth: int, *, given: bool
) -> PlateMotion:
    """Return the fit as amplitudes and phases of the plate's way, with their errors."""
    numbers = np.concatenate([[fit.period_s], fit.cosines, fit.sines])
    known = covariance(series.time_s, fit, free=not given)
    base = _way(numbers, series.quantity)
    columns = []
    for k, number in enumerate(numbers):
        step = _SMALL * max(abs(number), float(np.abs(numbers[1:]).max()) if k else 0.0)
        moved = numbers.copy()
        moved[k] += step
        change = _way(moved, series.quantity) - base
        change[1] = np.angle(np.exp(1j * change[1]))
        columns.append(change.ravel() / step)
    towards = np.stack(columns, axis=1)
    se = np.sqrt(np.maximum(np.diag(towards @ known @ towards.T), 0.0)).reshape(base.shape)
    return PlateMotion(
        path=series.path,
        quantity=series.quantity,
        time_s=series.time_s,
        measured=values,
        fit=fit,
        period_s=fit.period_s,
        period_se_s=float(np.sqrt(known[0, 0])),
        amplitudes_m=base[0],
        phases_rad=base[1],
        amplitudes_se_m=se[0],
        phases_se_rad=se[1],
        errors=errors,
        worth=worth,
    )


def _phasors(fit: Fit, quantity: Quantity) -> Array:
    """Return the complex amplitudes of the plate's way, at the origin of a fit."""
    phasors = fit.cosines - 1j * fit.sines
    if quantity.name == ACCELERATION.name:
        orders = np.arange(1, len(phasors) + 1)
        phasors = -phasors / (2.0 * np.pi * orders / fit.period_s) ** 2
    return np.asarray(phasors)


def _way(numbers: Array, quantity: Quantity) -> Array:
    """Return amplitudes and phases of the plate's way, (2, K), from period, cosines and sines.

    The clock starts where the first harmonic has a quarter of a turn.
    """
    count = (len(numbers) - 1) // 2
    cosines, sines = numbers[1 : 1 + count], numbers[1 + count :]
    fit = Fit(float(numbers[0]), 0.0, cosines, sines, np.zeros(1), 1.0, np.zeros(1))
    phasors = _phasors(fit, quantity)
    orders = np.arange(1, count + 1)
    turned = np.angle(phasors) + orders * (0.5 * np.pi - np.angle(phasors[0]))
    phases = np.angle(np.exp(1j * turned))
    phases[0] = 0.5 * np.pi
    return np.stack([np.abs(phasors), phases])
