"""Restitution that scatters: every impact has its number, many have the mean and the deviation."""

from __future__ import annotations

from dataclasses import replace
from math import log, sqrt

import numpy as np
import pytest

from minidem.kernels.columns import SCATTERS, SLOWS, SWITCHES
from minidem.kernels.contact.extended import drawn, log_restitution_at
from minidem.kernels.contact.records import Switches
from minidem.kernels.models import (
    COEFFICIENTS,
    RESTITUTION_DEVIATION,
    RESTITUTION_EXPONENT,
    RESTITUTION_SPEED,
)
from tests.minidem.interpreted import run_interpreted
from tests.minidem.laws.law_scripts import RADIUS, Ball, Scene, run
from tests.minidem.laws.test_extensions import MODEL, NO_WEIGHT, heap, pair, scattering, slowing

E0, S = 0.7, 0.2
IMPACTS = 400


def impacts(speeds: np.ndarray, *, wall: bool) -> tuple[Ball, ...]:
    """Return balls above a floor, or pairs of balls, side by side, that meet at these speeds."""
    balls: list[Ball] = []
    for k, speed in enumerate(map(float, speeds)):
        x, y = 0.02 * (k % 20) - 0.2, 0.02 * (k // 20) - 0.2
        if wall:
            balls.append(Ball((x, y, RADIUS + 1e-5), (0.0, 0.0, -speed)))
        else:
            balls.append(Ball((x, y, 0.1), (0.0, 0.0, 0.5 * speed)))
            balls.append(Ball((x, y, 0.1 + 2 * RADIUS + 1e-5), (0.0, 0.0, -0.5 * speed)))
    return tuple(balls)


@pytest.mark.parametrize("wall", [True, False])
@pytest.mark.parametrize("slow", [True, False])
def test_impacts_have_the_mean_and_the_deviation_and_each_its_number(tmp_path, rng, wall, slow):
    speeds = rng.uniform(0.3, 0.6, IMPACTS)
    words = scattering(S)
    usual = np.full(IMPACTS, E0)
    if slow:
        also = slowing(0.25, 0.1)
        words = {name: (words[name], also[name]) for name in words}
        words = {"settings": " ".join(words["settings"]), "more": sum(words["more"], ())}
        usual = E0 * (speeds / 0.1) ** -0.25
    scene = Scene(
        impacts(speeds, wall=wall), restitution=E0, gravity=NO_WEIGHT, floor=wall, dt=2e-6, **words
    )
    v = run(scene, tmp_path, 3000).v[-1, :, 2]
    part = (v if wall else v[1::2] - v[::2]) / speeds / usual
    numbers = np.array([drawn(speed) for speed in speeds])
    # the damping law meets e within the time resolution of the contact (about 500 steps)
    np.testing.assert_allclose(part, 1.0 + S * numbers, rtol=3e-3)
    assert 1.0 - sqrt(3.0) * S - 3e-3 <= part.min() < part.max() <= 1.0 + sqrt(3.0) * S + 3e-3
    # four standard errors; the variance of uniform numbers has the error sqrt(0.8 / N)
    assert part.mean() == pytest.approx(1.0, abs=4.0 * S / sqrt(IMPACTS) + 3e-3)
    assert part.std() == pytest.approx(S, rel=4.0 * sqrt(0.2 / IMPACTS) + 3e-3)


def test_numbers_of_near_speeds_are_uniform_and_tell_nothing_of_each_other():
    # speeds that differ in the last digits of single precision, the hardest for a hash
    speeds = np.nextafter(np.float32(0.1), np.float32(1.0)) + np.arange(20000) * 2.0**-27
    numbers = np.array([drawn(speed) for speed in speeds])
    n = len(numbers)
    # four standard errors of uniform numbers: mean, variance, share of a tenth, correlation
    assert abs(numbers.mean()) < 4.0 / sqrt(n)
    assert abs(numbers.var() - 1.0) < 4.0 * sqrt(0.8 / n)
    counts, _ = np.histogram(numbers, 10, (-sqrt(3.0), sqrt(3.0)))
    assert np.abs(counts - n / 10).max() < 4.0 * sqrt(0.09 * n)
    for lag in (1, 2, 4, 256):
        assert abs(np.mean(numbers[lag:] * numbers[:-lag])) < 4.0 / sqrt(n)


def test_rounding_of_a_speed_changes_no_number(rng):
    speeds = rng.uniform(0.01, 3.0, 1000)
    # a border between two single numbers comes as near as this once in 1e7 speeds
    for factor in (1.0 - 1e-15, 1.0 + 1e-15):
        assert [drawn(v) for v in speeds * factor] == [drawn(v) for v in speeds]


@pytest.mark.parametrize(("e", "ends"), [(0.07, (0.05, 0.07 * 1.87)), (0.95, (0.95 * 0.13, 1.0))])
def test_restitution_stays_between_the_lowest_of_liggghts_and_one(rng, e, ends):
    coef = np.zeros((1, COEFFICIENTS))
    coef[0, RESTITUTION_DEVIATION] = 0.5
    on = Switches(*(int(at == SCATTERS) for at in range(SWITCHES)))
    found = [
        np.exp(log_restitution_at(on, coef, 0, log(e), speed)) for speed in rng.uniform(0, 1, 500)
    ]
    # 0.5 sqrt(3) = 0.866; with 500 numbers both ends of the uniform one are near
    assert min(found) == pytest.approx(ends[0], rel=0.1)
    assert max(found) == pytest.approx(ends[1], rel=0.1)
    assert min(found) >= 0.05 - 1e-12
    assert max(found) <= 1.0


def test_scatter_comes_after_the_power_law(rng):
    coef = np.zeros((1, COEFFICIENTS))
    coef[0, [RESTITUTION_DEVIATION, RESTITUTION_EXPONENT, RESTITUTION_SPEED]] = 0.1, 0.25, 0.1
    on = Switches(*(int(at in (SLOWS, SCATTERS)) for at in range(SWITCHES)))
    for speed in rng.uniform(0.1, 1.0, 20):
        e = 0.8 * (speed / 0.1) ** -0.25 * (1.0 + 0.1 * drawn(speed))
        assert log_restitution_at(on, coef, 0, log(0.8), speed) == pytest.approx(log(e))


def test_number_of_threads_changes_no_draw(tmp_path, rng):
    # a crowd, so that grains meet again after their first impact and one has several contacts
    scene = Scene(
        heap(rng, 18), model=MODEL, boundary="p p f", box="-0.00525 0.02625 -0.00525 0.02625 0 1",
        **scattering(0.4),
    )  # fmt: skip
    tracks = []
    for threads in (1, 3):
        folder = tmp_path / str(threads)
        folder.mkdir()
        (folder / "in.script").write_text(scene.text(2500, 2500))
        run_interpreted(folder / "in.script", threads=threads)
        tracks.append(np.loadtxt(folder / "out.dump", skiprows=2 * 9 + 18))
    # nothing but rounding (1e-17 m), as in the base model; where the last digit of a speed changes
    # the number, positions are 5e-5 m apart
    np.testing.assert_allclose(tracks[0][:, 2:5], tracks[1][:, 2:5], rtol=0, atol=1e-10)


def test_pairs_of_types_have_their_own_deviation(tmp_path):
    ball = Ball((0.0, 0.0, RADIUS + 1e-5), (0.0, 0.0, -0.5))
    scene = Scene((ball,), restitution=E0, gravity=NO_WEIGHT, dt=2e-6, **scattering(S))
    between = pair("restitutionDeviation", S).split()
    between[-2] = between[-3] = "0"  # of balls with the floor
    tracks = []
    for name, one in (
        ("base", replace(scene, settings="", more=())),
        ("other", replace(scene, more=(" ".join(between),))),
        ("floor", scene),
    ):
        (tmp_path / name).mkdir()
        tracks.append(run(one, tmp_path / name, 3000).v)
    np.testing.assert_array_equal(tracks[0], tracks[1])
    assert tracks[2][-1, 0, 2] != tracks[0][-1, 0, 2]
