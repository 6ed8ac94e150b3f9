"""From probabilities and chances to a verdict."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibrate.causes.candidates import Candidate
from calibrate.causes.diagnosis import Options, diagnose
from calibrate.causes.hypotheses import weigh_hypothesis
from calibrate.causes.verdict import NONE, UNKNOWN, Chances, Levels, judge, probabilities
from calibrate.causes.visibility import visibility
from calibrate.causes.words import sentences
from calibrate.inference.priors import Prior
from tests.calibrate.causes.formula import Formula, board

GOOD = Chances(p_misfit=0.4, p_best=0.01, threshold=2.0, p_explained={"tilt": 0.5}, size=300.0)
WHERE = {"unknown at y0": 1.0}


def _judged(chances=GOOD, **shares):
    ordered = dict(sorted(shares.items(), key=lambda pair: -pair[1]))
    return judge(ordered, WHERE, chances, Levels())


def test_a_probable_cause_beyond_chance_that_explains_the_data_is_named():
    verdict = _judged(none=0.03, tilt=0.95, flow=0.01, unknown=0.01)
    assert (verdict.kind, verdict.names) == ("named", ("tilt",))


def test_a_probable_cause_is_not_named_where_chance_shows_as_much():
    verdict = _judged(replace(GOOD, p_best=0.04), none=0.03, tilt=0.95, flow=0.01, unknown=0.01)
    assert (verdict.kind, verdict.names) == ("none", ())


def test_a_cause_that_leaves_a_misfit_is_unknown():
    left = replace(GOOD, p_explained={"tilt": 0.04})
    assert _judged(left, none=0.03, tilt=0.95, flow=0.01, unknown=0.01).kind == "unknown"


def test_alike_causes_form_the_smallest_set():
    verdict = _judged(none=0.01, tilt=0.6, flow=0.36, wear=0.02, unknown=0.01)
    assert (verdict.kind, verdict.names) == ("group", ("tilt", "flow"))
    assert verdict.credible == ("tilt", "flow")


def test_what_is_unknown_may_be_in_the_set_but_is_no_name():
    verdict = _judged(none=0.01, tilt=0.8, flow=0.02, unknown=0.17)
    assert (verdict.kind, verdict.names) == ("group", ("tilt",))
    assert UNKNOWN in verdict.credible


def test_nothing_is_named_while_no_cause_is_still_possible():
    verdict = _judged(none=0.2, tilt=0.7, flow=0.05, unknown=0.05)
    assert verdict.kind == "none"
    assert NONE in verdict.credible


def test_a_misfit_that_no_candidate_explains_is_unknown():
    wrong = replace(GOOD, p_misfit=0.005, p_best=0.5)
    assert _judged(wrong, none=0.6, tilt=0.1, unknown=0.3).kind == "unknown"


def test_table_gives_every_answer_the_most_probable_first():
    table = _judged(none=0.2, tilt=0.7, flow=0.05, unknown=0.05).table()
    assert list(table.index) == ["tilt", "none", "flow", "unknown"]
    assert table["probability"].sum() == pytest.approx(1.0)


def _late_board(y):
    """Return a board with a straight cause and with one that only shows when large."""

    def expected(u, s):
        late = s[:, [1]] ** 4 / 64.0
        return u @ np.ones((1, 4)) + s[:, [0]] * [1.0, -1.0, 0.0, 0.0] + late * [0.0, 0.0, 1.0, -1]

    causes = [
        Candidate(name, name, 1.0, -5.0, 5.0, ((0, k),))
        for k, name in enumerate(("straight", "late"))
    ]
    return board(Formula(expected), np.array(y), np.full(4, 0.5), causes,
                 priors=[Prior.normal(0.0, 1.0)], effects=2)  # fmt: skip


def _shared(y):
    """Return the probabilities and the sight of its causes."""
    one = _late_board(y)
    sets = [(), *[(c.name,) for c in (*one.candidates, *one.shifts)]]
    base = weigh_hypothesis(one.hypothesis(), 1)
    weighed = {names: weigh_hypothesis(one.hypothesis(*names), 1, base) for names in sets}
    seen = visibility(one, weighed[()])
    return probabilities(one, weighed, seen)[0], seen


def test_strong_evidence_is_not_silenced_by_what_a_straight_line_cannot_see():
    shares, seen = _shared([0.0, 0.0, 4.0, -4.0])
    assert not seen.of("late").visible
    assert shares["late"] > 0.5
    assert sum(shares.values()) == pytest.approx(1.0)


def test_evidence_for_what_should_be_invisible_is_told():
    few = Options(Levels(studies=40), held_out=False)
    found = diagnose(_late_board([0.0, 0.0, 4.0, -4.0]), np.random.default_rng(1), options=few)
    told = [one for one in sentences(found) if "stay among the probabilities" in one]
    assert len(told) == 1
    assert "late" in told[0]


def test_what_cannot_be_seen_takes_little_from_the_others_and_keeps_some():
    shares, seen = _shared([0.0, 0.0, 0.0, 0.0])
    assert seen.of("straight").power > 0.8
    assert 0.05 <= seen.of("late").power < 0.1
    assert 0.0 < shares["late"] < 0.1
    assert shares[NONE] > 0.8


def test_without_any_candidate_something_unknown_can_still_be_found():
    one = replace(_late_board([0.0, 0.0, 8.0, -8.0]), candidates=())
    few = Options(Levels(studies=120), held_out=False)
    found = diagnose(one, np.random.default_rng(1), options=few)
    assert found.verdict.kind == "unknown"
    assert "none was looked for" in " ".join(sentences(found))
    assert found.table().empty
