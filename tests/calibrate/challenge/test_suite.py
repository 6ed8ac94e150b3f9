"""A small suite on formulas, from the rules to the scores."""

from __future__ import annotations

import json
import shutil
import threading
import zipfile
from dataclasses import replace

import numpy as np
import pytest

from calibrate.challenge import forecasts
from calibrate.challenge.folders import SEALS, TRUTHS, Suite
from calibrate.challenge.judges.imagined import imagined
from calibrate.challenge.judges.variants import VARIANTS
from calibrate.challenge.laboratory import errors_of
from calibrate.challenge.making import make_suite, plan_of
from calibrate.challenge.opening import cases_of, checked_truths
from calibrate.challenge.scores import score_table
from calibrate.cli.challenge.score import score
from calibrate.errors import CalibrationError
from calibrate.scales import slope
from calibrate.study.data import load_data
from liggghts_io.case.lock import locked
from tests.calibrate.causes import studies
from tests.calibrate.challenge.small import FEW, NOTE, RULES


@pytest.fixture(scope="module")
def suite(design, tmp_path_factory):
    """Make a suite, and forecast it."""
    data, learnt = design
    found = Suite(tmp_path_factory.mktemp("suite"))
    plan = plan_of(RULES, data, learnt, NOTE["seed"])
    make_suite(RULES, data, learnt, plan, studies.run, found, NOTE, print)
    for study in found.studies():
        for method in ("ours", "signature", "prior", forecasts.LIMIT):
            truth = found.truths()[study.name] if method == forecasts.LIMIT else None
            forecasts.forecast(learnt, study, found.path / "forecasts", method, truth, FEW)
    return found


def test_a_study_tells_what_was_measured_and_nothing_of_what_was_hidden(suite):
    texts = [(one / "study.toml").read_text(encoding="utf-8") for one in suite.studies()]
    assert len(texts) == RULES.count
    assert len(set(texts)) == RULES.count
    hidden = [one["name"] for truth in suite.truths().values() for one in truth["hidden"]]
    assert len(hidden) == 3
    assert not any(name.partition(":")[0] in text for name in hidden for text in texts)
    assert not any("strength" in text for text in texts)


def test_errors_of_measured_values_are_those_of_means_of_runs(design, suite):
    data, learnt = design
    study = load_data(suite.studies()[0] / "study.toml").study
    for given, target in zip(study.targets, data.study.targets, strict=True):
        one = errors_of(learnt, data.study, target, RULES, 1).own
        mean = errors_of(learnt, data.study, target, RULES, RULES.repeats).own
        assert mean == pytest.approx(one / 2.0)  # of four runs
        on_scale = given.se * slope(given.model_scale, given.value)
        assert on_scale == pytest.approx(mean[0], rel=1e-3)


def test_a_laboratory_that_sees_its_runs_scatter_says_so(design):
    data, learnt = design
    rules = RULES.model_copy(update={"errors": "runs"})
    target = data.study.targets[0]
    usual = errors_of(learnt, data.study, target, rules, 2)
    assert usual.repeats == 6  # four of before, and two
    sd = float(usual.own[0]) * 2**0.5
    # Two runs that differ by 2 k standard deviations have k^2 times the usual variance; their one
    # degree of freedom is told beside four.
    for k in (0.0, 1.0, 3.0):
        runs = sd * k * np.array([[1.0], [-1.0]])
        told = errors_of(learnt, data.study, target, rules, runs)
        assert told.own[0] ** 2 == pytest.approx(usual.own[0] ** 2 * (4 + 2 * k**2) / 5)


def test_what_no_target_can_be_is_left_out(design, tmp_path):
    data, learnt = design
    settings = '[[experiment]]\nname = "plate_impact"\napparatus = { box_rims = 0.0 }\n'
    path = tmp_path / "study.toml"
    path.write_text(data.path.read_text(encoding="utf-8") + settings, encoding="utf-8")
    data = replace(data, study=load_data(path).study)

    def laboratory(changed, value):
        def run(specs, label):
            table = studies.run(specs, label)
            table.loc[table["experiment"] == "plate_impact", changed] = value
            return table

        return run

    rules = RULES.model_copy(update={"single": 0, "foreign": 0, "fresh": 0.0})
    plan = plan_of(rules, data, learnt, "seed")
    for changed, value, rigs in (("m4_g", 0.0, 1), ("status", "jammed", 0)):
        suite = Suite(tmp_path / changed)
        run = laboratory(changed, value)
        make_suite(rules, data, learnt, plan, run, suite, NOTE, print)
        (one,) = suite.studies()
        study = load_data(one / "study.toml").study
        assert "m4_g" not in {target.observable for target in study.targets}
        assert len(study.rigs) == rigs


