"""Profiles of a plate: planted cosines are found, whatever the record is like."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from calibrate.errors import CalibrationError
from calibrate.laboratory.instrument.series import Form
from calibrate.laboratory.motion.choice import worth_keeping
from calibrate.laboratory.motion.doubts import doubts_of
from calibrate.laboratory.motion.harmonics import covariance, fit_at, refined
from calibrate.laboratory.motion.lines import apparatus_of, script_line, study_lines
from calibrate.laboratory.motion.profile import plate_motion_in
from liggghts_io.experiments import EXPERIMENTS
from liggghts_io.experiments.plate_motion import plate_motion

PERIOD = 0.0812
AMPLITUDES = (2e-3, 5e-4, 1e-4)
PHASES = (0.5 * np.pi, 0.4, -2.0)
"""As they are found: the clock starts with the first at a quarter of a turn."""
LATE = 0.0123
"""When that clock starts in a record."""


def way(time, amplitudes=AMPLITUDES, phases=PHASES, period=PERIOD):
    waves = enumerate(zip(amplitudes, phases, strict=True), 1)
    return sum(a * np.cos(2.0 * np.pi * k * (time - LATE) / period + p) for k, (a, p) in waves)


def force(time, amplitudes=AMPLITUDES, phases=PHASES, period=PERIOD):
    rates = [(2.0 * np.pi * k / period) ** 2 for k in range(1, len(amplitudes) + 1)]
    return -way(time, [a * r for a, r in zip(amplitudes, rates, strict=True)], phases, period)


def record(
    path: Path, rng, *, kind="acceleration", noise=0.03, periods=7.3, count=600, gap=True,
    offset=9.81, drift=0.0, **truth,
) -> Path:  # fmt: skip
    """Write a record with uneven spacing, a gap, noise, an offset and a drift."""
    time = np.sort(rng.uniform(0.0, periods * PERIOD, count))
    if gap:
        time = time[(time < 0.35 * time[-1]) | (time > 0.5 * time[-1])]
    clean = (force if kind == "acceleration" else way)(time, **truth)
    size = float(np.std(clean))
    slow = offset + drift * size * np.sin(0.7 * time / time[-1])
    seen = clean + slow + noise * size * rng.standard_normal(len(time))
    unit = "m/s2" if kind == "acceleration" else "m"
    rows = [f"{t:.6f},{v:.9g}" for t, v in zip(time, seen, strict=True)]
    path.write_text("\n".join([f"t [s],value [{unit}]", *rows, ""]))
    return path


@pytest.mark.parametrize("kind", ["acceleration", "position"])
@pytest.mark.parametrize("noise", [0.01, 0.05])
@pytest.mark.parametrize("drift", [0.0, 1.0])
def test_planted_cosines_are_found_within_their_errors(tmp_path, kind, noise, drift):
    rng = np.random.default_rng(2)
    offset = 9.81 if kind == "acceleration" else 0.05
    found = plate_motion_in(
        record(tmp_path / "a.csv", rng, kind=kind, noise=noise, drift=drift, offset=offset), Form()
    )
    assert found.quantity.name == kind
    assert found.harmonics == found.worth == 3
    z = [(found.period_s - PERIOD) / found.period_se_s]
    z += list((found.amplitudes_m - AMPLITUDES) / found.amplitudes_se_m)
    z += list((found.phases_rad - PHASES)[1:] / found.phases_se_rad[1:])
    assert np.abs(z).max() < 4.0
    assert np.sqrt(np.mean(np.square(z))) < 2.0
    assert found.share == pytest.approx(noise, rel=0.15)
    assert found.period_se_s < 1e-3 * PERIOD


@settings(max_examples=8, deadline=None)
@given(
    seed=st.integers(0, 2**31), periods=st.floats(2.1, 11.0),
    ratios=st.tuples(st.floats(0.05, 0.6), st.floats(0.0, 0.3)),
    phases=st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0)),
)  # fmt: skip
def test_any_motion_is_drawn_to_its_noise(tmp_path_factory, seed, periods, ratios, phases):
    """The fitted way is the planted one to a few times the noise over the root of the readings."""
    truth = {
        "amplitudes": (2e-3, *(2e-3 * r for r in ratios)), "phases": (0.5 * np.pi, *phases)
    }  # fmt: skip
    path = tmp_path_factory.mktemp("any") / "a.csv"
    rng = np.random.default_rng(seed)
    found = plate_motion_in(record(path, rng, periods=periods, gap=False, **truth), Form())
    assert found.period_s == pytest.approx(PERIOD, rel=5e-3)
    clock = np.linspace(0.0, PERIOD, 50, endpoint=False)
    off = found.acceleration(clock) - force(clock + LATE, **truth)
    assert np.sqrt(np.mean(off**2)) < 0.06 * np.std(force(clock, **truth))


@pytest.mark.parametrize("loud", [(4e-4, 2e-3, 1e-4), (4e-4, 2e-4, 1e-3)])
def test_a_harmonic_that_is_louder_than_the_first_is_no_period(tmp_path, loud):
    path = record(tmp_path / "a.csv", np.random.default_rng(5), amplitudes=loud)
    assert plate_motion_in(path, Form()).period_s == pytest.approx(PERIOD, rel=1e-3)


def test_a_single_cosine_has_one(tmp_path):
    path = record(
        tmp_path / "a.csv", np.random.default_rng(6), amplitudes=(2e-3,), phases=(1.5708,)
    )
    found = plate_motion_in(path, Form())
    assert (found.worth, found.period_s) == (1, pytest.approx(PERIOD, rel=1e-3))


def test_a_given_period_is_kept_and_one_period_is_enough_then(tmp_path):
    rng = np.random.default_rng(7)
    path = record(tmp_path / "a.csv", rng, periods=1.1, gap=False)
    with pytest.raises(CalibrationError, match="record two or more, or give it with --period"):
        plate_motion_in(path, Form())
    found = plate_motion_in(path, Form(), period_s=PERIOD)
    assert (found.period_s, found.period_se_s) == (PERIOD, 0.0)
    assert found.amplitudes_m[0] == pytest.approx(2e-3, rel=0.05)


def test_a_sensor_that_points_back_is_turned(tmp_path):
    path = record(tmp_path / "a.csv", np.random.default_rng(8))
    plain = plate_motion_in(path, Form(), period_s=PERIOD)
    turned = plate_motion_in(path, Form(), period_s=PERIOD, reverse=True)
    clock = np.linspace(0.0, PERIOD, 200)
    back = turned.position(clock + plain.start_s - turned.start_s)
    assert back == pytest.approx(-plain.position(clock), abs=1e-12)


def test_errors_of_coefficients_are_those_of_repeats():
    """From forty records: scatter over stated error is 1, by chance 0.89 to 1.11."""
    rng, z = np.random.default_rng(9), []
    for _ in range(40):
        time = np.sort(rng.uniform(0.0, 5.2 * PERIOD, 200))
        fit = refined(time, way(time) + 5e-5 * rng.standard_normal(200), PERIOD, 3)
        z.append((fit.period_s - PERIOD) / np.sqrt(covariance(time, fit, free=True)[0, 0]))
    assert 0.7 < np.std(z) < 1.35


def test_the_fit_is_least_squares():
    """What remains is orthogonal to every cosine and sine that was fitted."""
    time = np.sort(np.random.default_rng(10).uniform(0.0, 0.5, 300))
    fit = fit_at(time, way(time) + 1e-4 * time**2, PERIOD, 2)
    for k in (1, 2):
        angle = 2.0 * np.pi * k * (time - fit.origin_s) / PERIOD
        assert abs(fit.residual @ np.cos(angle)) < 1e-12
        assert abs(fit.residual @ np.sin(angle)) < 1e-12


def test_harmonics_are_kept_by_prediction():
    flat = np.ones((4, 10)) + 0.1 * np.random.default_rng(11).standard_normal((4, 10))
    assert worth_keeping(flat + np.array([5.0, 2.0, 0.0, 0.0])[:, None]) == 3
    assert worth_keeping(np.ones((4, 10))) == 1


@pytest.mark.parametrize("kind", ["acceleration", "position"])
def test_the_lines_of_a_study_move_the_conveyor_so(tmp_path, kind):
    """The apparatus that is printed, made into a script's cosines, is the planted motion."""
    found = plate_motion_in(
        record(tmp_path / "a.csv", np.random.default_rng(12), kind=kind, noise=0.001), Form()
    )
    apparatus = EXPERIMENTS["conveyor"].apparatus("quick", apparatus_of(found))
    moving = plate_motion(apparatus)
    clock = np.linspace(0.0, PERIOD, 100)
    waves = zip(*moving.values(), strict=True)
    drawn = sum(a * np.cos(2.0 * np.pi * clock / t + p) for a, p, t in waves)
    assert drawn == pytest.approx(way(clock + LATE), abs=1e-5)
    words = script_line(found).split()
    assert words[words.index("order") + 1] == "3"
    numbers = [float(word) for word in words[words.index("amplitude") + 1 :] if word[0].isdigit()]
    assert numbers[:3] == pytest.approx(moving["amplitudes"], rel=1e-5)
    assert study_lines(found).startswith('[[experiment]]\nname = "conveyor"\napparatus = {')


