"""What to measure next: expected results by hypothesis, the ranking, what is left out."""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np
import pytest

from calibrate.causes.candidates import Candidate, Measured
from calibrate.causes.diagnosis import Diagnosis, Options, diagnose
from calibrate.causes.information import Expected, information
from calibrate.causes.judging.levels import Levels
from calibrate.causes.next_measurement import measured_causes, prospect
from calibrate.causes.offers import Feasible
from calibrate.causes.told.next_step import is_settled, next_record, next_step
from calibrate.causes.weighing.evidences import Effort
from calibrate.causes.weighing.weigh_all import weigh_all
from calibrate.inference.priors import Prior
from calibrate.inference.problem import Known
from tests.calibrate.causes.formula import board, linear
from tests.calibrate.causes.planted import study

QUICK = Options(Levels(studies=200), held_out=False, effort=Effort(150.0, 2))
J = np.array([[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [1.0, 1.0]])
ALIKE = np.array([[0.3, 0.3], [0.2, 0.2], [1.0, 1.0], [0.0, 0.0]])
"""What two causes do that no data of this bench tell apart."""
SE = np.array([0.2, 0.2, 0.2, 0.2])
TWINS = (
    Candidate("one", "one", 1.0, -6.0, 6.0, ((0, 0),), settled_se=0.1, settled_hours=0.5),
    Candidate("two", "two", 1.0, -6.0, 6.0, ((0, 1),), settled_se=0.1, settled_hours=4.0),
)


@functools.cache
def _alike() -> Diagnosis:
    y = J @ [0.5, 0.5] + 3.0 * ALIKE[:, 0]
    one = board(linear(J, ALIKE), y, SE, TWINS, priors=[Prior.normal(0.5, 1.0)] * 2, effects=2)
    return diagnose(one, np.random.default_rng(3), options=QUICK)


def _offers(found: Diagnosis, more=()):
    ahead = prospect(found.found, found.verdict.answers, more)
    return {one.measurement.name: one for one in ahead.offers}


def test_of_two_that_tell_the_same_the_faster_one_leads():
    found = _alike()
    assert set(found.verdict.names) == {"one", "two"}
    first, second = found.prospect.offers
    assert (first.measurement.name, second.measurement.name) == ("one", "two")
    assert first.information == pytest.approx(second.information, rel=0.05)
    assert first.per_hour == pytest.approx(first.information / 0.5)


def test_a_measurement_of_one_of_two_twins_decides_between_them():
    offer = _alike().prospect.offers[0]
    strength = _alike().strength("one")
    for result in offer.outcomes:
        lead, p = next(iter(result.probability.items()))
        assert p > 0.8
        assert lead == ("two" if abs(result.values[0]) < 0.1 else "one")
    assert {round(abs(result.values[0]), 1) for result in offer.outcomes} == {
        0.0,
        round(strength, 1),
    }


def test_the_information_is_that_of_the_draws():
    """The same from results drawn hypothesis by hypothesis, pairs and unknown among them."""
    found = _alike()
    answers = found.verdict.answers
    shares = {(): answers.none + answers.unknown}
    shares |= {(name,): answers.single[name] for name in ("one", "two")}
    shares |= dict(answers.pairs)
    rng = np.random.default_rng(1)
    edges = np.linspace(-8.0, 8.0, 161)
    rows = []
    for names in shares:
        x = np.zeros(200_000)
        if "one" in names:
            values = found.samples(names)[1][:, names.index("one")]
            x = rng.choice(values, len(x))
        counts, _ = np.histogram(x + 0.1 * rng.standard_normal(len(x)), edges)
        rows.append(counts / counts.sum())
    p, f = np.array(list(shares.values())), np.array(rows)
    whole = p @ f
    told = sum(
        w * np.sum(row[row > 0] * np.log(row[row > 0] / whole[row > 0]))
        for w, row in zip(p, f, strict=True)
    )
    # The strengths of a pair are no normals, and the 2000 draws of each are drawn again and again.
    assert _offers(found)["one"].information == pytest.approx(told, abs=0.05)


def test_what_was_measured_as_well_is_not_offered_again():
    found = _alike()
    for se, offered in ((0.1, False), (0.2, True)):
        bench = {"one": (Measured(0.0, se),)}
        known = replace(found.found, board=replace(found.board, known=bench))
        names = [o.measurement.name for o in prospect(known, found.verdict.answers).offers]
        assert ("one" in names) is offered


def test_an_unknown_of_the_base_model_is_worth_what_it_tells_of_the_cause():
    """p0 moves as the first reading says; a cause that acts there too moves it."""
    found = _alike()
    what = Feasible("p0", "a shear cell", "-", 0.01, 1.0, unknown="p0")
    blunt = replace(what, name="blunt", se=100.0)
    offers = _offers(found, (what, blunt))
    assert "blunt" not in offers
    values = {names: found.samples(names)[0][:, 0] for names in ((), ("one",))}
    apart = [
        Expected(((1.0, float(x.mean()), float(np.hypot(x.std(), 0.01))),)) for x in values.values()
    ]
    assert information([0.5, 0.5], apart) > 0.05  # there is something to tell
    known = (Known(0, 0.5, 0.01),)
    made = replace(found.board, problem=replace(found.board.problem, known=known))
    again = prospect(replace(found.found, board=made), found.verdict.answers, (what,))
    assert "p0" not in [one.measurement.name for one in again.offers]


def test_a_cause_of_one_place_is_measured_there():
    here = Candidate("flow:a", "flow", 1.0, -6.0, 6.0, ((0, 0),), settled_se=0.1)
    there = Candidate("flow:b", "flow", 1.0, -6.0, 6.0, ((1, 0),), settled_se=0.1)
    both = Candidate("flow", "flow", 1.0, -6.0, 6.0, ((0, 0), (1, 0)), settled_se=0.1)
    one = replace(_alike().board, candidates=(both, here, there))
    first, second = measured_causes(one)
    assert (first.name, second.name) == ("flow:a", "flow:b")
    assert [first.measures(c) for c in (both, here, there)] == [True, True, False]
    # A measurement of one place says nothing of a cause that acts in another one alone.
    known = replace(one, known={"flow": (Measured(0.2, 0.1, frozenset({0})),)})
    assert known.strength_prior(both).measured == pytest.approx((0.2, 0.1))
    assert known.strength_prior(here).measured == pytest.approx((0.2, 0.1))
    assert known.strength_prior(there).measured is None
    off = known.constant(())
    assert off == pytest.approx(-0.5 * 4.0 - np.log(0.1) - 0.5 * np.log(2.0 * np.pi))
    assert known.constant(("flow:b",)) == off
    assert known.constant(("flow:a",)) == known.constant(("flow",)) == 0.0


def test_two_measurements_of_one_strength_are_their_product():
    """One funnel gave 0.2, the other 0.5: a common strength is unlikely, two of their own not."""
    y, se = np.array([1.0, 2.0]), np.array([0.5, 0.5])
    parts = [
        Candidate(n, "flow", 1.0, -6.0, 6.0, acts)
        for n, acts in (("flow", ((0, 0), (0, 1))), ("flow:a", ((0, 0),)))
    ]
    one = board(
        linear(np.eye(2), np.eye(2)), y, se, parts, priors=[Prior.normal(0.0, 1.0)] * 2, effects=2
    )
    benches = (Measured(0.2, 0.1), Measured(0.5, 0.2))
    twice = replace(one, known={"flow": benches})
    whole = replace(one, known={"flow": (Measured(0.26, np.sqrt(1.0 / 125.0)),)})
    evidences = [
        weigh_all(b, np.random.default_rng(2), effort=Effort(500.0)).weighed["flow",].log_evidence
        for b in (twice, whole)
    ]
    # N(0.2; x, 0.1) N(0.5; x, 0.2) = N(0.26; x, 0.0894) N(0.2 - 0.5; 0, 0.2236)
    agree = -0.5 * 0.3**2 / 0.05 - 0.5 * np.log(2.0 * np.pi * 0.05)
    assert evidences[0] - evidences[1] == pytest.approx(agree, abs=1e-6)


def test_where_nothing_is_suspected_nothing_is_asked_for():
    rng = np.random.default_rng([11, 0])
    found = diagnose(study({}, rng), rng, options=QUICK)
    verdict = found.verdict
    sure = replace(verdict.answers, single={**verdict.answers.single, "none": 0.95})
    none = replace(found, verdict=replace(verdict, kind="none", answers=sure))
    assert is_settled(none)
    assert next_step(none).startswith("Next: nothing more has to be measured for the cause")
    assert next_record(none)["offers"] == []
    open_ = replace(found, verdict=replace(verdict, kind="none"))
    assert not is_settled(open_)


def test_the_sentence_and_the_record_say_the_same():
    found = _alike()
    record = next_record(found)
    assert record["open_nats"] == found.prospect.entropy
    best = record["offers"][0]
    said = next_step(found)
    assert f"({best['name']}, good to 0.1, 0.5 h) tells most per hour" in said
    assert f"{best['nats']:.2f} of the {record['open_nats']:.2f} nats" in said
    assert best["next"] in said
    assert '--with "one=' in best["next"]
    hours = [one["nats_per_hour"] for one in record["offers"]]
    assert hours == sorted(hours, reverse=True)
