"""What a few runs of further experiments tell, and what is tried next."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from calibrate.causes.information import entropy
from calibrate.causes.judging.probabilities import UNKNOWN
from calibrate.causes.offers import LEAST, Prospect, Trial
from calibrate.causes.studies.further.expectations import Seen, expected_of, offer_of
from calibrate.causes.studies.further.ranking import Tried, try_further
from calibrate.causes.studies.further.trying import FEW, FURTHER_SEED
from calibrate.causes.told.next_step import SHOWN, next_record, next_step
from calibrate.report.diagnosis.rows import next_rows
from calibrate.runs.campaign import run_table
from calibrate.study.data import StudyData
from tests.calibrate.causes import studies
from tests.calibrate.causes.further.looked import (
    DRUM,
    FASTER,
    FLOW,
    LOOKED,
    PERIOD,
    diagnosis,
)


@pytest.fixture(scope="module")
def data(tmp_path_factory) -> StudyData:
    return studies.study(tmp_path_factory.mktemp("study"), {}, 5)


def _try(data: StudyData, shares, entries, most: int = 60) -> tuple[Tried, list, list[str]]:
    asked, told = [], []

    def run(specs, label):
        asked.extend(specs)
        return studies.run(specs, label)

    base = SimpleNamespace(table=run_table([], []).assign(wall_s=[]))
    base.table.loc[0, "wall_s"] = 60.0
    found = diagnosis(shares)
    return try_further(data.study, found, base, run, entries, most, told.append), asked, told


def test_a_second_frequency_leads_where_it_separates_look_alikes(data) -> None:
    tried, asked, told = _try(data, LOOKED, {"drum": DRUM, "faster": FASTER})
    best = tried.prospect.offers[0]
    assert best.measurement.name.startswith("faster:A/")
    assert best.information <= tried.prospect.entropy
    # Nearly all that is open between the two, and more per hour than the stopwatch.
    assert best.information > 0.45
    leads = [next(iter(result.probability)) for result in best.outcomes]
    assert set(leads[:2]) == {PERIOD, FLOW}
    slow, fed = (result.values[0] for result in best.outcomes[:2])
    # exp(3 x 0.15) over exp(0.15), but for the scatter of a run and a few draws.
    assert leads[0] == PERIOD
    assert slow / fed == pytest.approx(np.exp(0.3), rel=0.05)
    # Nothing acts in the drum: it was tried, and is worth nothing.
    names = [one.measurement.name for one in tried.prospect.offers]
    assert not any("drum" in name for name in names)
    assert any(spec.experiment == "drum" for spec in asked)
    assert PERIOD in names
    assert told[-1].startswith("Tried, and tells less than 0.05 nats: drum:A/")
    # The cost is told before anything else is.
    assert "3 answers are tried in further experiments" in told[0]
    assert f"up to {len(asked)} runs" in told[0] or tried.runs < 60
    assert tried.runs == len(asked) <= 60


def test_the_same_question_asks_for_the_same_runs(data) -> None:
    entries = {"drum": DRUM, "faster": FASTER}
    first, asked, _ = _try(data, LOOKED, entries)
    second, again, _ = _try(data, LOOKED, entries)
    assert [repr(spec) for spec in asked] == [repr(spec) for spec in again]
    assert first == second
    # Each answer and draw has a seed that no other run has.
    seeds = [spec.seed - data.study.run.seed for spec in asked if spec.experiment == "drum"]
    assert min(seeds) >= FURTHER_SEED
    steel = [spec.seed for spec in asked if spec.experiment == "drum" and spec.surface == "flat"]
    assert len(set(steel)) == len(steel) > 0
    # Of fewer runs the first are those of more.
    _, fewer, _ = _try(data, LOOKED, entries, 20)
    assert {repr(spec) for spec in fewer} < {repr(spec) for spec in asked}


def test_nothing_is_run_where_nothing_is_open_or_too_little_is_allowed(data) -> None:
    sure = {(PERIOD,): 0.96, (FLOW,): 0.04}
    for shares, most in ((sure, 60), (LOOKED, 0), ({(): 0.5, (UNKNOWN,): 0.5}, 60)):
        tried, asked, told = _try(data, shares, {"faster": FASTER}, most)
        assert (tried.runs, asked, told) == (0, [], [])
        assert len(tried.prospect.offers) == 1
    _, asked, told = _try(data, LOOKED, {"faster": FASTER}, 3 * FEW - 1)
    assert not asked
    assert "allow as many with --further 9" in told[0]
    _, _, told = _try(data, LOOKED, {"drum": DRUM, "faster": FASTER}, 3 * FEW)
    assert "Not tried for want of runs (--further): " in told[0]


def test_runs_that_fail_are_told_and_stop_nothing(data) -> None:
    told: list[str] = []

    def fail(specs, label):
        return studies.run(specs, label).assign(status="failed")

    base = SimpleNamespace(table=run_table([], []).assign(wall_s=[]))
    found = diagnosis(LOOKED)
    tried = try_further(data.study, found, base, fail, {"faster": FASTER}, 60, told.append)
    assert tried.prospect.offers == found.prospect.offers
    assert "Too few runs succeeded to judge faster:A/" in told[-1]


def test_what_the_record_and_the_sentence_say_of_an_experiment(data) -> None:
    tried, _, _ = _try(data, LOOKED, {"faster": FASTER, "drum": DRUM})
    found = SimpleNamespace(**{**vars(diagnosis(LOOKED)), "prospect": tried.prospect})
    record = {"measure_next": next_record(found)}
    best, *others = record["measure_next"]["offers"]
    assert best["reads"] == [{"name": "t100_s", "unit": "s", "se": 0.1}]
    assert best["next"] == ""  # a study has one frequency
    assert next(o for o in others if o["name"] == PERIOD)["next"].startswith("bulkcal diagnose")
    said = next_step(found)
    assert f"({best['name']}, good to 0.1 s, 0.5 h) tells most per hour" in said
    assert "A study holds one setting of each experiment" in said
    row = next_rows(record)[0]
    assert row[1:5] == [best["name"], "0.1 s", "0.5", f"{best['nats']:.2f} nats"]
    assert f" s: {PERIOD}" in row[5]
    # What runs were spent on is told, wherever it stands.
    cheap = [offer for offer in tried.prospect.offers if offer.measurement.name == PERIOD]
    found.prospect = Prospect(1.0, (*cheap * SHOWN, *tried.prospect.offers))
    told = [one["name"] for one in next_record(found)["offers"]]
    assert told == [PERIOD] * SHOWN + [best["name"]] + [
        one["name"] for one in others if one["name"].startswith("faster")
    ]
    drum = Trial("drum", "a drum", 1.0, found.prospect.offers[0].measurement.reads, "bulkcal x")
    led = replace(found.prospect.offers[0], measurement=drum)
    found.prospect = Prospect(1.0, (led,))
    assert "What it needs: bulkcal x; measured, its numbers go into the study" in next_step(found)


def _seen(rng: np.random.Generator, apart: float, runs: int, width: int) -> Seen:
    """Return runs of two answers and none whose first numbers differ by so many deviations."""
    means = {(PERIOD,): apart, (FLOW,): 0.0, (): 0.0}
    results = {
        names: rng.standard_normal((runs, width)) + np.eye(1, width)[0] * mean
        for names, mean in means.items()
    }
    return Seen(results, ("linear",) * width, (0.1,) * width)


@pytest.mark.parametrize("width", [1, 3])
def test_luck_of_few_runs_is_not_taken_for_knowledge(width) -> None:
    """Three runs of each answer, which expect the same, feign less than is ever offered."""
    trial = Trial("x", "x", 1.0, ())
    told = []
    for seed in range(40):
        rng = np.random.default_rng([seed, width])
        offer = offer_of(trial, LOOKED, _seen(rng, 0.0, FEW, width), rng)
        told.append(offer.information)
    assert np.mean(told) < LEAST
    assert min(told) == pytest.approx(0.0, abs=1e-9)


def test_answers_far_apart_are_told_from_few_runs() -> None:
    rng = np.random.default_rng(1)
    trial = Trial("x", "x", 1.0, ())
    offer = offer_of(trial, LOOKED, _seen(rng, 100.0, FEW, 2), rng)
    # The period is told from flow and none, which are alike, and unknown, which is wide, from all.
    exact = entropy([0.55, 0.41, 0.04])
    assert 0.8 * exact < offer.information < exact + LEAST
    # Answers that were not tried tell nothing, and take their share of it.
    more = {names: 0.5 * p for names, p in LOOKED.items()} | {("other",): 0.5}
    half = offer_of(trial, more, _seen(np.random.default_rng(1), 100.0, FEW, 2), rng)
    assert half.information == pytest.approx(0.5 * offer.information, rel=0.05)


def test_what_is_unknown_expects_what_none_does_but_wider() -> None:
    rng = np.random.default_rng(2)
    expected = expected_of(_seen(rng, 5.0, 50, 2), unknown=True)
    none, other = expected[()], expected[UNKNOWN,]
    assert other.mean == pytest.approx(none.mean)
    assert np.linalg.eigvalsh(other.covariance - none.covariance).min() > -1e-12
    off = expected[PERIOD,].mean[0] - none.mean[0]
    wider = other.covariance[0, 0] - none.covariance[0, 0]
    assert wider == pytest.approx(0.5 * off**2, rel=0.1)  # the mean of two, the flow's is nothing
    # With many runs the covariance is that of a run, and of the measurement.
    assert none.covariance[1, 1] == pytest.approx(1.0 + 0.1**2, rel=0.25)
    assert expected_of(_seen(rng, 5.0, 1, 2), unknown=False) is None