def test_a_motion_that_no_conveyor_makes_is_said_to_be_none(tmp_path):
    large = record(tmp_path / "a.csv", np.random.default_rng(13), kind="position",
                   amplitudes=(2.0, 0.1, 0.1))  # fmt: skip
    assert "# The conveyor of a study cannot move so: amplitude_m = 1.99" in study_lines(
        plate_motion_in(large, Form())
    )


def test_what_is_no_motion_is_refused(tmp_path):
    rng = np.random.default_rng(14)
    path = tmp_path / "a.csv"
    head = "t [s],a [m/s2]\n"
    cases = {
        "at least 16": [(k, k % 2) for k in range(10)],
        "does not change": [(0.01 * k, 9.81) for k in range(100)],
        "shows no motion|holds .* periods": [(0.01 * k, rng.normal()) for k in range(300)],
    }
    for words, rows in cases.items():
        path.write_text(head + "".join(f"{t},{v}\n" for t, v in rows))
        with pytest.raises(CalibrationError, match=words):
            plate_motion_in(path, Form())
    few = record(path, rng, count=40, gap=False)
    with pytest.raises(CalibrationError, match=r"--harmonics 30: 40 readings tell \d+ at most"):
        plate_motion_in(few, Form(), harmonics=30)
    with pytest.raises(CalibrationError, match=r"--period 10s: the record holds"):
        plate_motion_in(few, Form(), period_s=10.0)


