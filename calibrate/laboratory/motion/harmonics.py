"""A sum of cosines on a slow drift, fitted to readings of any spacing by least squares.

    y(t) = sum over k of (c_k cos(2 pi k t / T) + s_k sin(2 pi k t / T)) + a polynomial in t

The polynomial takes up gravity, the mounting of a sensor and its drift. For a given period T all
else is linear; the period is then the only unknown.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from calibrate.arrays import Array

__all__ = ["Fit", "best_period", "covariance", "fit_at", "highest_frequency", "refined"]

_PERIODS_PER_ORDER: Final = 2.0
"""Periods that a record has to hold for each order of its drift; else drift and motion are one."""
_MOST_ORDER: Final = 3
_SHORTER: Final = 1.25
"""Times the least remaining error that a shorter period may leave: twice a period fits as well."""
_MOST_READINGS: Final = 1000
"""Readings with which periods are tried; the last step takes all."""
_PARTS: Final = (1, 2, 3, 4)
"""The loudest line of an acceleration may be any of these harmonics."""
_PEAKS: Final = 3
_EXACT: Final = 1e-3
"""Part of the readings' scatter that no longer tells one period from another."""
_ITERATIONS: Final = 30
_CLOSE: Final = 1e-7
"""Part of the period below which it is not changed any more."""


@dataclass(frozen=True)
class Fit:
    """A sum of cosines fitted to readings.

    Attributes
    ----------
    period_s : float
    origin_s : float
        Time from which phases count.
    cosines, sines : (K,) ndarray
        Coefficients of the harmonics 1 to K.
    drift : (m,) ndarray
        Polynomial in the time since the origin in units of the record, lowest order first.
    span_s : float
        Length of the record.
    residual : (n,) ndarray
        Readings less the fit.
    """

    period_s: float
    origin_s: float
    cosines: Array
    sines: Array
    drift: Array
    span_s: float
    residual: Array

    @property
    def rms(self) -> float:
        """Root mean square of what remains, counted with the numbers that were fitted."""
        left = max(1, len(self.residual) - 2 * len(self.cosines) - len(self.drift) - 1)
        return float(np.sqrt(np.sum(self.residual**2) / left))

    def motion(self, time: Array) -> Array:
        """Return the periodic part at some times."""
        turns = _turns(time - self.origin_s, self.period_s, len(self.cosines))
        return np.asarray(np.cos(turns) @ self.cosines + np.sin(turns) @ self.sines)

    def slow(self, time: Array) -> Array:
        """Return offset and drift at some times."""
        powers = np.vander((time - self.origin_s) / self.span_s, len(self.drift), increasing=True)
        return np.asarray(powers @ self.drift)


def _drift_order(span_s: float, period_s: float) -> int:
    """Return the order of the polynomial that a record of some periods can tell from motion."""
    return int(min(_MOST_ORDER, span_s / period_s / _PERIODS_PER_ORDER))


def fit_at(time: Array, values: Array, period_s: float, harmonics: int) -> Fit:
    """Fit a sum of cosines of a given period.

    Parameters
    ----------
    time, values : (n,) float64
    period_s : float
    harmonics : int
    """
    origin, span = float(time[0]), float(time[-1] - time[0])
    matrix = _columns(time - origin, span, period_s, harmonics)
    found, *_ = np.linalg.lstsq(matrix, values, rcond=None)
    residual = values - matrix @ found
    cosines, sines = found[:harmonics], found[harmonics : 2 * harmonics]
    return Fit(period_s, origin, cosines, sines, found[2 * harmonics :], span, residual)


def _turns(since: Array, period_s: float, harmonics: int) -> Array:
    """Return the angle of each harmonic at some times, (n, K)."""
    return np.asarray(
        np.multiply.outer(2.0 * np.pi * since / period_s, np.arange(1, harmonics + 1))
    )


def _columns(since: Array, span: float, period_s: float, harmonics: int) -> Array:
    turns = _turns(since, period_s, harmonics)
    powers = np.vander(since / span, _drift_order(span, period_s) + 1, increasing=True)
    return np.concatenate([np.cos(turns), np.sin(turns), powers], axis=1)


def best_period(time: Array, values: Array, harmonics: int) -> float:
    """Return the shortest period that explains readings as well as any.

    The loudest lines of the spectrum may be harmonics of the motion, so that their multiples are
    tried, each with the cosines up to one common frequency; around each the period is refined.

    Parameters
    ----------
    time, values : (n,) float64
    harmonics : int
        Of the loudest line, up to which cosines are fitted.
    """
    rng = np.random.default_rng(len(time))  # of no consequence but for records above the limit
    some = np.sort(rng.permutation(len(time))[:_MOST_READINGS])
    at, seen = time[some], values[some]
    span = float(time[-1] - time[0])
    tried: list[Fit] = []
    lines = _loudest(time, values)
    for line in lines:
        highest = min(harmonics * line, highest_frequency(time))
        for part in _PARTS:
            count = int(highest * part / line)
            room = len(at) > 4 * count + 2 * _MOST_ORDER
            if part / line < span and room and count > 0:
                tried.append(_scanned(at, seen, part / line, part, count))
    tried.sort(key=lambda fit: fit.period_s)
    least = max(min(fit.rms for fit in tried), _EXACT * float(np.std(seen)))
    return next(fit.period_s for fit in tried if fit.rms <= _SHORTER * least)


