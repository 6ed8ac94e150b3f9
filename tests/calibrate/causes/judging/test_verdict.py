"""From probabilities and chances to a verdict."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibrate.causes.candidates import Candidate
from calibrate.causes.diagnosis import Options, diagnose
from calibrate.causes.judging.levels import Levels
from calibrate.causes.judging.probabilities import NONE, Answers
from calibrate.causes.judging.verdict import Chances, judge, smallest_set
from calibrate.causes.told.words import sentences
from calibrate.causes.weighing.evidences import Effort
from calibrate.inference.priors import Prior
from tests.calibrate.causes.formula import Formula, board

EXPLAINED = {("tilt",): 0.5, ("tilt", "wear"): 0.5}
GOOD = Chances(p_misfit=0.4, p_best=0.01, threshold=2.0, p_explained=EXPLAINED)
FEW = Options(Levels(studies=200), held_out=False, effort=Effort(100.0, 3))


def _judged(chances=GOOD, pairs=None, **shares):
    ordered = dict(sorted(shares.items(), key=lambda pair: -pair[1]))
    return judge(Answers(ordered, pairs or {}, {"unknown at y0": 1.0}), chances, Levels())


def test_a_probable_cause_beyond_chance_that_explains_the_data_is_named():
    verdict = _judged(none=0.02, tilt=0.96, flow=0.01, unknown=0.01)
    assert (verdict.kind, verdict.names) == ("named", ("tilt",))


def test_among_too_many_unknowns_nothing_is_said_of_causes():
    shares = {"tilt": 0.96, "none": 0.02, "flow": 0.01, "unknown": 0.01}
    answers = Answers(shares, {}, {})
    most = Levels().unknowns
    assert judge(answers, GOOD, Levels(), most).kind == "named"
    verdict = judge(answers, GOOD, Levels(), most + 1)
    assert (verdict.kind, verdict.names) == ("unknown", ())
    assert f"{most + 1} unknowns" in verdict.reason


def test_a_probable_cause_is_not_named_where_chance_shows_as_much():
    verdict = _judged(replace(GOOD, p_best=0.04), none=0.02, tilt=0.96, flow=0.01, unknown=0.01)
    assert (verdict.kind, verdict.names) == ("unknown", ())


def test_a_cause_that_leaves_a_misfit_is_unknown():
    left = replace(GOOD, p_explained={("tilt",): 0.04})
    assert _judged(left, none=0.02, tilt=0.96, flow=0.01, unknown=0.01).kind == "unknown"


def test_two_causes_that_both_act_are_named_together():
    pairs = {("tilt", "wear"): 0.93}
    verdict = _judged(pairs=pairs, none=0.0, tilt=0.04, wear=0.01, flow=0.01, unknown=0.01)
    assert (verdict.kind, set(verdict.names)) == ("named", {"tilt", "wear"})


def test_what_is_less_probable_than_a_set_holds_is_a_set_of_one():
    verdict = _judged(none=0.0, tilt=0.93, flow=0.01, unknown=0.06)
    assert (verdict.kind, verdict.names) == ("set", ("tilt",))


def test_a_cause_is_named_whoever_the_other_of_the_pair_is():
    pairs = {("tilt", "wear"): 0.4, ("flow", "tilt"): 0.3}
    verdict = _judged(pairs=pairs, none=0.01, tilt=0.27, wear=0.005, flow=0.005, unknown=0.01)
    assert (verdict.kind, verdict.names) == ("named", ("tilt",))


def test_alike_causes_form_the_smallest_set():
    verdict = _judged(none=0.01, tilt=0.6, flow=0.36, wear=0.02, unknown=0.01)
    assert (verdict.kind, verdict.names) == ("set", ("tilt", "flow"))


def test_a_set_holds_one_of_each_pair():
    # In every pair that is left one member is listed; the other adds nothing that it does not hold.
    pairs = {("tilt", "wear"): 0.15, ("period", "tilt"): 0.05, ("flow", "wear"): 0.04}
    verdict = _judged(pairs=pairs, none=0.01, tilt=0.6, flow=0.13, wear=0.01, unknown=0.01)
    assert (verdict.kind, verdict.names) == ("set", ("tilt", "flow"))


def test_one_of_a_set_acts_as_probably_as_asked_and_of_no_part_of_it(rng):
    names = list("abcdef")
    for _ in range(100):
        shares = dict(zip(((n,) for n in names), rng.exponential(size=6) ** 3, strict=True))
        shares |= {tuple(rng.choice(names, 2, replace=False)): p for p in rng.exponential(size=4)}
        found, whole = smallest_set(shares, 0.95), sum(shares.values())
        held = [
            sum(p for one, p in shares.items() if set(found[:k]) & set(one))
            for k in range(len(found) + 1)
        ]
        assert held[-1] >= (0.95 - 1e-9) * whole  # but for rounding of the sums
        assert held[-2] < 0.95 * whole


def test_a_set_of_which_nothing_explains_the_data_is_unknown():
    left = replace(GOOD, p_explained={("tilt",): 0.01, ("flow",): 0.05})
    verdict = _judged(left, none=0.01, tilt=0.6, flow=0.36, wear=0.02, unknown=0.01)
    assert (verdict.kind, verdict.names) == ("unknown", ())
    assert "every cause leaves a misfit" in verdict.reason


def test_a_set_stands_beside_something_unknown():
    verdict = _judged(none=0.01, tilt=0.7, flow=0.12, unknown=0.17)
    assert (verdict.kind, verdict.names) == ("set", ("tilt", "flow"))


def test_a_pair_explains_in_whatever_order_it_was_weighed():
    pairs = {("wear", "tilt"): 0.93}
    shares = {"none": 0.0, "tilt": 0.04, "wear": 0.01, "flow": 0.01, "unknown": 0.01}
    for p, kind in ((0.5, "named"), (0.01, "unknown")):
        left = replace(GOOD, p_explained={("tilt",): 0.001, ("wear", "tilt"): p})
        assert _judged(left, pairs, **shares).kind == kind


def test_what_was_not_tested_is_not_named():
    left = replace(GOOD, p_explained={("flow",): 0.5})
    assert _judged(left, none=0.02, tilt=0.96, flow=0.01, unknown=0.01).kind == "unknown"


def test_what_other_runs_might_call_otherwise_is_a_set():
    shares = {"none": 0.0, "tilt": 0.96, "flow": 0.03, "wear": 0.005, "unknown": 0.005}
    for share, kind, names in ((0.85, "named", ("tilt",)), (0.7, "set", ("tilt", "flow"))):
        average = {("tilt",): share, ("flow",): 0.99 - share, ("wear",): 0.01}
        verdict = _judged(replace(GOOD, lasting=average), **shares)
        assert (verdict.kind, verdict.names) == (kind, names)


def test_what_other_runs_call_a_pair_counts_once_in_the_set():
    shares = {"none": 0.0, "tilt": 0.96, "flow": 0.03, "wear": 0.005, "unknown": 0.005}
    average = {("tilt",): 0.4, ("tilt", "wear"): 0.25, ("flow",): 0.33, ("wear",): 0.02}
    verdict = _judged(replace(GOOD, lasting=average), **shares)
    assert (verdict.kind, verdict.names) == ("set", ("tilt", "flow"))


def test_what_is_more_probable_than_all_else_is_unknown():
    assert _judged(none=0.1, tilt=0.2, flow=0.1, unknown=0.6).kind == "unknown"


def test_nothing_is_named_while_no_cause_is_still_possible():
    assert _judged(none=0.3, tilt=0.6, flow=0.05, unknown=0.05).kind == "none"


def test_what_is_likely_wrong_and_not_told_is_unknown():
    verdict = _judged(none=0.2, tilt=0.7, flow=0.05, unknown=0.05)
    assert (verdict.kind, verdict.names) == ("unknown", ())
    assert verdict.reason.endswith("the data do not tell what; tilt leads with 0.70")


def test_a_misfit_that_no_candidate_explains_is_unknown():
    wrong = replace(GOOD, p_misfit=0.005, p_best=0.5)
    assert _judged(wrong, none=0.6, tilt=0.1, unknown=0.3).kind == "unknown"


def test_table_gives_every_answer_the_most_probable_first():
    table = _judged(none=0.2, tilt=0.6, flow=0.05, unknown=0.05, pairs={("a", "b"): 0.1}).table()
    assert list(table.index) == ["tilt", "none", "flow", "unknown", "a and b"]
    assert table["probability"].sum() == pytest.approx(1.0)


def _late_board(y):
    """Return a board with a straight cause and with one that only shows when large."""

    def expected(u, s):
        late = s[:, [1]] ** 2 / 4.0
        return u @ np.ones((1, 4)) + s[:, [0]] * [1.0, -1.0, 0.0, 0.0] + late * [0.0, 0.0, 1.0, -1]

    causes = [
        Candidate(name, name, 1.0, -5.0, 5.0, ((0, k),))
        for k, name in enumerate(("straight", "late"))
    ]
    return board(Formula(expected), np.array(y), np.full(4, 0.5), causes,
                 priors=[Prior.normal(0.0, 1.0)], effects=2)  # fmt: skip


def test_a_cause_that_acts_by_its_square_is_found_as_one_that_is_straight():
    found = diagnose(_late_board([0.0, 0.0, 4.0, -4.0]), np.random.default_rng(1), options=FEW)
    assert (found.verdict.kind, found.verdict.names) == ("named", ("late",))
    # A square has no sign: 4 = x^2 / 4 at four ordinary strengths.
    assert abs(found.best(("late",))[1][0]) == pytest.approx(4.0, abs=1.0)


def test_nothing_wrong_is_none():
    found = diagnose(_late_board([0.0, 0.0, 0.0, 0.0]), np.random.default_rng(1), options=FEW)
    assert found.verdict.kind == "none"
    assert found.verdict.answers.single[NONE] > 0.8


def test_without_any_candidate_something_unknown_can_still_be_found():
    one = replace(_late_board([0.0, 0.0, 8.0, -8.0]), candidates=())
    found = diagnose(one, np.random.default_rng(1), options=FEW)
    assert found.verdict.kind == "unknown"
    assert "none was looked for" in " ".join(sentences(found))
    assert found.table().empty