def test_a_study_without_a_target_reads_the_others_where_they_were_learnt(design):
    data, learnt = design
    place = next(one for one in learnt.board(data).problem.places if len(one.readings) > 1)
    first, *others = place.readings
    left = [target for target in data.study.targets if target.name != first.name]
    fewer = replace(data, study=data.study.model_copy(update={"targets": left}))
    same = next(one for one in learnt.board(fewer).problem.places if one.name == place.name)
    assert [(one.name, one.columns) for one in same.readings] == [
        (one.name, one.columns) for one in others
    ]


def test_the_first_studies_count_alone(design, suite):
    told: list[str] = []
    asked = (suite, suite.path / "forecasts", ["ours"], design[1])
    both = [cases_of(*asked, n, told.append) for n in (0, 2)]
    assert told[-2:] == [f"comparing: study {k} of 2" for k in (1, 2)]
    every, first = (found["ours"] for found in both)
    assert len(every) == RULES.count
    assert [one.truth["number"] for one in first] == [1, 2]


def test_scores_of_the_first_studies_have_files_of_their_own(design, suite, monkeypatch):
    monkeypatch.setattr("calibrate.challenge.rules.load_rules", lambda _path: RULES)
    monkeypatch.setattr("calibrate.challenge.learnt.learnt_of", lambda *_: design)
    score(suite.path, suite.path / "rules.toml", studies=2, quiet=True)
    assert {one.name for one in suite.path.glob("scores*")} == {
        "scores_first_2.csv", "scores_first_2.json",
    }  # fmt: skip
    first = json.loads((suite.path / "scores_first_2.json").read_text(encoding="utf-8"))
    rows = {row["figure"]: row for row in first["scores"]}
    assert rows["mean log score"]["studies"] == 2


def test_imagined_data_are_what_the_emulators_expect_at_the_truth(design, suite):
    _, learnt = design
    rng, seen = np.random.default_rng(1), []
    for name, truth in suite.truths().items():
        board = learnt.board(load_data(suite.path / "studies" / name / "study.toml"))
        drawn = imagined(board, truth, rng)
        if truth["kind"] == "foreign":
            assert drawn is board  # no emulator knows what it does
            continue
        values = np.array([[truth["values"][key] for key in board.problem.space.names]])
        for k, place in enumerate(board.problem.places):
            known = place.inputs(values)
            for hidden in truth["hidden"]:
                one = board.candidate(hidden["name"])
                for column in (column for at, column in one.acts if at == k):
                    known.strengths[:, column] = hidden["strength"] / one.scale
            expected = place.emulator.predict(known)
            for reading in drawn.problem.places[k].readings:
                total = expected.total[0, reading.columns] + np.diag(reading.covariance)
                seen.append((reading.y - expected.mean[0, reading.columns]) / np.sqrt(total))
    z = np.concatenate(seen)
    # Twenty numbers or so tell their size to a sixth.
    assert 0.5 < np.sqrt(np.mean(z**2)) < 1.5


def test_made_again_it_stays_as_it_is(design, suite, tmp_path):
    data, learnt = design
    before = {path: path.read_bytes() for path in suite.path.rglob("*") if path.is_file()}
    plan = plan_of(RULES, data, learnt, NOTE["seed"])

    def run(specs, label):
        raise AssertionError(label)

    make_suite(RULES, data, learnt, plan, run, suite, NOTE, print)
    seals = suite.seals()
    del seals["rules"]["errors"]  # rules of a suite that is older than this key
    older = Suite(tmp_path)
    shutil.copytree(suite.path, older.path, dirs_exist_ok=True)
    (older.path / SEALS).write_text(json.dumps(seals))
    make_suite(RULES, data, learnt, plan, run, older, NOTE, print)
    assert before == {path: path.read_bytes() for path in suite.path.rglob("*") if path.is_file()}
    with pytest.raises(CalibrationError, match="other rules, runs or seed"):
        make_suite(RULES, data, learnt, plan, run, suite, {**NOTE, "seed": "b"}, print)


