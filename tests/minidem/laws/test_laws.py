"""Closed forms that any sphere simulation must meet, with the tolerance that each deserves.

Sources: textbook mechanics; slip-to-roll, rolling decay and spin impact as collected in the LAMMPS
unit tests; gross sliding as in Chung and Ooi, Granular Matter 13 (2011) 643.
"""

from __future__ import annotations

import numpy as np
import pytest

from tests.minidem.laws import law_scripts as scripts
from tests.minidem.laws.law_scripts import RADIUS, Ball, Scene, run

NO_WEIGHT = (0.0, 0.0, 0.0)
UNDAMPED = "tangential_damping off"
"""LIGGGHTS does not limit the tangential damping by friction; the closed forms know none."""

G = 9.81
EFFECTIVE = 1.0 / (2.0 * (1.0 - scripts.POISSON**2) / scripts.YOUNG)
MASS = 4.0 / 3.0 * np.pi * RADIUS**3 * scripts.DENSITY
REST = RADIUS - (MASS * G / (4.0 / 3.0 * EFFECTIVE * np.sqrt(RADIUS))) ** (2.0 / 3.0)
"""Height at which the weight of a sphere balances the Hertz force of the floor."""


@pytest.mark.parametrize("e", [0.3, 0.6, 0.9, 1.0])
def test_restitution_is_the_given_one(tmp_path, e):
    ball = Ball((0.0, 0.0, 0.006), (0.0, 0.0, -1.0))
    track = run(Scene((ball,), restitution=e, gravity=NO_WEIGHT), tmp_path, 1500)
    # the damping law meets e only within the time resolution of the contact (about 100 steps)
    assert track.v[-1, 0, 2] == pytest.approx(e, rel=5e-3)


def test_hertz_overlap_and_contact_time(tmp_path):
    speed = 1.0
    ball = Ball((0.0, 0.0, RADIUS + 1e-9), (0.0, 0.0, -speed))
    scene = Scene((ball,), restitution=1.0, gravity=NO_WEIGHT, dt=1e-6)
    track = run(scene, tmp_path, 4000, 1)
    z = track.x[:, 0, 2]
    depth = (15.0 * MASS * speed**2 / (16.0 * EFFECTIVE * np.sqrt(RADIUS))) ** 0.4
    assert RADIUS - z.min() == pytest.approx(depth, rel=1e-4)
    inside = np.count_nonzero(z < RADIUS) * 1e-6
    assert inside == pytest.approx(2.94 * depth / speed, rel=5e-3)  # 2.94 is rounded


@pytest.mark.parametrize("angle", [40, 50, 60, 70, 80])
def test_gross_sliding_impact(tmp_path, angle):
    mu, e = 0.092, 0.98  # aluminium oxide on aluminium, test 4 of Chung and Ooi
    total, a = 0.4, np.radians(angle)
    ball = Ball((0.0, 0.0, 0.0052), (total * np.sin(a), 0.0, -total * np.cos(a)))
    scene = Scene(
        (ball,),
        restitution=e,
        friction=mu,
        gravity=NO_WEIGHT,
        dt=2e-6,
        wall_settings=UNDAMPED,
    )
    track = run(scene, tmp_path, 4000)
    vn, vt = total * np.cos(a), total * np.sin(a)
    rebound = track.v[-1, 0, 2] / vn
    assert track.v[-1, 0, 0] == pytest.approx(vt - mu * (1 + rebound) * vn, rel=1e-3)
    spin = 2.5 * mu * (1 + rebound) * vn / RADIUS
    # the lever arm is shorter than the radius by half the overlap, here up to 1 %
    assert track.w[-1, 0, 1] == pytest.approx(spin, rel=2e-2)


