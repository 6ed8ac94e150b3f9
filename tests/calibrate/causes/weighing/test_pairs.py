"""Pairs of causes are looked for on the straightened bench around a point."""

from __future__ import annotations

import numpy as np
import pytest

from calibrate.causes.candidates import Candidate
from calibrate.causes.weighing.pairs import promising
from calibrate.causes.weighing.tangent import tangent_at
from calibrate.inference.priors import Prior
from tests.calibrate.causes.formula import Formula, board

NAMES = ("straight", "bent", "other", "weak")
PAIRS = [(a, b) for i, a in enumerate(NAMES) for b in NAMES[i + 1 :]]
MARGIN = 4.0


def _expected(u, s):
    straight, bent, other, weak = s.T
    change = np.column_stack(
        [straight, -straight, bent * (1.0 + bent), 0.3 * bent, other, 0.02 * weak]
    )
    return u @ np.ones((1, 6)) + change


def _ranked(strengths, start, se=0.02):
    """Return what is promising from a point where data hold causes of these strengths."""
    y = _expected(np.zeros((1, 1)), np.array([strengths], dtype=float))[0]
    causes = [Candidate(n, n, 1.0, -5.0, 5.0, ((0, k),)) for k, n in enumerate(NAMES)]
    one = board(
        Formula(_expected), y, np.full(6, se), causes, priors=[Prior.normal(0.0, 1.0)], effects=4
    )
    priors = {c.name: one.strength_prior(c) for c in causes}
    return promising(tangent_at(one.problem, np.array([start])), one, priors, PAIRS, MARGIN)


# Of a point far from the truth the straight bench tells as much: the formula is straight in u.
@pytest.mark.parametrize("start", [0.0, 2.0])
def test_the_pair_that_acts_leads_wherever_it_is_looked_for(start):
    assert _ranked([3.0, 2.3, 0.0, 0.0], start)[0] == ("straight", "bent")


def test_a_peak_between_the_nodes_of_a_grid_is_found():
    """Ten strengths in 25 steps of 0.4, and errors that leave a thousandth of that."""
    ranked = _ranked([0.0, 2.3, 1.1, 0.0], 0.0, se=0.001)
    assert ranked[0] == ("bent", "other")
    assert not any("straight" in pair for pair in ranked)


def test_without_any_cause_no_pair_is_better_than_none():
    assert not _ranked([0.0, 0.0, 0.0, 0.0], 0.0)


def test_beside_a_single_cause_that_explains_all_no_other_pair_counts():
    # But one with a cause that hardly acts: that cannot be excluded.
    assert _ranked([3.0, 0.0, 0.0, 0.0], 0.0) == [("straight", "weak")]
