"""Impacts of spheres on a plane in one run, and what the damping of LIGGGHTS means for them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.integrate import solve_ivp

from tests.minidem.laws.law_scripts import Ball, Scene, Track, run

NO_WEIGHT = (0.0, 0.0, 0.0)
UNDAMPED = "tangential_damping off"
RIGID = 1000.0


def stiffness(scene: Scene, *, pair: bool) -> float:
    """Return E* of two balls, or of a ball and the floor, Pa."""
    (a, b), (p, q) = scene.young, scene.poisson
    one = (1.0 - p**2) / a
    return 1.0 / (2.0 * one if pair else one + (1.0 - q**2) / b)


def duration(scene: Scene, speed: float, mass: float, radius: float) -> float:
    """Return the Hertz contact time on the floor, s."""
    e_star = stiffness(scene, pair=False)
    depth = (15.0 * mass * speed**2 / (16.0 * e_star * np.sqrt(radius))) ** 0.4
    return float(2.94 * depth / speed)


def impacts(
    velocities: np.ndarray, folder, scene: Scene, radius: float, density: float, spins=None,
    parts: int = 400, every: int | None = None,
) -> Track:  # fmt: skip
    """Let spheres side by side hit the floor, one per velocity, with `parts` steps a contact.

    Parameters
    ----------
    velocities : ndarray, shape (n, 3)
        m/s.
    spins : ndarray, shape (n, 3), optional
        rad/s.
    """
    normal = np.abs(velocities[:, 2])
    mass = 4.0 / 3.0 * np.pi * radius**3 * density
    times = [duration(scene, speed, mass, radius) for speed in normal]
    dt = min(times) / parts
    spins = np.zeros_like(velocities) if spins is None else spins
    # each touches after one step of the slowest, so that all contacts begin at about the same time
    balls = tuple(
        Ball(
            (5.0 * radius * k, 0.0, radius + dt * normal.max()), tuple(v), tuple(w), radius, density
        )
        for k, (v, w) in enumerate(zip(velocities, spins, strict=True))
    )
    wide = 5.0 * radius * (len(balls) + 1)
    box = f"{-5 * radius} {wide} {-5 * radius} {5 * radius} {-radius} {5 * radius}"
    steps = int(2.0 * max(times) / dt) + int(normal.max() / normal.min()) + 10
    scene = replace(scene, balls=balls, dt=dt, box=box, gravity=NO_WEIGHT, skin=0.5 * radius)
    return run(scene, folder, steps, every or steps)


GLASS = ((48e9, 48e9), (0.20, 0.20), 2800.0)
LIMESTONE = ((20e9, 20e9), (0.25, 0.25), 2500.0)
ALUMINIUM = ((70e9, 70e9 * RIGID), (0.30, 0.30), 2699.0)
MAGNESIUM = ((40e9, 40e9 * RIGID), (0.35, 0.35), 1800.0)
OXIDE = ((380e9, 380e9 * RIGID), (0.23, 0.23), 4000.0)
IRON = ((100e9, 100e9 * RIGID), (0.25, 0.25), 7000.0)


def rebound(alpha: float, *, tension: bool) -> float:
    """Return e of x'' + alpha x^(1/4) x' + x^(3/2) = 0, x(0) = 0, x'(0) = 1, by Runge-Kutta.

    The contact ends where the spheres part, or without `tension` where the force vanishes.
    """

    def force(_time: float, y: np.ndarray) -> float:
        x = max(float(y[0]), 0.0)
        return float(alpha * x**0.25 * y[1] + x**1.5)

    def over(time: float, y: np.ndarray) -> float:
        if time < 0.1:
            return 1.0
        return float(y[0]) if tension else force(time, y)

    over.terminal, over.direction = True, -1.0  # type: ignore[attr-defined]
    found = solve_ivp(
        lambda t, y: [y[1], -force(t, y)], (0.0, 100.0), [0.0, 1.0], events=over,
        rtol=1e-10, atol=1e-12,
    )  # fmt: skip
    return float(-found.y[1, -1])


def nominal_of(alpha: float) -> float:
    """Return the e for which LIGGGHTS damps with `alpha` = -sqrt(5) ln e / sqrt(ln^2 e + pi^2)."""
    b = alpha / np.sqrt(5.0)
    return float(np.exp(-np.pi * b / np.sqrt(1.0 - b * b)))


def damping_of(e: float) -> float:
    return float(-np.sqrt(5.0) * np.log(e) / np.sqrt(np.log(e) ** 2 + np.pi**2))


def thornton(e: float) -> float:
    """Return alpha for which the rebound without tension has restitution e.

    The fit of Thornton, Cummins and Cleary, Powder Technology 233 (2013) 30, table 2, to
    gamma = alpha / (2 sqrt(3/2)).
    """
    fit = (
        -6.918798, -16.41105, 146.8049, -796.4559, 2928.711, -7206.864, 11494.29, -11342.18,
        6276.757, -1489.915,
    )  # fmt: skip
    inner = 0.0
    for h in reversed(fit):
        inner = e * (h + inner)
    gamma = np.sqrt(1.0 / (1.0 - (1.0 + e) ** 2 * np.exp(inner)) - 1.0)
    return float(2.0 * np.sqrt(1.5) * gamma)
