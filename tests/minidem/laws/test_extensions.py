"""Effects that LIGGGHTS lacks: closed forms, nothing without strength, going on after a restart."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from minidem import ScriptError, run_script
from minidem.contact.extensions import EXTENSIONS
from tests.minidem.laws.law_scripts import RADIUS, Ball, Scene, run

NO_WEIGHT = (0.0, 0.0, 0.0)
G = 9.81
MODEL = "hertz tangential history rolling_friction epsd2"


def pair(name: str, value: float) -> str:
    return (
        f"fix x{name} all property/global {name} peratomtypepair 2 {value} {value} {value} {value}"
    )


def static(ratio: float, kinetic: float, speed: float = 0.01) -> dict:
    """Return what switches static friction on."""
    lines = (
        pair("coefficientStaticFriction", ratio * kinetic),
        f"fix xspeed all property/global weakeningVelocity scalar {speed}",
    )
    return {"settings": "staticFriction on", "more": lines}


def slowing(exponent: float, speed: float = 0.1) -> dict:
    """Return what switches velocity-dependent restitution on."""
    lines = (
        pair("restitutionExponent", exponent),
        f"fix xspeed all property/global restitutionVelocity scalar {speed}",
    )
    return {"settings": "velocityRestitution on", "more": lines}


def scattering(deviation: float) -> dict:
    """Return what switches restitution that scatters on."""
    return {"settings": "restitutionScatter on", "more": (pair("restitutionDeviation", deviation),)}


def softening(factor: float) -> dict:
    """Return what switches another tangential stiffness on."""
    lines = (pair("tangentialStiffnessFactor", factor),)
    return {"settings": "tangentialStiffness on", "more": lines}


def air(words: str = "") -> str:
    return f"fix air all drag/sphere density 1.204 viscosity 1.81e-5 {words}"


def heap(rng: np.random.Generator, number: int = 30) -> tuple[Ball, ...]:
    """Return spheres that fall on the floor and on each other."""
    cells = np.array([(k % 3, (k // 3) % 3, k // 9) for k in range(number)], float)
    x = 0.0105 * cells + rng.uniform(-1e-4, 1e-4, (number, 3)) + np.array([0.0, 0.0, 0.006])
    v, w = rng.uniform(-0.3, 0.3, (number, 3)), rng.uniform(-9, 9, (number, 3))
    return tuple(Ball(tuple(a), tuple(b), tuple(c)) for a, b, c in zip(x, v, w, strict=True))


@pytest.mark.parametrize("word", sorted(EXTENSIONS))
def test_without_strength_the_result_is_that_of_the_base_model(tmp_path, rng, word):
    balls = heap(rng)
    base = Scene(balls, model=MODEL)
    off = {
        "staticFriction": static(1.0, base.friction),
        "velocityRestitution": slowing(0.0),
        "restitutionScatter": scattering(0.0),
        "tangentialStiffness": softening(1.0),
        "drag/sphere": {"more": (air("factor 0"),)},
    }[word]
    tracks = []
    for name, scene in (("base", base), ("off", replace(base, **off))):
        (tmp_path / name).mkdir()
        tracks.append(run(scene, tmp_path / name, 3000))
    for name in ("x", "v", "w"):
        np.testing.assert_array_equal(getattr(tracks[0], name), getattr(tracks[1], name))


@pytest.mark.parametrize("settings", ["", "neigh_modify delay 0 contact_distance_factor 1.01"])
def test_the_loop_of_extended_pairs_has_the_physics_of_the_base_loop(tmp_path, rng, settings):
    # restitution falls above a speed that no impact reaches: the extended loop, the base physics
    base = Scene(heap(rng), model=MODEL, more=(settings,))
    on = slowing(0.25, 1e6)
    tracks = []
    for name, scene in (
        ("base", base),
        ("on", replace(base, **on | {"more": (settings, *on["more"])})),
    ):
        (tmp_path / name).mkdir()
        tracks.append(run(scene, tmp_path / name, 3000))
    # the sums have the same order today; another order would show as rounding that impacts amplify
    np.testing.assert_allclose(tracks[1].x, tracks[0].x, atol=1e-11)
    np.testing.assert_allclose(tracks[1].w, tracks[0].w, atol=1e-6)


@pytest.mark.parametrize("speed", [0.05, 0.4, 2.0])
@pytest.mark.parametrize("wall", [True, False])
def test_restitution_follows_the_impact_speed(tmp_path, speed, wall):
    e, exponent, reference = 0.8, 0.25, 0.1
    expected = e * (max(speed, reference) / reference) ** -exponent
    if wall:
        balls = (Ball((0.0, 0.0, 0.00501), (0.0, 0.0, -speed)),)
    else:
        balls = (
            Ball((0.0, 0.0, 0.1), (0.0, 0.0, 0.5 * speed)),
            Ball((0.0, 0.0, 0.11001), (0.0, 0.0, -0.5 * speed)),
        )
    scene = Scene(balls, restitution=e, gravity=NO_WEIGHT, floor=wall, dt=2e-6)
    tracks = []
    for name, more in (
        ("extended", slowing(exponent, reference)),
        ("base", {"restitution": expected}),
    ):
        (tmp_path / name).mkdir()
        tracks.append(run(replace(scene, **more), tmp_path / name, 6000))
    v = tracks[0].v[-1, :, 2]
    found = v[0] / speed if wall else (v[1] - v[0]) / speed
    # the damping law meets e within the time resolution of the contact (about 300 steps)
    assert found == pytest.approx(expected, rel=3e-3)
    # the same damping as the base model with that restitution: only rounding differs
    np.testing.assert_allclose(tracks[0].v, tracks[1].v, rtol=1e-9)


def test_every_bounce_has_the_restitution_of_its_own_impact(tmp_path):
    e, exponent, reference = 0.9, 0.25, 0.45
    ball = Ball((0.0, 0.0, 0.0051), (0.0, 0.0, -1.0))
    scene = Scene(
        (ball,), restitution=e, gravity=NO_WEIGHT, dt=2e-6, **slowing(exponent, reference)
    )
    ceiling = (
        f"fix ceiling all wall/gran model {scene.model} primitive type 2 zplane 0.02 "
        f"{scene.settings}"
    )
    track = run(replace(scene, more=(*scene.more, ceiling)), tmp_path, 60000, 100)
    inside = np.abs(track.x[:, 0, 2] - 0.01) < 0.01 - RADIUS  # no contact
    speed = np.abs(track.v[inside, 0, 2])
    found = speed[np.append(True, np.diff(speed) != 0.0)][:6]
    expected = [1.0]
    while len(expected) < 6:
        expected.append(expected[-1] * e * (max(expected[-1], reference) / reference) ** -exponent)
    assert expected[3] > reference > expected[5]  # both branches are met
    # the damping law meets e within the time resolution of the contact; five impacts
    np.testing.assert_allclose(found, expected, rtol=5e-3)


def _slope(tmp_path, angle: float, kinetic: float, ratio: float) -> np.ndarray:
    """Return the velocities of three balls side by side on an incline; they cannot roll."""
    a = np.radians(angle)
    balls = (Ball((0.0, 0.0, RADIUS - 1e-5)),)
    down = (G * np.sin(a), 0.0, -G * np.cos(a))
    scene = Scene(
        balls, friction=kinetic, rolling=10.0, model=MODEL, gravity=down, restitution=0.1,
        **static(ratio, kinetic),
    )  # fmt: skip
    return run(scene, tmp_path, 20000).v[-1, 0]


def test_ball_that_cannot_roll_rests_up_to_the_static_angle(tmp_path):
    # tan 24 deg = 0.445 is between 0.3 and 0.6
    v = _slope(tmp_path, 24.0, 0.3, 2.0)
    assert np.abs(v).max() < 1e-4


def test_beyond_the_static_angle_it_slides_with_kinetic_friction(tmp_path):
    kinetic, angle, speed, time = 0.3, 35.0, 0.01, 0.2
    v = _slope(tmp_path, angle, kinetic, 2.0)
    a = np.radians(angle)
    # dv/dt = g (sin - mu(v) cos) from rest, with mu(v) = mu_k + mu_k exp(-v / v_c)
    expected, steps = 0.0, 20000
    for _ in range(steps):
        mu = kinetic + kinetic * np.exp(-expected / speed)
        expected += G * (np.sin(a) - mu * np.cos(a)) * time / steps
    # the first milliseconds settle the contact under its weight
    assert v[0] == pytest.approx(expected, rel=1e-2)


@pytest.mark.parametrize("diameter", [1.595e-3, 0.603e-3])
def test_terminal_velocity_of_sintered_bauxite_in_air(tmp_path, diameter):
    rho, viscosity, density = 1.204, 1.81e-5, 3560.0

    def terminal(coefficient) -> float:
        """Return the fixed point of m g = C_D rho pi d^2 / 8 v^2."""
        v = 5.0
        for _ in range(200):
            drag = coefficient(rho * v * diameter / viscosity)
            v = np.sqrt(4.0 / 3.0 * density * diameter * G / (rho * drag))
        return float(v)

    v = terminal(lambda re: 0.44 if re > 1000.0 else 24.0 / re * (1.0 + 0.15 * re**0.687))
    # another fit to the drag of spheres: Haider and Levenspiel, Powder Technology 58 (1989) 63;
    # both describe the measurements within some per cent
    other = terminal(
        lambda re: 24.0 / re * (1.0 + 0.1806 * re**0.6459) + 0.4251 / (1.0 + 6880.95 / re)
    )
    assert v == pytest.approx(other, rel=0.03)
    fast = Ball((0.0, 0.0, 30.0), (0.0, 0.0, -v), radius=0.5 * diameter, density=density)
    rest = Ball((1.0, 0.0, 30.0), radius=0.5 * diameter, density=density)
    blown = Ball((2.0, 0.0, 30.0), (3.0, 0.0, -v), radius=0.5 * diameter, density=density)
    for name, balls, words in (
        ("still", (fast, rest), ""),
        ("wind", (blown,), "velocity 3.0 0.0 0.0"),
    ):
        (tmp_path / name).mkdir()
        scene = Scene(balls, floor=False, box="-9 99 -1 1 -99 40", dt=1e-4, more=(air(words),))
        track = run(scene, tmp_path / name, 60000)
        # from rest 2 exp(-2 g t / v) = 1e-4 of the speed are missing after 6 s
        np.testing.assert_allclose(track.v[-1, :, 2], -v, rtol=2e-4)
        np.testing.assert_allclose(track.v[-1, :, 0], balls[0].v[0], rtol=1e-12, atol=1e-12)


def test_drag_is_that_of_stokes_at_low_reynolds_number(tmp_path):
    radius, viscosity = 1e-3, 1.0
    mass = 4.0 / 3.0 * np.pi * radius**3 * 2500.0
    ball = Ball((0.0, 0.0, 0.4), radius=radius)
    scene = Scene(
        (ball,), floor=False, dt=1e-7,
        more=(f"fix oil all drag/sphere density 1e-3 viscosity {viscosity}",),
    )  # fmt: skip
    track = run(scene, tmp_path, 20000, 2000)
    time = track.step * 1e-7
    rate = 6.0 * np.pi * viscosity * radius
    expected = -mass * G / rate * (1.0 - np.exp(-rate * time / mass))
    # Re = 1e-8: the correction is 5e-7; velocity Verlet with drag is of first order in dt
    np.testing.assert_allclose(track.v[:, 0, 2], expected, rtol=1e-3, atol=1e-12)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (static(0.5, 0.4), "coefficientStaticFriction is below coefficientFriction"),
        (static(2.0, 0.4, 0.0), "weakeningVelocity is 0 m/s; it must be above zero"),
        (slowing(-0.1), "restitutionExponent is negative"),
        (scattering(-0.1), "restitutionDeviation is negative; give a standard deviation"),
        (softening(0.0), "tangentialStiffnessFactor must be above zero; 1 is the stiffness"),
        ({"settings": "staticFriction on"}, "coefficientStaticFriction as requested by staticFric"),
        (
            {"settings": "restitutionScatter on"},
            "restitutionDeviation as requested by restitutionSc",
        ),
        ({"settings": "staticFrction on"}, "did you mean 'staticFriction'?"),
    ],
)
def test_bad_values_of_a_contact_law_are_named(tmp_path, words, message):
    scene = Scene((Ball((0.0, 0.0, 0.1)),), **words)
    with pytest.raises(ScriptError) as error:
        run(scene, tmp_path, 1)
    assert message in str(error.value)


@pytest.mark.parametrize("on", [slowing(0.25, 0.05), scattering(0.3)], ids=["slows", "scatters"])
def test_extended_contacts_go_on_after_a_restart(tmp_path, rng, on):
    scene = Scene(heap(rng, 12), model=MODEL, **on)
    text = scene.text(2000, 2000)
    (tmp_path / "in.first").write_text(text + "write_restart half.restart\nrun 2000\n")
    run_script(tmp_path / "in.first", root=tmp_path)
    first = (tmp_path / "out.dump").read_text().splitlines()[-12:]
    kept = [
        line
        for line in text.splitlines()
        if not line.startswith(("create_", "set ", "region", "boundary", "run"))
    ]
    at = kept.index("neighbor 0.002 bin")
    kept.insert(at, "read_restart half.restart")
    (tmp_path / "in.second").write_text("\n".join([*kept, "run 2000", ""]))
    run_script(tmp_path / "in.second", root=tmp_path)
    assert (tmp_path / "out.dump").read_text().splitlines()[-12:] == first
