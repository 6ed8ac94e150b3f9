"""ACCES, `coexist.Access` (A. L. Nicusan et al., Coexist): CMA-ES over the parameters.

Ten solutions per epoch as in its README, start in the middle and sigma 40 % of the range as
`coexist.create_parameters` sets them, end at a scaled sigma of 0.1 as `learn` does by default. Each
place has an error, the mean square of its standardised differences; they are combined by
`Product`, the package's default for several errors, or by `Sum`. The answer is the estimate that
ACCES writes for each epoch, the favourite of CMA-ES, not the best single run: with seed noise the
best run is the luckiest. Its uncertainty of each parameter is read as a normal standard deviation.

ACCES starts a Python process for each solution; here the same simulations run in this process
(`evaluate_solutions` is replaced), which changes no number.
"""

from __future__ import annotations

import contextlib
import tempfile
import warnings
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

from benchmarks.peers.apparatus import TARGETS
from benchmarks.peers.problem import Answer, Array, Problem, answer

SOLUTIONS: Final = 10
NORMAL_90: Final = 1.645

_SCRIPT = """
# ACCESS PARAMETERS START
import coexist
parameters = coexist.create_parameters({names}, {low}, {high})
# ACCESS PARAMETERS END
error = 0.0
"""


class Acces:
    """CMA-ES as ACCES drives it.

    Parameters
    ----------
    combiner : str
        "Product" or "Sum" of `coexist.combiners`.
    """

    sequential = True

    def __init__(self, combiner: str) -> None:
        self.name = f"acces-{combiner.lower()}"
        self._combiner = combiner

    def solve(
        self, problem: Problem, budgets: Sequence[int], rng: np.random.Generator
    ) -> Iterator[Answer]:
        """Yield the estimate after the epochs that each budget allows."""
        answers: list[Answer] = []
        estimates = _learn(problem, self._combiner, max(budgets), int(rng.integers(2**31)))
        for budget in budgets:
            inside = [found for spent, found in estimates if spent <= budget]
            if inside:
                last = inside[-1]
                answers.append(Answer(budget, last.theta, last.interval, *_cost(last)))
        yield from answers


def _cost(found: Answer) -> tuple[int, int, float]:
    return found.runs, found.failed, found.particle_steps


def _learn(problem: Problem, combiner: str, budget: int, seed: int) -> list[tuple[int, Answer]]:
    """Return the estimate after every epoch with the parameter vectors spent."""
    from coexist import Access, combiners  # an optional extra

    found: list[tuple[int, Answer]] = []
    combine = getattr(combiners, combiner)()

    class Counted(Access):  # type: ignore[misc]
        """Simulates in this process and ends with the budget."""

        def evaluate_solutions(self, solutions: Array, epoch: int) -> Array:
            del epoch
            errors = [place_errors(problem, problem.simulate(x)) for x in _inside(solutions)]
            return np.array([[*row, combine.combine(row)] for row in errors])

        def finished(self, es: Any) -> bool:
            scale = self.setup.scaling
            middle, spread = es.result.xfavorite * scale, es.result.stds * scale
            interval = middle[:, None] + NORMAL_90 * np.array([-1.0, 1.0]) * spread[:, None]
            spent = SOLUTIONS * (len(found) + 1)
            found.append((spent, answer(problem, spent, middle, interval)))
            return spent + SOLUTIONS > budget or bool(super().finished(es))

    def _inside(solutions: Array) -> Array:
        low, high = problem.bounds.T  # scaling back rounds in the last digit
        return np.clip(solutions, low, high)

    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        script = Path("script.py")
        low, high = problem.bounds.T.tolist()
        script.write_text(_SCRIPT.format(names=list(problem.names), low=low, high=high))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of its dependencies
            Counted(str(script)).learn(
                num_solutions=SOLUTIONS,
                random_seed=seed,
                multi_objective=combine,
                verbose=0,
            )
    return found


def place_errors(problem: Problem, values: Array) -> Array:
    """Return the mean square standardised difference of each place; nan where a run failed."""
    squares = problem.standardised(values) ** 2
    places = np.array([target.place for target in TARGETS.values()])
    return np.array([squares[places == place].mean() for place in dict.fromkeys(places)])