def test_who_makes_a_suite_that_another_makes_waits(design, suite):
    plan = plan_of(RULES, *design, NOTE["seed"])
    said: list[str] = []

    def again() -> None:
        make_suite(RULES, *design, plan, studies.run, suite, NOTE, said.append)

    with locked(suite.path):
        thread = threading.Thread(target=again)
        thread.start()
        thread.join(3.0)  # longer than whoever waits is silent
        assert thread.is_alive()
    thread.join()
    assert said[0].startswith("waiting for pid ")


def test_a_study_that_is_missing_is_made_alike(design, suite, tmp_path):
    data, learnt = design
    plan = plan_of(RULES, data, learnt, NOTE["seed"])
    other = Suite(tmp_path)
    make_suite(RULES, data, learnt, plan, studies.run, other, NOTE, print)
    for one, again in zip(suite.studies(), other.studies(), strict=True):
        assert (one / "study.toml").read_bytes() == (again / "study.toml").read_bytes()
    # The salts differ.
    assert suite.seals()["digests"] != other.seals()["digests"]


def test_a_suite_under_way_keeps_its_truths_whatever_would_be_drawn_today(design, suite):
    data, learnt = design
    sealed = list(checked_truths(suite).values())
    drawn: list[str] = []
    first = plan_of(RULES, data, learnt, NOTE["seed"], tell=drawn.append)
    other = plan_of(RULES, data, learnt, "another seed")
    assert drawn[-1] == f"drawing what is hidden: study {RULES.count} of {len(drawn)}"
    plan = plan_of(RULES, data, learnt, "another seed", sealed, drawn.append)
    assert len(drawn) == RULES.count  # nothing is drawn again
    assert (plan.cases, plan.fresh) == (first.cases, first.fresh) != (other.cases, other.fresh)


def test_packed_forecasts_score_as_loose_ones(design, suite, tmp_path):
    _, learnt = design
    packed = shutil.make_archive(tmp_path / "forecasts", "zip", suite.path / "forecasts")
    loose = cases_of(suite, suite.path / "forecasts", ["ours"], learnt)
    assert cases_of(suite, zipfile.Path(packed), ["ours"], learnt) == loose


def test_strong_causes_are_found_and_the_method_beats_the_prior(design, suite):
    _, learnt = design
    cases = cases_of(suite, suite.path / "forecasts", ["ours", "signature", "prior"], learnt)
    table = score_table(cases)
    assert table.loc["mean log score", "ours"] > table.loc["mean log score", "prior"]
    singles = [one for one in cases["ours"] if one.kind == "single"]
    assert all(one.hidden[0] in one.names for one in singles)
    assert all(one.gained is not None for one in singles)
    blameless = [one for one in cases["ours"] if one.kind in ("nothing", "foreign")]
    assert not any(one.verdict == "named" for one in blameless)


def test_what_is_settled_does_not_count(design, suite, tmp_path):
    _, learnt = design
    (settled,) = {VARIANTS["known"].settled}
    cases = cases_of(suite, tmp_path, ["known"], learnt)["known"]
    names = {name.partition(":")[0] for one in cases for name in one.hidden}
    assert not names & set(settled)
    # No forecast was made: all get the floor.
    assert all(one.forecast is None for one in cases)


def test_a_truth_that_was_changed_is_refused(suite, tmp_path):
    other = Suite(tmp_path)
    (tmp_path / SEALS).write_bytes((suite.path / SEALS).read_bytes())
    truths = json.loads((suite.path / TRUTHS).read_text(encoding="utf-8"))
    next(iter(truths.values()))["kind"] = "nothing at all"
    (tmp_path / TRUTHS).write_text(json.dumps(truths), encoding="utf-8")
    with pytest.raises(CalibrationError, match="is not the one that was sealed"):
        checked_truths(other)
    assert len(checked_truths(suite)) == RULES.count


@pytest.mark.parametrize("name", ["frozen", "certain"])
def test_variants_judge_the_same_studies(design, suite, name):
    _, learnt = design
    record = forecasts.forecast_study(learnt, suite.studies()[0], name, None, FEW)
    assert record["verdict"] in ("none", "named", "set", "unknown")
    assert record["none"] + record["unknown"] + sum(record["inclusion"].values()) > 0.99
