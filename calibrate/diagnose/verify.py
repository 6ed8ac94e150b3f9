"""The engine itself at a fitted point: real residuals instead of the surrogate's."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from calibrate.arrays import Array
from calibrate.diagnose.local import design
from calibrate.diagnose.local.design import Point
from calibrate.diagnose.problem import Observable, Problem, Runner
from calibrate.diagnose.residuals import Residual
from calibrate.diagnose.stack import Stack
from calibrate.scales import backward, forward, slope

# Seeds of a check must not be those of the fit: they count up from here.
CHECK_SEED = 10_001


def engine_residuals(
    stack: Stack, runner: Runner, u: Array, strengths: Mapping[str, float], seeds: int
) -> list[Residual]:
    """Run every experiment at a fitted point with fresh seeds and compare with the data.

    Parameters
    ----------
    stack : Stack
        Its surrogates say how much single runs scatter, from far more runs than these few seeds.
    u : ndarray, shape (n_parameters,)
    strengths : mapping
        Candidate -> strength, empty for the base model.
    seeds : int
        Runs per experiment, at least two.

    Returns
    -------
    list of Residual
        `z_left_out` equals `z`: nothing is refitted here. An observable that fewer than two runs
        show is left out.
    """
    problem: Problem = stack.problem
    rows: list[Residual] = []
    for experiment in problem.order():
        scatter = stack.surrogates[experiment].noise_sd
        on = problem.effects_in(experiment, strengths)
        points = [Point(u, CHECK_SEED + k, on) for k in range(seeds)]
        results = [
            r for r in runner(design.specify(problem, experiment, points)) if r.status == "ok"
        ]
        for one, sd in zip(problem.observed_in(experiment), scatter, strict=True):
            shown = [r.observables.get(one.quantity, np.nan) for r in results]
            usable = [x for x in shown if np.isfinite(forward(one.scale, np.array(x)))]
            if len(usable) >= 2:
                rows.append(_row(one, np.array(usable), sd))
    return rows


def _row(one: Observable, shown: Array, scatter: float) -> Residual:
    """Compare a measured value with runs `shown`, shape (n,), that scatter on the scale."""
    scaled = forward(one.scale, shown)
    mean = float(scaled.mean())
    error = float(max(scatter, 0.0) / np.sqrt(len(scaled)))
    simulated = float(backward(one.scale, np.array(mean)))
    bench = one.sem * slope(one.scale, one.value)
    z = (float(forward(one.scale, np.array(one.value))) - mean) / float(np.hypot(bench, error))
    spread = error / slope(one.scale, simulated)
    return Residual(one.name, one.value, simulated, one.sem, spread, z, z)


def root_mean_square(rows: list[Residual] | tuple[Residual, ...]) -> float:
    """Root mean square of the z of some rows, nan without rows."""
    return float(np.sqrt(np.mean([r.z**2 for r in rows]))) if rows else float("nan")
