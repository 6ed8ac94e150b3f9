"""The other programs as the comparison drives them; skipped where they are not installed."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.peers.apparatus import PLACES
from benchmarks.peers.methods.acces import Acces
from benchmarks.peers.methods.grain_learning import GrainLearning
from benchmarks.peers.problem import Answer, Method, Problem
from benchmarks.peers.truths import parameters_of, plant
from tests.benchmarks.formula import Formula

METHODS = (
    pytest.param("grainlearning", GrainLearning(20), id="grainlearning"),
    pytest.param("coexist", Acces("Product"), id="acces-product"),
    pytest.param("coexist", Acces("Sum"), id="acces-sum"),
)


def solved(method: Method, failing: float = 0.0) -> tuple[list[Answer], Problem]:
    """Return the answers of a method for one truth."""
    simulator = Formula(failing)
    truth = plant(Formula(), 3, parameters_of(3, 20))
    problem = Problem(truth.measured, truth.error, simulator, np.random.default_rng(5))
    return list(method.solve(problem, (20, 40), np.random.default_rng(6))), problem


@pytest.mark.filterwarnings("ignore")  # of the other programs and what they import
@pytest.mark.parametrize(("package", "method"), METHODS)
def test_answers_cost_what_they_say_and_are_the_same_again(package: str, method: Method) -> None:
    pytest.importorskip(package)
    answers, problem = solved(method)
    assert [a.budget for a in answers] == [20, 40]
    assert [a.runs for a in answers] == [20 * len(PLACES), 40 * len(PLACES)]
    assert problem.cost.runs == 40 * len(PLACES)
    low, high = problem.bounds.T
    again, _ = solved(method)
    for one, other in zip(answers, again, strict=True):
        assert np.array_equal(one.theta, other.theta)
        assert np.all((low <= one.theta) & (one.theta <= high))
        assert one.interval is not None
        assert np.all(one.interval[:, 0] < one.interval[:, 1])


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize(("package", "method"), METHODS)
def test_failed_runs_end_no_method(package: str, method: Method) -> None:
    pytest.importorskip(package)
    answers, problem = solved(method, failing=0.05)
    assert answers[-1].failed > 0
    assert np.isfinite(answers[-1].theta).all()
    assert problem.cost.failed == answers[-1].failed
