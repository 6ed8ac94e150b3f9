"""When readings were taken: slow scales and coarse stamps shift no time."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibrate.errors import CalibrationError
from calibrate.laboratory.instrument.series import Form, Series
from calibrate.laboratory.scale.log import read_mass_curve
from calibrate.laboratory.scale.timing import renewed, with_spread_stamps
from tests.calibrate.laboratory.logs import curve_of, flow, series

SEEDS = range(8)


def held(log: Series, every_s: float, rows_per_s: float, late: float) -> Series:
    """Return a log that asks a scale more often than it has a new reading."""
    asked = np.arange(0.0, 29.0, 1.0 / rows_per_s)
    told = np.maximum(every_s * np.floor((asked - late) / every_s) + late, 0.0)
    mass = np.interp(told, log.time_s, log.values)
    return series(np.round(asked, 3), np.round(mass, 2))


@pytest.mark.parametrize("rate", [20.0, 50.0])
def test_a_scale_of_five_hertz_that_is_asked_more_often_shifts_no_time(rate):
    """Taken as they stand, rows would be late by 0.1 s in the mean; left are a few milliseconds."""
    off, z = [], []
    for seed in SEEDS:
        log, truth = flow(np.random.default_rng(seed), rate=200.0, noise=0.0, jitter=0.0)
        curve = curve_of(held(log, 0.2, rate, late=0.2 * (seed + 0.5) / len(SEEDS)))
        found = curve.time_to(100.0)
        off.append(found.value - truth.time_to(100.0))
        z.append(off[-1] / found.se)
        assert curve.taken_out["old"] > 0.5 * 29.0 * rate
    assert abs(np.mean(off)) < 0.015
    assert np.sqrt(np.mean(np.square(z))) < 2.0


def test_readings_that_agree_by_rounding_are_readings_of_their_own():
    """A scale of 1 g at 50 Hz: 0.4 g flow between readings, so that two or three are equal."""
    log, _ = flow(np.random.default_rng(1), rate=50.0, noise=0.0, tick=1.0)
    assert renewed(log.time_s, log.values, 1.0) is None
    plain, _ = flow(np.random.default_rng(1))
    assert renewed(plain.time_s, plain.values, 0.01) is None


def test_stamps_in_whole_seconds_are_spread_over_them(tmp_path: Path):
    """A log at 10 Hz that notes hours, minutes and seconds only, begun within a second."""
    off = []
    for seed in SEEDS:
        log, truth = flow(np.random.default_rng(seed), jitter=0.0)
        begun = 0.1 * seed + 0.05
        rows = [
            f"14:00:{int(time + begun):02d},{mass:.2f}"
            for time, mass in zip(log.time_s, log.values, strict=True)
        ]
        path = tmp_path / f"run{seed}.csv"
        path.write_text("\n".join(["time,mass [g]", *rows, ""]))
        found = read_mass_curve(path, Form()).time_to(100.0)
        off.append(found.value - truth.time_to(100.0))
        assert found.se < 0.05
    assert np.abs(off).max() < 0.1


def test_rounded_times_are_spread_around_them():
    log, truth = flow(np.random.default_rng(3), rate=50.0, jitter=0.0)
    coarse = replace(log, time_s=np.round(log.time_s, 1), tick_s=0.1)
    spread = with_spread_stamps(coarse)
    assert np.abs(spread.time_s - log.time_s).max() < 0.03
    assert curve_of(spread).time_to(100.0).value == pytest.approx(truth.time_to(100.0), abs=0.02)


def test_rows_that_stand_twice_are_not_spread():
    log, _ = flow(np.random.default_rng(4))
    again = series(np.repeat(log.time_s, 2), np.repeat(log.values, 2))
    assert with_spread_stamps(again) is again
    assert with_spread_stamps(log) is log


def test_a_log_that_begins_while_the_mass_flows_is_refused_unless_it_begins_with_nothing():
    """Behind a tared scale zero is the empty scale; behind 63 g nothing tells it."""
    log, _ = flow(np.random.default_rng(5), noise=0.0, tare=35.0)
    late = log.time_s > 8.0
    cut = replace(log, time_s=log.time_s[late], values=log.values[late])
    with pytest.raises(CalibrationError, match=r"rises from the first reading on \(\d+"):
        curve_of(cut)
    tared = replace(cut, values=cut.values - cut.values[0])
    curve = curve_of(tared)
    assert "for the empty scale" in curve.remarks[0]
    assert curve.tare_g.value == 0.0


def test_what_a_gap_may_hide_is_in_the_error():
    """A flow that wanders by 0.9 g2/s: three seconds of it hide 0.8 g in their middle, or 41 ms."""
    rng, whole, holed = np.random.default_rng(6), [], []
    time = np.arange(0.0, 30.0, 0.1)
    gap = (time > 8.6) & (time < 11.6)
    for _ in SEEDS:
        walk = np.cumsum(0.3 * rng.standard_normal(len(time)))
        mass = np.clip(20.0 * (time - 5.0) + np.where(time > 5.0, walk, 0.0), 0.0, 300.0)
        whole.append(curve_of(series(time, mass)).time_to(100.0).se)
        holed.append(curve_of(series(time[~gap], mass[~gap])).time_to(100.0).se)
    assert np.median(whole) < 0.02
    assert np.median(holed) == pytest.approx(0.041, rel=0.4)
