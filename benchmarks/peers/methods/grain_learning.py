"""GrainLearning's iterative Bayesian filter (H. Cheng et al., CMAME 350, 2019, 268-294).

Settings are those of the package's DEM tutorials: Halton points first, an effective sample size of
0.3, a Gaussian mixture of at most five tied components, slice sampling. Samples per iteration: 20
as in its small tutorials (five iterations in a hundred runs), or 50, its rule 5 d log d for six
parameters (two iterations).

Observables are handed over as differences from the measured in standard errors, around one:
the filter multiplies variances by the square of the observation and searches its sigma with an
absolute tolerance of 0.01, so that in the observables' own units it would stop at a sigma far above
what the data allow. It ends by itself when it agrees to one standard error (`sigma_tol`).
"""

from __future__ import annotations

import contextlib
import io
import signal
import warnings
from collections.abc import Iterator, Sequence
from typing import Any, Final

import numpy as np

from benchmarks.peers.problem import Answer, Array, Problem, answer

LEVELS: Final = (0.05, 0.95)
LOST: Final = (
    100.0  # standard errors: the filter has no word for a failed run, so it is put far off
)
MOST_CPU_S: Final = 900.0  # of an iteration; its simulations take 75 s at most
LARGEST_SIGMA: Final = 1e5  # variance in squared standard errors that is certainly enough


class GrainLearning:
    """Iterative Bayesian filter with resampling from a Gaussian mixture.

    Parameters
    ----------
    samples : int
        Parameter vectors per iteration.
    """

    sequential = True

    def __init__(self, samples: int) -> None:
        self.name = f"grainlearning-{samples}"
        self._samples = samples

    def solve(
        self, problem: Problem, budgets: Sequence[int], rng: np.random.Generator
    ) -> Iterator[Answer]:
        """Yield mean and quantiles of the last weighted ensemble at each budget."""
        calibration = _set_up(problem, self._samples, int(rng.integers(2**31)))
        latest: tuple[Array, Array] | None = None
        spent, done = 0, False
        for budget in budgets:
            while not done and spent + self._samples <= budget:
                before = calibration.inference.posterior
                done = _iterate(calibration)
                spent += self._samples
                if calibration.inference.posterior is not before:
                    latest = _estimate(calibration)
            if latest is not None:
                yield answer(problem, budget, *latest)


def _set_up(problem: Problem, samples: int, seed: int) -> Any:
    """Return GrainLearning's object for this problem."""
    from grainlearning import BayesianCalibration, DynamicSystem  # an optional extra

    middle = np.linspace(1.0, 1.01, len(problem.measured))  # not all equal: it divides by the range

    def run(calibration: Any) -> None:
        inside = np.clip(calibration.system.param_data, *problem.bounds.T)  # it rounds at the edge
        rows = [problem.standardised(problem.simulate(x)) for x in inside]
        shifted = middle + np.where(np.isfinite(rows), rows, LOST)
        calibration.system.set_sim_data(shifted[:, :, None])

    return BayesianCalibration.from_dict(
        {
            "num_iter": 1,
            "callback": run,
            "save_fig": -1,
            "system": {
                "system_type": DynamicSystem,
                "param_names": list(problem.names),
                "param_min": problem.bounds[:, 0].tolist(),
                "param_max": problem.bounds[:, 1].tolist(),
                "num_samples": samples,
                "obs_data": middle[:, None],
                "sim_name": "bench",
                "sigma_max": LARGEST_SIGMA,
                "sigma_tol": 1.0,
            },
            "inference": {
                "Bayes_filter": {"ess_target": 0.3},
                "sampling": {
                    "max_num_components": 5,
                    "covariance_type": "tied",
                    "slice_sampling": True,
                    "random_state": seed,
                },
                "initial_sampling": "halton",
            },
        }
    )


def _iterate(calibration: Any) -> bool:
    """Do one iteration quietly; say whether the filter has ended, by itself or by an error.

    With few samples its mixture can collapse, or the search for enough points inside the ranges
    not end; the estimate before resampling is then the last.
    """
    with (
        contextlib.redirect_stdout(io.StringIO()),
        warnings.catch_warnings(),
        contextlib.suppress(ValueError, RuntimeError, np.linalg.LinAlgError, TimeoutError),
        _cpu_limit(),
    ):
        warnings.simplefilter("ignore")  # mixtures that do not converge are its own affair
        return bool(calibration.run_one_iteration())
    return True


@contextlib.contextmanager
def _cpu_limit() -> Iterator[None]:
    """Raise TimeoutError when the work inside has taken more processor time than it may."""

    def end(_signal: int, _frame: object) -> None:
        raise TimeoutError

    before = signal.signal(signal.SIGPROF, end)
    signal.setitimer(signal.ITIMER_PROF, MOST_CPU_S)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)


def _estimate(calibration: Any) -> tuple[Array, Array]:
    """Return the posterior mean (6,) and the weighted 5 and 95 % quantiles (6, 2)."""
    weights = np.asarray(calibration.inference.posterior)
    samples = np.asarray(calibration.system.param_data)
    return weights @ samples, np.array([_quantiles(x, weights) for x in samples.T])


def _quantiles(x: Array, weights: Array) -> Array:
    order = np.argsort(x)
    shares = np.cumsum(weights[order])
    return np.asarray(np.interp(LEVELS, shares / shares[-1], x[order]))
