"""Fit one more term of the contact law: python benchmarks/causes/oblique_terms.py.

Single impacts of cases/oblique_impact are integrated here on their own, for laws that the engines
do not have, and friction, restitution and the strength of one more term are fitted to 23 numbers.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt
import pandas as pd
from scipy.optimize import least_squares

Array = npt.NDArray[np.float64]
CASE: Final = Path(__file__).resolve().parents[2] / "cases" / "oblique_impact"
RADIUS, DENSITY, SPEED = 2.5e-3, 4000.0, 3.9  # m, kg/m3, m/s
MASS = 4.0 / 3.0 * np.pi * RADIUS**3 * DENSITY
YOUNG = 1.0 / ((1.0 - 0.23**2) / 380e9 + (1.0 - 0.25**2) / 70e9)
SHEAR = 1.0 / (2.0 * 1.77 * 1.23 / 380e9 + 2.0 * 1.75 * 1.25 / 70e9)
STEPS = 100  # of the Hertzian contact time
_TABLES = [
    pd.read_csv(CASE / f"measured_{name}.csv", comment="#").to_numpy(float)
    for name in ("e_t", "spin", "rebound")
]
ANGLE, VALUE, ERROR = np.concatenate(_TABLES).T
WHICH = np.repeat([0, 1, 2], [len(one) for one in _TABLES])
TERMS: Final[dict[str, tuple[float, float, float]]] = {
    "softer tangential spring: k_t times": (0.7, 0.05, 4.0),
    "tangential dashpot, added to that of e": (0.5, 0.0, 20.0),
    "spring that loses force as the contact shrinks": (1.0, 0.0, 1.0),
    "angle of impact off by, deg": (-0.3, -2.0, 2.0),
}
"""Term to the first guess of its strength, and limits."""


def impacts(
    angles: Array, friction: float, e: float, law: Mapping[str, float]
) -> tuple[Array, Array, Array]:
    """Return what the centre keeps of its tangential velocity, spin and angle of rebound.

    Parameters
    ----------
    angles : ndarray, shape (n,)
        Of impact, as they were read, deg.
    friction, e : float
    law : mapping
        Strength by term, see `TERMS`; none of them is LIGGGHTS' ``tangential history``.
    """
    soft, dashpot, shrinks, off = (law.get(name, neutral) for name, neutral in _NEUTRAL.items())
    read, angle = np.radians(angles), np.radians(angles + off)
    vx, vz = SPEED * np.sin(angle), -SPEED * np.cos(angle)
    depth = (15.0 * MASS * SPEED**2 / (16.0 * YOUNG * np.sqrt(RADIUS))) ** 0.4
    dt = 2.94 * depth / SPEED / STEPS
    damping = 2.0 * np.sqrt(5.0 / 6.0) * -np.log(e) / np.hypot(np.log(e), np.pi)
    z, spin, slip, spring, before = (np.zeros_like(angle) for _ in range(5))
    for k in range(8 * STEPS):
        z = z + vz * dt
        overlap = np.maximum(-z, 0.0)
        touch = overlap > 0.0
        if k and not touch.any():
            break
        root, arm = np.sqrt(RADIUS * overlap), RADIUS - 0.5 * overlap
        normal = 4.0 / 3.0 * YOUNG * root * overlap
        normal = (normal - damping * np.sqrt(2.0 * YOUNG * root * MASS) * vz) * touch
        kt = np.maximum(8.0 * SHEAR * root * soft, 1e-30)
        patch = vx - arm * spin
        slip = slip + patch * dt * touch
        # A spring of the present stiffness, or one that keeps its force but where that falls.
        kept = spring * np.where((kt < before) & touch, kt / np.maximum(before, 1e-30), 1.0)
        spring = (1.0 - shrinks) * -kt * slip + shrinks * (kept - kt * patch * dt * touch)
        limit = friction * np.abs(normal)
        slides = np.abs(spring) > limit
        spring = np.where(slides, np.sign(spring) * limit, spring)
        slip, before = np.where(slides, -spring / kt, slip), kt
        damped = spring - (damping + dashpot) * np.sqrt(kt * MASS) * patch
        force = np.where(slides, spring, np.clip(damped, -limit, limit)) * touch
        vx, vz = vx + force / MASS * dt, vz + normal / MASS * dt
        spin = spin - arm * force / (0.4 * MASS * RADIUS**2) * dt
    return vx / (SPEED * np.sin(read)), spin, np.degrees(np.arctan2(vx, vz))


_NEUTRAL: Final = dict(zip(TERMS, (1.0, 0.0, 0.0, 0.0), strict=True))


def distances(friction: float, e: float, law: Mapping[str, float]) -> Array:
    """Return all distances to what was measured in standard errors, (23,)."""
    found = np.stack(impacts(ANGLE, friction, e, law))
    return (found[WHICH, np.arange(len(ANGLE))] - VALUE) / ERROR


def main() -> None:
    """Print the table."""
    print("| term | strength | mu | e | misfit |\n|---|---|---|---|---|")
    for term in (None, *TERMS):
        start, low, high = [0.092, 0.97], [0.01, 0.8], [0.5, 0.999]
        if term:
            for ends, value in zip((start, low, high), TERMS[term], strict=True):
                ends.append(value)

        def left(x: Array, term: str | None = term) -> Array:
            return distances(x[0], x[1], {term: x[2]} if term else {})

        best = least_squares(left, np.clip(start, low, high), bounds=(low, high), diff_step=1e-3)
        strength = f"{best.x[2]:.2f}" if term else ""
        print(
            f"| {term or 'none'} | {strength} | {best.x[0]:.3f} | {best.x[1]:.3f} | "
            f"{2.0 * best.cost:.0f} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