def highest_frequency(time: Array) -> float:
    """Return the frequency up to which readings tell cosines apart."""
    return 0.45 / float(np.median(np.diff(time)))


def _loudest(time: Array, values: Array) -> list[float]:
    """Return the loudest frequencies of readings that were put on an even grid."""
    span = float(time[-1] - time[0])
    count = int(min(2**16, 2 ** np.ceil(np.log2(span / np.median(np.diff(time)) + 1.0))))
    even = np.linspace(time[0], time[-1], max(count, 16))
    level = np.interp(even, time, values)
    slow = np.polynomial.polynomial.Polynomial.fit(even, level, 1)
    padded = 8 * len(even)
    power = np.abs(np.fft.rfft(level - slow(even), padded)) ** 2
    frequencies = np.fft.rfftfreq(padded, even[1] - even[0])
    power[frequencies < 0.8 / span] = 0.0
    found: list[float] = []
    for _ in range(_PEAKS):
        k = int(np.argmax(power))
        if power[k] <= 0.0:
            break
        found.append(float(frequencies[k]))
        power[np.abs(frequencies - frequencies[k]) < 1.0 / span] = 0.0
    return found


def _scanned(time: Array, values: Array, period_s: float, part: int, harmonics: int) -> Fit:
    """Return the best fit with a period near a given one, whose `part`-th harmonic is loud.

    The more harmonics, the sharper the period and the nearer it has to be known before.
    """
    count = min(part, harmonics)
    fit = refined(time, values, period_s, count)
    while count < harmonics:
        count = min(2 * count, harmonics)
        fit = refined(time, values, fit.period_s, count)
    return fit


def refined(
    time: Array, values: Array, period_s: float, harmonics: int, *, free: bool = True
) -> Fit:
    """Return the fit whose period is that of least squares, by Gauss-Newton from a near one.

    Parameters
    ----------
    time, values : (n,) float64
    period_s : float
    harmonics : int
    free : bool
        Whether the period may change.
    """
    fit = fit_at(time, values, period_s, harmonics)
    for _ in range(_ITERATIONS if free else 0):
        change = _step(time, fit)
        while abs(change) > _CLOSE * fit.period_s:
            better = fit_at(time, values, fit.period_s + change, harmonics)
            if np.sum(better.residual**2) <= np.sum(fit.residual**2):
                break
            change *= 0.5
        if abs(change) <= _CLOSE * fit.period_s:
            break
        fit = better
    return fit


def _step(time: Array, fit: Fit) -> float:
    """Return by how much the period is to change, all coefficients changing with it."""
    matrix = np.concatenate([_period_column(time, fit), _matrix(time, fit)], axis=1)
    found, *_ = np.linalg.lstsq(matrix, fit.residual, rcond=None)
    limit = 0.1 * fit.period_s
    return float(np.clip(found[0], -limit, limit))


def _matrix(time: Array, fit: Fit) -> Array:
    return _columns(time - fit.origin_s, fit.span_s, fit.period_s, len(fit.cosines))


def _period_column(time: Array, fit: Fit) -> Array:
    """Return the derivative of a fit by its period, (n, 1)."""
    turns = _turns(time - fit.origin_s, fit.period_s, len(fit.cosines))
    by_turn = turns * (np.sin(turns) * fit.cosines - np.cos(turns) * fit.sines)
    return np.asarray(np.sum(by_turn, axis=1, keepdims=True) / fit.period_s)


def covariance(time: Array, fit: Fit, *, free: bool) -> Array:
    """Return the covariance of period, cosines and sines, (2 K + 1, 2 K + 1).

    Neighbouring readings whose remainders agree count less than one each.

    Parameters
    ----------
    time : (n,) float64
    fit : Fit
    free : bool
        Whether the period was fitted; else it has no error.
    """
    by_period = _period_column(time, fit) * float(free)
    matrix = np.concatenate([by_period, _matrix(time, fit)], axis=1)
    total = float(fit.residual @ fit.residual)
    follows = max(0.0, float(fit.residual[1:] @ fit.residual[:-1]) / total) if total > 0.0 else 0.0
    inflated = fit.rms**2 * (1.0 + follows) / max(1.0 - follows, 1.0 / len(time))
    length = np.linalg.norm(matrix, axis=0)
    scale = np.where(length > 0.0, length, 1.0)
    inverse = np.linalg.pinv(matrix / scale)
    count = 2 * len(fit.cosines) + 1
    return np.asarray(inflated * (inverse @ inverse.T / np.outer(scale, scale))[:count, :count])