def test_a_sensor_at_its_end_is_told(tmp_path, rng):
    path = record(tmp_path / "plate.csv", rng, offset=0.0)
    cells = [row.split(",") for row in path.read_text().splitlines()[1:]]
    assert not doubts_of(plate_motion_in(path, Form()))
    readings = [(t, float(v)) for t, v in cells]
    limit = 0.6 * max(v for _, v in readings)
    lines = [f"{t},{min(v, limit):.9g}" for t, v in readings]
    path.write_text("\n".join(["t [s],value [m/s2]", *lines, ""]))
    (said,) = doubts_of(plate_motion_in(path, Form()))
    assert "readings equal the largest one" in said


@pytest.mark.parametrize("levels", [20, 200])
def test_a_coarse_sensor_is_not_at_its_end(tmp_path, levels):
    time = np.arange(0.0, 7.3 * PERIOD, 1.3e-3)
    clean = way(time, (2e-3,), PHASES[:1])
    digit = 4e-3 / levels
    rows = [f"{t:.6f},{np.round(v / digit) * digit:.9g}" for t, v in zip(time, clean, strict=True)]
    path = tmp_path / "plate.csv"
    path.write_text("\n".join(["t [s],value [m]", *rows, ""]))
    assert not doubts_of(plate_motion_in(path, Form()))


def test_a_record_that_is_too_slow_for_the_motion_is_told(tmp_path):
    time = np.arange(0.0, 40.0 * PERIOD, 1.23 * PERIOD)
    rows = [f"{t:.6f},{v:.9g}" for t, v in zip(time, way(time), strict=True)]
    path = tmp_path / "plate.csv"
    path.write_text("\n".join(["t [s],value [m]", *rows, ""]))
    assert "is not described" in " ".join(doubts_of(plate_motion_in(path, Form())))


def test_few_readings_in_a_period_are_told(tmp_path):
    time = np.arange(0.0, 20.0 * PERIOD, 0.19 * PERIOD)
    rows = [f"{t:.6f},{v:.9g}" for t, v in zip(time, way(time), strict=True)]
    path = tmp_path / "plate.csv"
    path.write_text("\n".join(["t [s],value [m]", *rows, ""]))
    said = doubts_of(plate_motion_in(path, Form(), period_s=PERIOD))
    assert said[0].startswith("5.3 readings in a period")
