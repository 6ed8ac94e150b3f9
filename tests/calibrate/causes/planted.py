"""A rig of formulas with the bends of real responses, and studies with a hidden cause."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.candidates import Board, Candidate
from calibrate.inference.priors import Prior
from tests.calibrate.causes.formula import Formula, board

SE: Final = np.array([0.4, 0.5, 0.02, 0.02, 0.1, 0.1, 0.1])
"""Errors of two angles, two logarithms of times, three roots of masses."""
EMULATOR: Final = 0.3
"""Standard deviation of the emulators, in those of the measurements."""
REPEATS: Final = 6
CANDIDATES: Final = (
    Candidate(
        "tilt", "tilt", 1.0, -6.0, 6.0, ((0, 0),), title="a tilted plate", unit="deg",
        settled_by="a level", settled_se=0.1, settled_hours=0.1,
    ),
    Candidate(
        "flow", "flow", 0.05, -0.3, 0.3, ((0, 1),), title="a wrong flow",
        settled_by="a scale", settled_se=0.01, settled_hours=0.5,
    ),
    Candidate(
        "cohesion", "cohesion", 10.0, 0.0, 60.0, ((0, 2),), settled_by="a shear cell",
        settled_se=2.0, settled_hours=8.0,
    ),
    Candidate("wear", "wear", 1.0, -6.0, 6.0, ((0, 3),)),
)  # fmt: skip
"""Cohesion has one sign; wear is what friction between grain and wall does, and cannot be seen."""


def expected(u: Array, s: Array) -> Array:
    """Return the seven numbers for friction, wall friction and restitution on [0, 1]."""
    f, w, e = (u + np.column_stack([0.0 * s[:, 3], 0.05 * s[:, 3], 0.0 * s[:, 3]])).T
    tilt, flow, cohesion = s[:, 0], s[:, 1], s[:, 2]
    return np.column_stack(
        [
            30.0 + 8.0 * np.sqrt(f + 0.05) + 3.0 * w + 0.9 * cohesion,
            34.0 + 9.0 * np.sqrt(f + 0.05) + 0.3 * cohesion,
            2.2 + 0.5 * w + 0.1 * f * w - 0.05 * tilt - 0.04 * flow,
            2.7 + 0.25 * f - 0.10 * tilt - 0.02 * flow + 0.02 * cohesion,
            5.5 - 1.5 * e - 0.3 * w,
            3.0 + 1.2 * np.sin(2.0 * e) - 0.10 * cohesion,
            1.0 + 1.5 * e**2,
        ]
    )


def study(
    hidden: Mapping[str, float], rng: np.random.Generator, shift: Array | float = 0.0
) -> Board:
    """Return a study whose data hide effects, in ordinary strengths.

    Parameters
    ----------
    hidden : mapping
        Candidate to its strength; may be empty.
    rng : Generator
    shift : (7,) float64
        What is wrong besides, in standard errors.
    """
    u = rng.uniform(0.2, 0.8, (1, 3))
    s = np.array([[hidden.get(one.name, 0.0) for one in CANDIDATES]])
    dof = REPEATS - 1
    stated = SE * np.sqrt(rng.chisquare(dof, len(SE)) / dof)
    y = expected(u, s)[0] + shift * SE
    y = y + SE * (rng.standard_normal(len(SE)) + EMULATOR * rng.standard_normal(len(SE)))
    return board(
        Formula(expected, (EMULATOR * SE) ** 2),
        y,
        stated,
        CANDIDATES,
        priors=[Prior.uniform(0.0, 1.0)] * 3,
        effects=len(CANDIDATES),
        repeats=REPEATS,
    )
