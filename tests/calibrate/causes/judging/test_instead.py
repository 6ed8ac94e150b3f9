"""What other parameters do that a cause does, where the answer is known."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from calibrate.causes.candidates import Candidate
from calibrate.causes.judging.elsewhere import nearest_imitations
from calibrate.causes.judging.instead import Instead
from calibrate.causes.judging.levels import Levels
from calibrate.causes.judging.straight import straight_at
from calibrate.causes.judging.visibility import visibility
from calibrate.causes.weighing.tangent import tangent_at
from calibrate.inference.priors import Prior
from calibrate.inference.problem import Known, Place, Problem, Reading, Source
from calibrate.inference.space import Space, Unknown
from calibrate.report.diagnosis.rows import visible_rows
from tests.calibrate.causes.formula import Formula, board, linear

SE = 0.01
FOOT = 0.2
ON = Candidate("on", "on", 1.0, 1.0, 1.0, ((0, 0),))


def test_straight_answers_are_imitated_as_linear_theory_says() -> None:
    slopes = np.array([[1.0, 0.3], [0.2, 1.0], [0.6, -0.5], [0.1, 0.4]])
    answer = np.array([0.8, 0.5, -0.4, 0.3])
    se = np.array([0.2, 0.25, 0.15, 0.3])
    priors = (Prior.normal(0.2, 1.0), Prior.normal(-0.1, 1.0))
    one = board(linear(slopes, answer[:, None]), np.zeros(4), se, (), priors=priors, effects=1)
    at = np.array([0.4, 0.7])
    asked = [{0: {0: x}} for x in (1.0, -3.0)]
    found = nearest_imitations(one.problem, at, asked, np.random.default_rng(1), 3)
    whole = np.diag(se**2) + slopes @ slopes.T
    away = np.sqrt(answer @ np.linalg.solve(whole, answer))
    assert [f.distance for f in found] == pytest.approx([away, 3.0 * away], rel=1e-6)
    moved = slopes.T @ np.linalg.solve(whole, answer)
    assert found[0].parameters - at == pytest.approx(moved, rel=1e-5)


def test_an_error_that_readings_share_imitates_as_much_as_is_believed_of_it() -> None:
    # A cause that moves both readings as the error does, x of its standard deviations: to take
    # part v of it costs v^2, and (x - v)^2 (b / se)^2 stay, so b^2 x^2 / (se^2 + b^2) in the end.
    se, size, x = 0.1, np.array([0.2, 0.3]), 3.0
    error = Unknown.shared_error("balance")
    readings = tuple(
        Reading(f"m{k}", slice(k, k + 1), np.zeros(1), np.array([se]), 0, ((0, size[k : k + 1]),))
        for k in range(2)
    )
    formula = Formula(lambda u, s: s[:, :1] * size + 0.0 * u.sum())
    problem = Problem(Space((error,)), (Place("rig", formula, (), (Source(),), readings),))
    rng = np.random.default_rng(1)
    (found,) = nearest_imitations(problem, np.zeros(1), [{0: {0: x}}], rng, 1)
    whole = float(size @ size)
    assert found.distance**2 == pytest.approx(x**2 * whole / (se**2 + whole), rel=1e-6)


def seen(shift: float, known: tuple[Known, ...] = ()):
    """Return what can be told of a cause that shifts a point of the arch (u, 4 u (1 - u))."""
    arch = Formula(
        lambda u, s: np.column_stack([u[:, 0] + shift * s[:, 0], 4.0 * u[:, 0] * (1.0 - u[:, 0])])
    )
    errors = np.full(2, SE)
    priors = (Prior.uniform(0.0, 1.0),)
    one = board(arch, np.zeros(2), errors, (ON,), priors=priors, effects=1, known=known)
    tangent = tangent_at(one.problem, stats.norm.ppf([FOOT]))
    return visibility(one, tangent, straight_at(one, tangent), Levels(), 1).of("on")


def test_a_cause_that_looks_like_none_and_is_a_far_parameter_is_not_told() -> None:
    found = seen(1.0 - 2.0 * FOOT)
    assert found.visible  # straight on from where the parameter is, nothing is like it
    assert found.achieved == np.inf
    assert found.instead == Instead("p0", pytest.approx(FOOT), pytest.approx(1.0 - FOOT))


def test_a_parameter_that_was_measured_goes_nowhere() -> None:
    found = seen(1.0 - 2.0 * FOOT, (Known(0, FOOT, 0.02),))
    assert found.achieved == 1.0
    assert found.instead is None


def test_a_cause_that_nothing_is_like_stays_what_it_was() -> None:
    found = seen(0.3)
    assert found.achieved == 1.0
    assert found.instead is None


def test_the_report_says_what_does_the_same() -> None:
    row = {"name": "on", "absorbed": 0.1, "visible": True, "detectable": 0.2, "achieved": None,
           "limit": 1.0, "bias": {}, "alike": [], "inclusion": 0.1, "unit": ""}  # fmt: skip
    instead = {"parameter": "e_pp", "now": 0.75, "then": 0.374}
    told = [{**row, "instead": one} for one in (None, instead)]
    cells = [line[3] for line in visible_rows({"candidates": told})]
    assert cells == ["not told", "not told: as e_pp 0.374"]
