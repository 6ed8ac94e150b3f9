"""A mass-time curve from the readings of a scale: tare, drift, onset, steady flow, plateau, times.

Onset is where the line of the steady flow, drawn back, meets the empty scale; the steady flow is
that between 20 and 80 % of the mass, the plateau the mass that lies there in the end. Between
readings that scatter the mass is taken as what cannot fall: the nearest rising curve.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from scipy.optimize import isotonic_regression

from calibrate.arrays import Array
from calibrate.errors import CalibrationError
from calibrate.laboratory.instrument.series import Series
from calibrate.laboratory.scale.base import Base, Rise, base_of, rise_of
from calibrate.laboratory.scale.clean import CleanLog
from calibrate.laboratory.scale.noise import Line, Noise, line_of, noise_about, rest_of
from calibrate.study.measured.curves import first_time

__all__ = ["Estimate", "MassCurve", "mass_curve"]

_STEADY: Final = (0.2, 0.8)
"""Part of the mass between which the flow is steady."""
_LEAST_STEADY: Final = 4
_FLAT: Final = 0.05
"""Part of the steady flow at which a scale that still gains is not at its plateau."""
_LEAST_SIGMAS: Final = 5.0
_UNIFORM: Final = 12.0
"""Variance of what is rounded to a step: the step squared over twelve."""
_CHERNOFF: Final = 0.513
"""Standard deviation of the limit of a rising fit (Groeneboom and Wellner 2001)."""
_BESIDE: Final = 0.05
"""Part of the mass on both sides of a level over which its slope is taken."""


@dataclass(frozen=True)
class Estimate:
    """A number with its standard error.

    Attributes
    ----------
    value, se : float
    """

    value: float
    se: float


@dataclass(frozen=True)
class MassCurve:
    """The mass on a scale over time, and what can be told from it; arrays have shape (n,).

    Attributes
    ----------
    path : Path
    time_s : ndarray
        Since the funnel was opened.
    mass_g : ndarray
        Readings without tare and drift.
    rising_g : ndarray
        The nearest curve that does not fall.
    onset_s, slope_g_s : Estimate
    plateau_g : Estimate, optional
        None where the log ends before.
    tare_g : Estimate
        What was taken off.
    drift_g_s : Estimate, optional
        None where the scale did not drift visibly.
    noise : Noise
        While the mass flows.
    base : Base
        The empty scale, as the log counts.
    tick_s, tick_g : float
        Steps in which times of readings are known, and in which masses are written.
    taken_out : mapping
        Rows that do not count, by reason.
    remarks : tuple of str
    """

    path: Path
    time_s: Array
    mass_g: Array
    rising_g: Array
    onset_s: Estimate
    slope_g_s: Estimate
    plateau_g: Estimate | None
    tare_g: Estimate
    drift_g_s: Estimate | None
    noise: Noise
    base: Base
    tick_s: float
    tick_g: float
    taken_out: Mapping[str, int]
    remarks: tuple[str, ...]

    def time_to(self, mass_g: float) -> Estimate:
        """Return the time until a mass lies on the scale [s].

        Raises
        ------
        CalibrationError
            When the log does not reach it, or it is lost in the scatter of the scale.
        """
        highest = float(self.rising_g[-1])
        if mass_g > highest:
            msg = (
                f"{self.path}: {highest:.4g} g lie on the scale at the end, and {mass_g:g} g are "
                "asked for; ask for less (--mass), or record longer"
            )
            raise CalibrationError(msg)
        scatter = math.sqrt(self.noise.between)
        if mass_g < _LEAST_SIGMAS * scatter:
            msg = (
                f"{self.path}: {mass_g:g} g are lost in the scatter of the scale ({scatter:.2g} g);"
                " ask for more (--mass)"
            )
            raise CalibrationError(msg)
        time = first_time(self.time_s, self.rising_g, mass_g)
        slope = self._slope_at(mass_g)
        variance = self._level_variance(slope) + self._gap_variance(time)
        variance += self.base.variance_at(time)
        return Estimate(time, math.sqrt(variance / slope**2 + self.tick_s**2 / _UNIFORM))

    def _slope_at(self, mass_g: float) -> float:
        """Return how fast the mass rises there [g/s]; at its ends not slower than a tenth."""
        beside = _BESIDE * float(self.rising_g[-1])
        low, high = max(mass_g - beside, 0.0), min(mass_g + beside, float(self.rising_g[-1]))
        ends = [first_time(self.time_s, self.rising_g, level) for level in (low, high)]
        least = 0.1 * self.slope_g_s.value
        return max((high - low) / (ends[1] - ends[0]), least) if ends[1] > ends[0] else least

    def _level_variance(self, slope: float) -> float:
        """Return the variance of the rising curve at a time [g2].

        Between dense readings that of a rising fit, n^(-1/3) with its constant; where readings are
        far apart, that of one of them.
        """
        one = self.noise.between
        apart = float(np.median(np.diff(self.time_s)))
        fitted = _CHERNOFF**2 * (4.0 * slope * one * apart) ** (2.0 / 3.0)
        return float(min(one, fitted)) + self.tick_g**2 / _UNIFORM

    def _gap_variance(self, time_s: float) -> float:
        """Return what the uneven flow may have done in a gap of the readings around a time [g2].

        A random walk between two ends that are known: its variance in the middle is a quarter of
        that over the whole gap.
        """
        after = int(np.clip(np.searchsorted(self.time_s, time_s), 1, len(self.time_s) - 1))
        gap = float(self.time_s[after] - self.time_s[after - 1])
        usual = float(np.median(np.diff(self.time_s)))
        return self.noise.walk * max(0.0, gap - usual) / 4.0


def mass_curve(series: Series, log: CleanLog, opened_s: float) -> MassCurve:
    """Return the mass-time curve in a log.

    Parameters
    ----------
    series : Series
        As it was read.
    log : CleanLog
        What counts of it.
    opened_s : float
        When the funnel was opened, as the log counts.

    Raises
    ------
    CalibrationError
        When the mass does not rise, or too fast for the scale.
    """
    rise = rise_of(series.path, log)
    base = base_of(series.path, log, rise)
    mass = log.mass_g - base.at(log.time_s)
    rising = isotonic_regression(mass).x
    line, noise = _steady(series.path, log.time_s, mass, rising)
    onset = line.middle_s - line.level_g / line.slope_g_s
    toward = np.array([1.0, onset - line.middle_s]) / line.slope_g_s
    variance = toward @ line.covariance @ toward
    # The flow wanders from the first grain on, before the line begins.
    before = noise.walk * max(0.0, _first_steady(log.time_s, rising) - onset)
    variance += (base.variance_at(onset) + before) / line.slope_g_s**2
    variance += log.tick_s**2 / _UNIFORM
    slope_variance = line.covariance[1, 1] + base.drift_variance
    plateau, remark = _plateau(log.time_s, mass, rise, base, line)
    return MassCurve(
        path=series.path,
        time_s=log.time_s - opened_s,
        mass_g=mass,
        rising_g=rising,
        onset_s=Estimate(onset - opened_s, math.sqrt(variance)),
        slope_g_s=Estimate(line.slope_g_s, math.sqrt(slope_variance)),
        plateau_g=plateau,
        tare_g=Estimate(float(base.level_g), math.sqrt(base.level_variance)),
        drift_g_s=Estimate(base.drift_g_s, math.sqrt(base.drift_variance)) if base.drifts else None,
        noise=noise,
        base=base.shifted(opened_s),
        tick_s=log.tick_s,
        tick_g=series.tick,
        taken_out={"twice": log.twice, "old": log.old, "bumps": log.bumps, "handled": log.handled},
        remarks=tuple(one for one in (base.remark, remark) if one),
    )


def _first_steady(time: Array, rising: Array) -> float:
    """Return when the steady flow begins [s]."""
    return float(time[int(np.argmax(rising >= _STEADY[0] * rising[-1]))])


def _steady(path: Path, time: Array, mass: Array, rising: Array) -> tuple[Line, Noise]:
    """Return the line of the steady flow and the noise about it."""
    low, high = (part * rising[-1] for part in _STEADY)
    inside = (rising >= low) & (rising <= high)
    if np.count_nonzero(inside) < _LEAST_STEADY:
        msg = (
            f"{path}: {np.count_nonzero(inside)} readings between {low:.3g} and {high:.3g} g, "
            f"while the mass flows; at least {_LEAST_STEADY} are needed: let the scale send more "
            "per second"
        )
        raise CalibrationError(msg)
    noise = noise_about(time[inside], mass[inside])
    line = line_of(time[inside], mass[inside], noise)
    if line.slope_g_s <= 0.0:
        msg = f"{path}: the mass does not rise steadily; is this the log of a flow?"
        raise CalibrationError(msg)
    return line, noise


def _plateau(
    time: Array, mass: Array, rise: Rise, base: Base, line: Line
) -> tuple[Estimate | None, str]:
    """Return the mass in the end, or why there is none."""
    after = rise.after
    count = np.count_nonzero(after)
    if count < _LEAST_STEADY:
        if not count:
            return None, "the log ends while the mass flows; it shows no plateau"
        return None, f"{count} readings after the flow are too few to show a plateau"
    rest = rest_of(time[after], mass[after])
    if abs(rest.slope_g_s) > _FLAT * line.slope_g_s:
        return None, f"the mass still rises by {rest.slope_g_s:.3g} g/s in the end; no plateau"
    variance = rest.covariance[0, 0] + base.variance_at(rest.middle_s)
    return Estimate(rest.level_g, math.sqrt(variance)), ""