def test_two_spheres_without_slip_keep_their_spin(tmp_path):
    # test 7 of Chung and Ooi: equal spins cancel at the contact, so nothing turns them
    balls = (
        Ball((0.0, 0.0, 0.0), (0.2, 0.0, 0.0), (0.0, 0.0, 30.0)),
        Ball((0.0105, 0.0, 0.0), (-0.2, 0.0, 0.0), (0.0, 0.0, -30.0)),
    )
    track = run(Scene(balls, gravity=NO_WEIGHT, floor=False), tmp_path, 3000)
    np.testing.assert_allclose(track.w[-1, :, 2], [30.0, -30.0], rtol=1e-12)
    np.testing.assert_array_equal(track.v[-1, :, 1], 0.0)


def test_sliding_becomes_rolling_at_five_sevenths(tmp_path):
    u0, mu = 0.5, 0.4
    ball = Ball((0.0, 0.0, REST), (u0, 0.0, 0.0))
    track = run(Scene((ball,), friction=mu, wall_settings=UNDAMPED), tmp_path, 8000, 100)
    time = track.step * scripts.DT
    end = 2.0 * u0 / (7.0 * mu * G)
    early = time < 0.9 * end
    np.testing.assert_allclose(track.v[early, 0, 0], u0 - mu * G * time[early], rtol=2e-3)
    # without damping the tangential spring goes on swinging about the rolling speed
    assert track.v[-1, 0, 0] == pytest.approx(5.0 / 7.0 * u0, rel=1e-2)


def test_ball_rolls_down_an_incline_at_five_sevenths(tmp_path):
    slope = np.radians(20.0)
    ball = Ball((0.0, 0.0, RADIUS - 1.0e-5))
    down = (G * np.sin(slope), 0.0, -G * np.cos(slope))
    track = run(Scene((ball,), friction=0.5, gravity=down, restitution=0.1), tmp_path, 20000)
    # mu >= 2/7 tan(slope): no slip; the first millimetres settle the contact
    expected = 5.0 / 7.0 * G * np.sin(slope) * 0.2
    assert track.v[-1, 0, 0] == pytest.approx(expected, rel=5e-3)


def test_rolling_friction_slows_at_its_rate(tmp_path):
    mur, u0 = 0.02, 0.3
    ball = Ball((0.0, 0.0, REST), (u0, 0.0, 0.0), (0.0, u0 / RADIUS, 0.0))
    model = "hertz tangential history rolling_friction cdt"
    track = run(Scene((ball,), rolling=mur, wall_model=model), tmp_path, 20000)
    lost = u0 - track.v[-1, 0, 0]
    # a torque mur m g r on a ball that rolls without slip takes 5/7 mur g from its speed
    assert lost == pytest.approx(5.0 / 7.0 * mur * G * 0.2, rel=1e-2)


def test_terminal_velocity_in_a_viscous_medium(tmp_path):
    drag = 0.05
    ball = Ball((0.0, 0.0, 0.4))
    scene = Scene(
        (ball,), floor=False, more=(f"fix drag all viscous {drag}",), box="-1 1 -1 1 -1 1"
    )
    track = run(scene, tmp_path, 40000, 4000)
    time = track.step * scripts.DT
    limit = MASS * G / drag
    expected = -limit * (1.0 - np.exp(-drag * time / MASS))
    # velocity Verlet with velocity-dependent forces is of first order in dt
    np.testing.assert_allclose(track.v[:, 0, 2], expected, rtol=1e-3, atol=1e-9)


def test_bounces_lose_height_by_the_square_of_restitution(tmp_path):
    e, height = 0.8, 0.05
    ball = Ball((0.0, 0.0, RADIUS + height))
    track = run(Scene((ball,), restitution=e), tmp_path, 60000, 20)
    z = track.x[:, 0, 2] - RADIUS
    peaks = z[1:-1][(z[1:-1] > z[:-2]) & (z[1:-1] >= z[2:])]
    np.testing.assert_allclose(peaks[:2], [height * e**2, height * e**4], rtol=2e-2)


