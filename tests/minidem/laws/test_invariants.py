"""What every contact law must keep: momenta, energy, independence of the frame; order in dt."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from minidem import ScriptError
from tests.minidem.laws.law_scripts import RADIUS, Ball, Scene, Track, run

NO_WEIGHT = (0.0, 0.0, 0.0)
MODELS = [
    "hertz tangential history",
    "hertz tangential no_history",
    "hertz tangential history rolling_friction epsd2",
]
PAIRS = 150


def collisions(rng: np.random.Generator) -> tuple[Ball, ...]:
    """Return pairs of spheres far from each other that meet at random angles, with spin."""
    balls = []
    for k in range(PAIRS):
        place = np.array([(k % 15) * 0.05 - 0.35, (k // 15) * 0.05 - 0.25, 0.0])
        way = rng.normal(size=3)
        way /= np.linalg.norm(way)
        across = rng.normal(size=3)
        v = -rng.uniform(0.1, 1.0) * way + 0.5 * (across - (across @ way) * way)
        spins = 60.0 * rng.normal(size=(2, 3))
        balls.append(Ball(tuple(place), tuple(-0.5 * v), tuple(spins[0])))
        there = place + 0.01001 * way
        balls.append(Ball(tuple(there), tuple(0.5 * v), tuple(spins[1]), 1.0 * RADIUS, 3000.0))
    return tuple(balls)


def scene_of(balls: tuple[Ball, ...], model: str = MODELS[0], **changes) -> Scene:
    return Scene(
        balls, model=model, floor=False, gravity=NO_WEIGHT, box="-0.8 0.8 -0.8 0.8 -0.8 0.8",
        dt=5e-6, **changes,
    )  # fmt: skip


def per_pair(values: np.ndarray) -> np.ndarray:
    """Sum over both spheres of each pair; values of shape (frames, spheres, ...)."""
    return values.reshape(len(values), PAIRS, 2, *values.shape[2:]).sum(axis=2)


def energies(track: Track) -> np.ndarray:
    """Return the kinetic energy of each pair, J, shape (frames, pairs)."""
    inertia = 0.4 * track.mass * track.radius**2
    moving = track.mass * (track.v**2).sum(axis=2) + inertia * (track.w**2).sum(axis=2)
    return per_pair(0.5 * moving)


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("restitution", [0.7, 1.0])
def test_a_collision_keeps_momenta_and_gains_no_energy(tmp_path, rng, model, restitution):
    scene = scene_of(collisions(rng), model, restitution=restitution, friction=1.0)
    track = run(scene, tmp_path, 3000)
    apart = np.diff(track.x[-1].reshape(PAIRS, 2, 3), axis=1)
    assert (np.linalg.norm(apart, axis=2) > 2.0 * RADIUS).all()  # all contacts are over
    mass = track.mass[:, None]
    inertia = 0.4 * mass * track.radius[:, None] ** 2
    linear = per_pair(mass * track.v)
    angular = per_pair(np.cross(track.x, mass * track.v) + inertia * track.w)
    # rounding of 600 steps in contact
    for momentum in (linear, angular):
        np.testing.assert_allclose(momentum[-1], momentum[0], atol=1e-10 * np.abs(momentum).max())
    energy = energies(track)
    # the tangential spring follows the present overlap, as in LIGGGHTS, and is not conservative:
    # it may give back 1e-4 more than it took
    assert (energy[-1] / energy[0]).max() < 1.0 + 5e-4
    assert np.median(energy[-1] / energy[0]) < (1.0 + 1e-6 if restitution == 1.0 else 0.9)


def test_without_friction_an_elastic_collision_keeps_the_energy(tmp_path, rng):
    scene = scene_of(collisions(rng), restitution=1.0, friction=0.0)
    energy = energies(run(replace(scene, dt=1e-6), tmp_path, 15000))
    # second-order error of velocity Verlet with about 500 steps a contact
    np.testing.assert_allclose(energy[-1], energy[0], rtol=1e-6)


def _rotation() -> np.ndarray:
    """Return a rotation by 0.7 about the axis (1, 2, 2) / 3 (Rodrigues)."""
    a, b, c = np.array([1.0, 2.0, 2.0]) / 3.0
    cross = np.array([[0.0, -c, b], [c, 0.0, -a], [-b, a, 0.0]])
    whole: np.ndarray = np.eye(3) + np.sin(0.7) * cross + (1.0 - np.cos(0.7)) * cross @ cross
    return whole


TURN, BOOST = _rotation(), np.array([0.3, -0.2, 0.1])
MIRROR = np.diag([-1.0, 1.0, 1.0])
FRAMES = {
    "turned": lambda x, v, w: (TURN @ x, TURN @ v, TURN @ w),
    "moving": lambda x, v, w: (x, v + BOOST, w),
    "mirrored": lambda x, v, w: (MIRROR @ x, MIRROR @ v, -MIRROR @ w),
}


@pytest.mark.parametrize("frame", sorted(FRAMES))
def test_another_frame_sees_the_same_collisions(tmp_path, rng, frame):
    change: Callable = FRAMES[frame]
    balls = collisions(rng)
    tracks = []
    for name in ("here", frame):
        (tmp_path / name).mkdir()
        chosen = balls
        if name == frame:
            chosen = tuple(
                Ball(
                    *(tuple(a) for a in change(*map(np.array, (b.x, b.v, b.w)))),
                    b.radius,
                    b.density,
                )
                for b in balls
            )
        tracks.append(run(scene_of(chosen, MODELS[2]), tmp_path / name, 3000))
    rows = zip(tracks[0].x[-1], tracks[0].v[-1], tracks[0].w[-1], strict=True)
    expected = [change(*row) for row in rows]
    # coordinates of 0.5 m carry 1e-16 of rounding, contacts of 1e-5 m amplify it
    np.testing.assert_allclose(tracks[1].v[-1], [row[1] for row in expected], atol=1e-9)
    np.testing.assert_allclose(tracks[1].w[-1], [row[2] for row in expected], atol=1e-6)


def rebounds(folder: Path, restitution: float, dt: float) -> np.ndarray:
    """Return the rebound speeds of spheres that reach the floor at different parts of a step."""
    count = 24
    balls = tuple(
        Ball((0.02 * k - 0.25, 0.0, RADIUS + 1.37e-5 * (1.0 + k / count)), (0.0, 0.0, -1.0))
        for k in range(count)
    )
    scene = Scene(balls, restitution=restitution, friction=0.0, gravity=NO_WEIGHT, dt=dt)
    folder.mkdir()
    return run(scene, folder, round(2.4e-3 / dt)).v[-1, :, 2]


@pytest.mark.parametrize(("restitution", "order"), [(1.0, 2.0), (0.7, 1.0), (0.3, 1.0)])
def test_error_of_an_impact_falls_with_the_order_of_the_scheme(tmp_path, restitution, order):
    # velocity Verlet: second order; first order with damping, which sees the half-step velocity
    steps = np.array([8e-6, 4e-6, 2e-6, 1e-6, 5e-7])
    errors = []
    for k, dt in enumerate(steps):
        found = rebounds(tmp_path / str(k), restitution, dt) - restitution
        errors.append(abs(found.mean()) if order == 1.0 else np.sqrt((found**2).mean()))
    slope = np.polyfit(np.log(steps), np.log(errors), 1)[0]
    # the step in which a contact begins and ends adds some scatter
    assert slope == pytest.approx(order, abs=0.25)
    assert errors[-1] < 1e-4


def test_what_a_wall_keeps_for_others_changes_no_path(tmp_path):
    """LIGGGHTS 3.8.0 takes these words before and behind the wall, and computes the same."""
    ball = (Ball((0.0, 0.0, 1.01 * RADIUS), (0.3, 0.0, -0.5)),)
    words = "store_force no store_force_contact yes store_force_contact_every 7 track_energy"
    paths = []
    for name, more in (("plain", ""), ("kept", words)):
        (tmp_path / name).mkdir()
        paths.append(run(Scene(ball, wall_settings=more), tmp_path / name, 300).x)
    assert np.array_equal(*paths)


@pytest.mark.parametrize(
    ("lines", "covered"),
    [
        ("pair_coeff 1 1", False),
        ("pair_coeff 2 2", False),
        ("pair_coeff 1 2\npair_coeff 1 1", False),
        ("pair_coeff 2 2\npair_coeff * 1", True),
        ("pair_coeff 1* *2", True),
    ],
)
def test_every_type_needs_a_coefficient_with_itself(tmp_path, lines, covered):
    """As in LIGGGHTS 3.8.0, which has no other use for the types."""
    style = f"pair_style gran model {MODELS[0]}\n"
    scene = Scene((Ball((0.0, 0.0, 0.1)),), more=(style + lines,))
    if covered:
        run(scene, tmp_path, 1)
        return
    with pytest.raises(ScriptError, match="All pair coeffs are not set"):
        run(scene, tmp_path, 1)
