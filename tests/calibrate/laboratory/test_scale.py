"""Logs of a scale: what was planted is found, with errors that are neither too small nor idle."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from calibrate.errors import CalibrationError
from calibrate.laboratory.instrument.series import Form
from calibrate.laboratory.scale.clean import cleaned
from calibrate.laboratory.scale.curve import Estimate
from calibrate.laboratory.scale.log import read_mass_curve
from calibrate.laboratory.scale.noise import line_of, noise_about
from calibrate.laboratory.scale.repeats import curve_table, quantity_of, repeated
from tests.calibrate.laboratory.logs import TOTAL_G, curve_of, flow, series, written

LOGS = 12
"""Logs of every kind: a mean of their deviations in standard errors has one of 0.29."""


def deviations(kind: dict, seed: int = 5) -> np.ndarray:
    """Return by how many standard errors time, onset, slope and plateau are off, (LOGS, 4)."""
    rng, found = np.random.default_rng(seed), []
    for _ in range(LOGS):
        log, truth = flow(rng, **kind)
        curve = curve_of(log)
        seen = (curve.time_to(100.0), curve.onset_s, curve.slope_g_s, curve.plateau_g)
        true = (truth.time_to(100.0), truth.onset, truth.slope, TOTAL_G)
        found.append([(one.value - what) / one.se for one, what in zip(seen, true, strict=True)])
    return np.array(found)


@pytest.mark.parametrize(
    "kind",
    [
        {}, {"bumps": 5}, {"tare": 152.3}, {"drift": 0.05}, {"rate": 2.0},
        {"rate": 100.0, "noise": 0.5},
        {"drift": -0.05, "bumps": 3, "tare": 35.2, "tick": 0.1},
    ],
    ids=str,
)  # fmt: skip
def test_planted_numbers_are_found_within_their_errors(kind):
    """Scatter about 1; up to 1.6 by chance for twelve logs, and errors may be too large."""
    z = deviations(kind)
    assert np.abs(z.mean(axis=0)).max() < 1.2  # a grain still in the air shifts a plateau
    assert np.sqrt((z**2).mean(axis=0)).max() < 1.7
    assert np.abs(z).max() < 4.5


def test_errors_are_not_idle():
    """A log at ten readings a second tells the time of 100 g to 10 ms, a flow to 2 %."""
    curve = curve_of(flow(np.random.default_rng(1))[0])
    assert curve.time_to(100.0).se < 0.01
    assert curve.slope_g_s.se < 0.4
    assert curve.onset_s.se < 0.1
    assert curve.plateau_g.se < 0.02


def test_bumps_do_not_move_the_time():
    clean, _ = flow(np.random.default_rng(3))
    bumped = replace(clean, values=clean.values.copy())
    for k in (40, 95, 100, 180):
        bumped.values[k : k + 3] += 60.0
    before, after = curve_of(clean), curve_of(bumped)
    assert after.taken_out["bumps"] >= 12
    assert after.time_to(100.0).value == pytest.approx(before.time_to(100.0).value, abs=0.02)
    assert after.plateau_g.value == pytest.approx(before.plateau_g.value, abs=0.01)


def test_a_drift_is_taken_off_and_told():
    log, _ = flow(np.random.default_rng(4), drift=0.05)
    curve = curve_of(log)
    assert curve.drift_g_s.value == pytest.approx(0.05, abs=4 * curve.drift_g_s.se)
    assert curve_of(flow(np.random.default_rng(4))[0]).drift_g_s is None


@pytest.mark.parametrize("handled", ["tared", "box put on", "both", "box taken off at the end"])
def test_a_scale_that_was_handled(handled):
    """A box of 152.3 g, taring before the flow, and what happens after it."""
    log, _ = flow(np.random.default_rng(6), noise=0.01)
    plain = curve_of(log)
    mass, time = log.values.copy(), log.time_s
    if handled == "tared":
        mass[time < 2.0] += 152.3
    elif handled == "box put on":
        mass[time >= 2.0] += 152.3
    elif handled == "both":
        mass[(time >= 1.0) & (time < 2.5)] += 152.3
    else:
        mass[time > 26.0] = -3.0
    curve = curve_of(replace(log, values=mass))
    assert curve.time_to(100.0).value == pytest.approx(plain.time_to(100.0).value, abs=0.003)
    assert curve.plateau_g.value == pytest.approx(plain.plateau_g.value, abs=0.02)
    assert curve.taken_out["handled"] > 10


@pytest.mark.parametrize("step", [60.0, -60.0])
def test_a_scale_that_is_handled_while_the_mass_flows_is_refused(step):
    log, _ = flow(np.random.default_rng(6))
    mass = log.values + np.where(log.time_s > 10.0, step, 0.0)
    with pytest.raises(
        CalibrationError, match=r"run.csv:\d+: the mass (rises|falls) by .* g at once"
    ):
        curve_of(replace(log, values=mass))


@pytest.mark.parametrize("lead", [0, 1, 3])
@pytest.mark.parametrize("ramp_s", [0.2, 1.0, 3.0, 8.0])
def test_a_first_trickle_is_not_taken_for_the_empty_scale(ramp_s, lead):
    """The log begins as the first grains fall, and the flow takes some time to become steady."""
    rng, noise, tick, slope, tare = np.random.default_rng(18), 0.02, 0.01, 19.0, 152.3
    time = np.arange(-lead / 10.0, 30.0, 0.1)
    fallen = np.clip(time, 0.0, None)
    mass = slope * np.where(fallen < ramp_s, fallen**2 / (2.0 * ramp_s), fallen - 0.5 * ramp_s)
    mass = np.minimum(mass, TOTAL_G) + tare + noise * rng.standard_normal(len(time))
    curve = curve_of(series(time - time[0], np.round(mass / tick) * tick, tick=tick))
    # A reading counts while it shows no more than three deviations and a step of the scale.
    assert curve.tare_g.value == pytest.approx(tare, abs=3.0 * noise + tick)
    assert curve.time_to(100.0).value == pytest.approx(
        100.0 / slope + 0.5 * ramp_s + lead / 10.0, abs=3.0 * curve.time_to(100.0).se
    )


def test_rows_that_stand_twice_count_once():
    log, _ = flow(np.random.default_rng(7))
    again = series(np.repeat(log.time_s, 2), np.repeat(log.values, 2))
    once, twice = curve_of(log), curve_of(again)
    assert twice.taken_out["twice"] == len(log.time_s)
    assert twice.time_to(100.0) == once.time_to(100.0)


@settings(max_examples=15, deadline=None)
@given(
    shift=st.floats(-50.0, 50.0), tare=st.integers(-20000, 20000), scale=st.sampled_from([0.1, 3.0])
)
def test_what_does_not_matter_changes_nothing(shift, tare, scale):
    """Another zero of clock and scale, and other units of the mass."""
    log, _ = flow(np.random.default_rng(8))
    plain = curve_of(log)
    moved = replace(log, time_s=log.time_s + shift, values=scale * (log.values + 0.01 * tare))
    moved = replace(moved, tick=scale * log.tick)
    curve = curve_of(moved, shift)
    assert curve.time_to(100.0 * scale).value == pytest.approx(plain.time_to(100.0).value, abs=1e-6)
    assert curve.onset_s.value == pytest.approx(plain.onset_s.value, abs=1e-6)
    assert curve.slope_g_s.value == pytest.approx(scale * plain.slope_g_s.value, rel=1e-6)
    assert curve.plateau_g.value == pytest.approx(scale * plain.plateau_g.value, rel=1e-6)


@given(st.floats(5.0, 295.0), st.floats(5.0, 295.0))
def test_more_mass_takes_longer(one, other):
    curve = curve_of(flow(np.random.default_rng(9))[0])
    low, high = sorted((one, other))
    assert curve.time_to(low).value <= curve.time_to(high).value


def test_an_exact_line_is_read_exactly():
    time = np.arange(0.0, 30.0, 0.1)
    curve = curve_of(series(time, np.clip(20.0 * (time - 5.0), 0.0, 300.0), tick=0.0))
    assert curve.time_to(100.0).value == pytest.approx(10.0, abs=1e-9)
    assert curve.onset_s.value == pytest.approx(5.0, abs=1e-9)
    assert curve.slope_g_s.value == pytest.approx(20.0, rel=1e-9)
    assert curve.plateau_g.value == pytest.approx(300.0, abs=1e-9)


def test_a_log_that_ends_while_it_flows_has_no_plateau():
    log, truth = flow(np.random.default_rng(10), length=14.0)
    curve = curve_of(log)
    assert curve.plateau_g is None
    assert "ends while the mass flows" in curve.remarks[0]
    assert curve.time_to(100.0).value == pytest.approx(truth.time_to(100.0), abs=0.03)
    with pytest.raises(CalibrationError, match="shows no plateau"):
        quantity_of(curve, "plateau", 100.0)
    with pytest.raises(
        CalibrationError, match=r"g lie on the scale at the end, and 250 g are asked"
    ):
        curve.time_to(250.0)


def test_a_mass_in_the_noise_is_refused():
    curve = curve_of(flow(np.random.default_rng(11), noise=0.5)[0])
    with pytest.raises(CalibrationError, match=r"0\.5 g are lost in the scatter"):
        curve.time_to(0.5)


@pytest.mark.parametrize(
    ("time", "mass", "words"),
    [
        (np.arange(5.0), np.arange(5.0), "readings at 5 different times"),
        (np.arange(50.0), np.full(50, 1.5), "which is no flow onto a scale"),
        (np.arange(50.0), -np.arange(50.0), "is this the log of a flow onto a scale"),
        (np.arange(40.0), np.repeat([0.0, 300.0], 20), "no flow onto a scale|is this the log"),
        (np.arange(40.0), np.interp(np.arange(40.0), [18, 22], [0, 300]), "while the mass flows"),
    ],
)
def test_what_is_no_flow_is_refused(time, mass, words):
    with pytest.raises(CalibrationError, match=words):
        curve_of(series(time, mass))


def test_wandering_is_told_from_scatter():
    """A random walk of 0.5 g2/s under a scatter of 0.3 g, both within a factor of two."""
    rng, walks, scatters = np.random.default_rng(12), [], []
    time = np.arange(0.0, 20.0, 0.05)
    for _ in range(30):
        walk = np.cumsum(np.sqrt(0.5 * 0.05) * rng.standard_normal(len(time)))
        noise = noise_about(time, 20.0 * time + walk + 0.3 * rng.standard_normal(len(time)))
        walks.append(noise.walk)
        scatters.append(noise.variance)
    assert 0.25 < np.median(walks) < 1.0
    assert np.median(scatters) == pytest.approx(0.09, rel=0.2)


def test_the_line_of_plain_scatter_is_least_squares():
    rng = np.random.default_rng(13)
    time = np.arange(0.0, 5.0, 0.05)
    mass = 3.0 * time + rng.standard_normal(len(time))
    noise = replace(noise_about(time, mass), variance=1.0, walk=0.0)
    line = line_of(time, mass, noise)
    coefficients, covariance = np.polyfit(time - line.middle_s, mass, 1, cov="unscaled")
    assert [line.slope_g_s, line.level_g] == pytest.approx(coefficients)
    assert line.covariance == pytest.approx(covariance[::-1, ::-1])


def test_repeats_give_mean_and_error_never_below_the_readings():
    found = repeated([Estimate(10.0, 0.01), Estimate(10.2, 0.01), Estimate(10.1, 0.01)])
    assert (found.value, found.repeats) == (pytest.approx(10.1), 3)
    assert found.se == pytest.approx(0.1 / np.sqrt(3.0))
    assert repeated([Estimate(10.0, 0.3)] * 4).se == pytest.approx(0.15)
    assert repeated([Estimate(10.0, 0.3)]).repeats == 0


def test_a_common_curve_rises_and_holds_the_single_times():
    rng = np.random.default_rng(14)
    curves = [curve_of(flow(rng, onset=onset)[0]) for onset in (4.5, 4.7, 4.8)]
    table = curve_table(curves)
    assert 30 <= len(table.mass_g) <= 60
    assert np.all(np.diff(table.time_s) > 0.0)
    k = int(np.argmin(np.abs(table.mass_g - 100.0)))
    assert table.mass_g[k] == pytest.approx(100.0)
    assert table.runs_s[k] == pytest.approx([one.time_to(100.0).value for one in curves])


def test_the_clock_counts_from_the_opening(tmp_path: Path):
    log, _ = flow(np.random.default_rng(15))
    path = written(tmp_path / "run.csv", log)
    plain = read_mass_curve(path, Form()).time_to(100.0).value
    assert read_mass_curve(path, Form(), "1.5").time_to(100.0).value == pytest.approx(plain - 1.5)
    late = written(tmp_path / "late.csv", replace(log, time_s=log.time_s + 4000.0))
    with pytest.raises(CalibrationError, match=r"its clock shows 4000.* say with --start"):
        read_mass_curve(late, Form())
    assert read_mass_curve(late, Form(), "4000").time_to(100.0).value == pytest.approx(plain)
    for start, words in (("99", "is after the end"), ("12:00:00", "shows seconds"), ("x", "not a")):
        with pytest.raises(CalibrationError, match=words):
            read_mass_curve(path, Form(), start)


def test_cleaning_keeps_what_is_right():
    log, _ = flow(np.random.default_rng(16))
    clean = cleaned(log)
    assert (clean.twice, clean.handled) == (0, 0)
    assert clean.bumps <= 0.03 * len(log.time_s)