def _pile(number: int, rng: np.random.Generator, spacing: float = 0.0095) -> tuple:
    """Return spheres on a coarse lattice with random velocities."""
    balls = []
    for k in range(number):
        cell = np.array([k % 3, (k // 3) % 3, k // 9], float)
        x = spacing * cell + rng.uniform(-2e-4, 2e-4, 3) + np.array([0.0, 0.0, 0.008])
        balls.append(Ball(tuple(x), tuple(rng.uniform(-0.2, 0.2, 3)), tuple(rng.uniform(-9, 9, 3))))
    return tuple(balls)


MODELS = [
    "hertz tangential history",
    "hertz tangential no_history",
    "hertz tangential history rolling_friction epsd2",
]


@pytest.mark.parametrize("model", MODELS)
def test_momentum_is_kept_and_energy_never_made(tmp_path, rng, model):
    balls = _pile(12, rng, 0.0105)  # no overlap at the start: no hidden elastic energy
    scene = Scene(balls, model=model, floor=False, gravity=NO_WEIGHT, restitution=0.7)
    track = run(scene, tmp_path, 4000, 4000)
    momentum = (track.mass[None, :, None] * track.v).sum(axis=1)
    scale = float((track.mass[:, None] * np.abs(track.v[0])).sum())
    np.testing.assert_allclose(momentum[-1], momentum[0], atol=1e-12 * scale)
    assert track.kinetic()[-1] < track.kinetic()[0]


def test_shifted_frame_sees_the_same_collision(tmp_path, rng):
    balls = _pile(6, rng)
    away = np.array([0.1, -0.07, 0.04])
    moved = tuple(Ball(tuple(np.array(b.x) + away), b.v, b.w) for b in balls)
    tracks = []
    for name, chosen in (("here", balls), ("there", moved)):
        (tmp_path / name).mkdir()
        scene = Scene(chosen, floor=False, gravity=NO_WEIGHT)
        tracks.append(run(scene, tmp_path / name, 1500))
    # coordinates carry about 1e-17 m of rounding, which collisions amplify
    np.testing.assert_allclose(tracks[1].x[-1] - away, tracks[0].x[-1], atol=1e-11)


def test_order_of_particles_does_not_matter(tmp_path, rng):
    balls = _pile(9, rng)
    order = rng.permutation(len(balls))
    tracks = []
    for name, chosen in (("first", balls), ("second", tuple(balls[i] for i in order))):
        (tmp_path / name).mkdir()
        tracks.append(run(Scene(chosen), tmp_path / name, 1500))
    np.testing.assert_allclose(tracks[1].x[-1], tracks[0].x[-1][order], atol=1e-11)


def test_zero_rolling_friction_is_no_rolling_friction(tmp_path, rng):
    balls = _pile(6, rng)
    tracks = []
    for model in (MODELS[0], MODELS[2]):
        folder = tmp_path / str(len(tracks))
        folder.mkdir()
        tracks.append(run(Scene(balls, model=model, rolling=0.0), folder, 1500))
    np.testing.assert_array_equal(tracks[0].x, tracks[1].x)
    np.testing.assert_array_equal(tracks[0].w, tracks[1].w)


def test_periodic_box_keeps_a_collision_across_its_face(tmp_path):
    gap = 0.0102
    inside = (
        Ball((-gap / 2, 0.0, 0.0), (0.3, 0.05, 0.0)),
        Ball((gap / 2, 0.0, 0.0), (-0.3, 0.0, 0.0)),
    )
    across = (
        Ball((0.05 - gap / 2, 0.0, 0.0), (0.3, 0.05, 0.0)),
        Ball((-0.05 + gap / 2, 0.0, 0.0), (-0.3, 0.0, 0.0)),
    )
    tracks = []
    for name, balls in (("inside", inside), ("across", across)):
        (tmp_path / name).mkdir()
        scene = Scene(
            balls, floor=False, gravity=NO_WEIGHT, boundary="p p f",
            box="-0.05 0.05 -0.05 0.05 -0.05 0.05",
        )  # fmt: skip
        tracks.append(run(scene, tmp_path / name, 1500))
    np.testing.assert_allclose(tracks[1].v[-1], tracks[0].v[-1], rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(tracks[1].w[-1], tracks[0].w[-1], rtol=1e-9, atol=1e-12)
