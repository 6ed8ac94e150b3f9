"""The recipe of DEcalioc and of Grobbel et al. 2019: a Latin hypercube, Kriging, one optimum.

Stage by stage as in the paper (`cases/proppants/hsp13_steel.toml`): two parameters are free, the
later ones held at the study's values, the earlier ones at what was found. Each observable gets a
Kriging model with linear trend, anisotropic Matern correlation and estimated noise, the defaults
of DEcalioc (`createKrigingModels.m`); the answer is the least sum of squared relative residuals
(`costFunction.m`, eq. 18 of the paper) over the whole box. smt's Kriging takes the place of
Octave's stk. DEcalioc would go on with the engine from there; the paper does not, and neither does
this.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final, NamedTuple

import numpy as np
from scipy.optimize import differential_evolution
from scipy.stats import qmc

from benchmarks.peers.problem import Answer, Array, Problem
from calibrate.staged.surrogates.kriging import train_kriging


class _Stage(NamedTuple):
    free: tuple[str, ...]
    targets: tuple[str, ...]


STAGES: Final = (
    _Stage(("mu_pp", "mu_roll_pp"), ("angle_glued", "t100_glued")),
    _Stage(("mu_pw", "mu_roll_pw"), ("angle_steel", "t100_steel")),
    _Stage(("e_pp", "e_pw"), ("m1_steel", "m2_steel", "m3_steel")),
)
HELD: Final = {"mu_pw": 0.35, "mu_roll_pw": 0.2, "e_pp": 0.6, "e_pw": 0.6}
"""Values before a stage frees them, those of the shipped study."""


class Decalioc:
    """Latin hypercube per stage, Kriging, one optimum.

    A budget of n is n points in each stage: two places, two places and one, so that three stages
    cost n parameter vectors. The paper has n = 100. A smaller budget is a study of its own, since
    no part of a Latin hypercube is one.
    """

    name = "decalioc"
    sequential = False

    def solve(
        self, problem: Problem, budgets: Sequence[int], rng: np.random.Generator
    ) -> Iterator[Answer]:
        """Yield the optimum of a study of each size."""
        for budget in budgets:
            before = vars(problem.cost).copy()
            theta = _calibrate(problem, budget, rng)
            spent = {name: value - before[name] for name, value in vars(problem.cost).items()}
            yield Answer(budget, theta, None, **spent)


def _calibrate(problem: Problem, points: int, rng: np.random.Generator) -> Array:
    """Return the parameters after three stages."""
    names, bounds = problem.names, problem.bounds
    theta = bounds.mean(axis=1)
    for name, value in HELD.items():
        theta[names.index(name)] = value
    for stage in STAGES:
        free = [names.index(name) for name in stage.free]
        unit = qmc.LatinHypercube(len(free), rng=rng).random(points)
        low, high = bounds[free].T
        y = []
        for u in unit:
            theta[free] = low + (high - low) * u
            y.append(problem.simulate(theta, stage.targets))
        measured = np.array([problem.measured[name] for name in stage.targets])
        theta[free] = low + (high - low) * _optimum(unit, np.array(y), measured, rng)
    return theta


def _optimum(u: Array, y: Array, measured: Array, rng: np.random.Generator) -> Array:
    """Return the point of the unit square with the least squared relative residuals."""
    whole = np.isfinite(y).all(axis=1)  # a run without a value is left out, as DEcalioc does
    seed = int(rng.integers(2**31))
    models = [
        train_kriging(u[whole], column, ("matern52", "linear"), seed, {"eval_noise": True})
        for column in y[whole].T
    ]

    def cost(points: Array) -> Array:
        predicted = np.column_stack([model.predict_values(points.T)[:, 0] for model in models])
        return np.asarray(np.sum(((predicted - measured) / measured) ** 2, axis=1))

    found = differential_evolution(
        cost, [(0.0, 1.0)] * u.shape[1], rng=rng, vectorized=True, updating="deferred", polish=False
    )
    return np.asarray(found.x)
