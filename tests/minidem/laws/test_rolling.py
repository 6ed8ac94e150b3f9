"""Closed forms of rolling and twisting on a plane, and energy of a stacked pair.

Sources: textbook mechanics of a sphere with moment of inertia 2/5 m r^2; the rates are also those
of the LAMMPS unit tests for granular contacts. Rolling resistance has the torque mu_r m g r.

Rates are taken after the first frame: at the start of a run LIGGGHTS damps the sliding and rolling
velocity once without the limit of friction.
"""

from __future__ import annotations

import numpy as np
import pytest

from tests.minidem.laws import law_scripts as scripts
from tests.minidem.laws.law_scripts import DENSITY, RADIUS, Ball, Scene, run

G = 9.81
EFFECTIVE = 1.0 / (2.0 * (1.0 - scripts.POISSON**2) / scripts.YOUNG)
MASS = 4.0 / 3.0 * np.pi * RADIUS**3 * DENSITY
HISTORY = "hertz tangential history"
CDT, EPSD, EPSD2 = (f"{HISTORY} rolling_friction {name}" for name in ("cdt", "epsd", "epsd2"))
VISCOUS = (
    "fix eta all property/global coefficientRollingViscousDamping peratomtypepair 2 " + ".3 " * 4,
)


def rest(normal_share: float = 1.0) -> float:
    """Return the height at which this share of the weight balances the floor."""
    force = MASS * G * normal_share
    return float(RADIUS - (force / (4.0 / 3.0 * EFFECTIVE * np.sqrt(RADIUS))) ** (2.0 / 3.0))


def on_slope(folder, model: str, angle: float, rolling: float, time: float):
    """Let a ball go on an incline whose plane is the floor; the slope falls along x."""
    a = np.radians(angle)
    ball = Ball((0.0, 0.0, rest(np.cos(a))))
    down = (G * np.sin(a), 0.0, -G * np.cos(a))
    scene = Scene(
        (ball,), friction=0.8, rolling=rolling, wall_model=model, gravity=down, restitution=0.3,
        more=VISCOUS,
    )  # fmt: skip
    steps = round(time / scripts.DT)
    return run(scene, folder, steps, steps // 20)


@pytest.mark.parametrize("model", [CDT, EPSD, EPSD2])
def test_ball_rolls_down_against_rolling_friction(tmp_path, model):
    angle, rolling, time = 20.0, 0.1, 0.2
    track = on_slope(tmp_path, model, angle, rolling, time)
    a = np.radians(angle)
    expected = 5.0 / 7.0 * G * (np.sin(a) - rolling * np.cos(a)) * time
    # the springs of friction and rolling load in the first milliseconds
    assert track.v[-1, 0, 0] == pytest.approx(expected, rel=1e-2)
    assert track.w[-1, 0, 1] == pytest.approx(expected / RADIUS, rel=1e-2)


@pytest.mark.parametrize("model", [EPSD, EPSD2])
def test_ball_rests_where_rolling_friction_exceeds_the_slope(tmp_path, model):
    track = on_slope(tmp_path, model, 20.0, 0.4, 0.4)  # tan 20 deg = 0.364
    far = track.x[:, 0, 0]
    # epsd2 has no damping of its own: the ball rocks about its place, but does not leave it
    assert np.abs(far).max() < 1e-4
    assert np.abs(track.v[:, 0, 0]).max() < 0.02


def test_constant_torque_lets_a_ball_creep_where_the_spring_holds_it(tmp_path):
    creep = {}
    for name, model in (("cdt", CDT), ("epsd2", EPSD2)):
        (tmp_path / name).mkdir()
        track = on_slope(tmp_path / name, model, 20.0, 0.4, 0.4)
        creep[name] = float(track.x[-1, 0, 0] - track.x[5, 0, 0])
    # a torque of constant size turns with the sense of rolling: the ball rocks, and creeps
    assert creep["cdt"] > 1e-5
    assert abs(creep["epsd2"]) < 1e-2 * creep["cdt"]


@pytest.mark.parametrize("model", [CDT, EPSD, EPSD2])
def test_spin_on_a_smooth_floor_decays_at_the_rate_of_the_torque(tmp_path, model):
    rolling, w0, time = 0.05, 60.0, 0.1
    ball = Ball((0.0, 0.0, rest()), w=(0.0, w0, 0.0))
    scene = Scene((ball,), friction=0.0, rolling=rolling, wall_model=model, more=VISCOUS)
    steps = round(time / scripts.DT)
    track = run(scene, tmp_path, steps, steps // 10)
    rates = np.diff(track.w[1:, 0, 1]) / (0.1 * time)
    # the floor carries the weight to rounding
    np.testing.assert_allclose(rates, -2.5 * rolling * G / RADIUS, rtol=1e-6)
    np.testing.assert_array_equal(track.v[1:, 0, 0], track.v[1, 0, 0])


@pytest.mark.parametrize("model", [CDT, EPSD2])
@pytest.mark.parametrize("torsion", [True, False])
def test_twist_decays_only_with_torsion(tmp_path, model, torsion):
    rolling, w0, time = 0.05, 60.0, 0.1
    ball = Ball((0.0, 0.0, rest()), w=(0.0, 0.0, w0))
    scene = Scene(
        (ball,), friction=0.4, rolling=rolling, wall_model=model,
        wall_settings="torsionTorque on" if torsion else "",
    )  # fmt: skip
    steps = round(time / scripts.DT)
    track = run(scene, tmp_path, steps, steps // 10)
    rates = np.diff(track.w[1:, 0, 2]) / (0.1 * time)
    expected = -2.5 * rolling * G / RADIUS if torsion else 0.0
    np.testing.assert_allclose(rates, expected, rtol=1e-6, atol=0.0)


def test_stacked_pair_keeps_its_energy(tmp_path):
    balls = (Ball((0.0, 0.0, 1.02 * RADIUS)), Ball((0.0, 0.0, 3.04 * RADIUS)))
    scene = Scene(balls, restitution=1.0, friction=0.0, dt=2e-6)
    track = run(scene, tmp_path, 100000, 100)
    z = track.x[:, :, 2]
    floor = np.maximum(RADIUS - z[:, 0], 0.0)
    pair = np.maximum(2.0 * RADIUS - (z[:, 1] - z[:, 0]), 0.0)
    elastic = (
        8.0 / 15.0 * EFFECTIVE * (np.sqrt(RADIUS) * floor**2.5 + np.sqrt(0.5 * RADIUS) * pair**2.5)
    )
    total = track.kinetic() + MASS * G * z.sum(axis=1) + elastic
    assert (floor > 0.0).any()
    assert (pair > 0.0).any()
    # of the energy that moves: both balls fall some tenths of a millimetre again and again
    moving = float(track.kinetic().max() + elastic.max())
    # second-order error of velocity Verlet; no drift
    np.testing.assert_allclose(total, total[0], atol=2e-3 * moving)
    assert abs(total[-100:].mean() - total[:100].mean()) < 5e-4 * moving
