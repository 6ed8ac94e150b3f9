"""Joint calibration on planted parameters: found, covered, told when not determined."""

from __future__ import annotations

import dataclasses
import json

import numpy as np
import pandas as pd
import pytest

from calibrate.errors import CalibrationError
from calibrate.questions.export import csv_text, json_text, liggghts_lines
from calibrate.questions.joint.calibration import calibrate_jointly
from calibrate.questions.joint.summary import names_outside
from calibrate.study.cases import planned_at_most
from tests.calibrate.questions import planted
from tests.calibrate.questions.planted import TRUTH, Measurement, bench, planted_study

BUDGET = "runs = 120"


@pytest.fixture(scope="module")
def glued(tmp_path_factory):
    """Return the result of one material on a glued plate, where restitution plays no role."""
    folder = tmp_path_factory.mktemp("glued")
    data = planted_study(
        folder, bench("A", "glued"), np.random.default_rng(5),
        free=("mu_pp", "mu_roll_pp", "e_pp"), design=BUDGET,
    )  # fmt: skip
    told: list[str] = []
    return calibrate_jointly(data, planted.run, tell=told.append), told


@pytest.mark.slow
def test_intervals_cover_planted_parameters(tmp_path) -> None:
    inside = []
    for seed in range(6):
        rng = np.random.default_rng(seed)
        data = planted_study(tmp_path, bench("A", "glued"), rng, design=BUDGET)
        posterior = calibrate_jointly(data, planted.run).posterior
        for name in posterior.names:
            span = posterior.interval(name, 0.9)
            inside.append(span.low <= TRUTH[name] <= span.high)
    # Of 12 honest intervals fewer than 8 cover once in 2000 times.
    assert np.mean(inside) >= 8 / 12


def test_what_is_not_determined_is_said_in_words(glued) -> None:
    result, _ = glued
    assert result.undetermined == ("e_pp",)
    assert any(
        s.startswith("e_pp: nothing in these data determines it; ") for s in result.sentences
    )
    table = result.table()
    assert table["determined"].to_dict() == {"mu_pp": True, "mu_roll_pp": True, "e_pp": False}
    assert "e_pp: NOT DETERMINED" in liggghts_lines(result, "A")


def test_the_engine_checks_the_optimum_and_draws(glued) -> None:
    result, told = glued
    assert {row.name for row in result.check} == {t.name for t in result.study.targets}
    for row in result.check:
        assert row.seeds == result.study.design.check_seeds
        # Three normal deviates of three planted targets.
        assert abs(row.z) < 3.5
        assert row.error_ratio < 1.0
        assert row.predicted == pytest.approx(row.measured, abs=4.0 * row.measured_se)
    assert 0.5 < result.unseen_z < 2.0
    assert result.sentences[-1] == told[-1] or "Final check" in told[-1]
    assert result.provenance["runs_of_budget"] <= result.study.design.runs


def test_checks_that_ask_for_more_runs_stay_within_the_budget(tmp_path, rng, monkeypatch) -> None:
    # Measurements that no emulator of so few runs can follow, and no runs but those of the check.
    monkeypatch.setitem(planted.ERRORS, "angle_deg", 0.01)
    monkeypatch.setattr("calibrate.planning.stop.LARGEST_MOVE", 1e3)
    data = planted_study(tmp_path, bench("A", "glued"), rng, design="runs = 90")
    told: list[str] = []
    result = calibrate_jointly(data, planted.run, tell=told.append)
    assert any(words.startswith("Final check") for words in told)
    assert result.provenance["runs_of_budget"] <= 90
    # A check that only looks again at a moved answer comes on top, three times at most.
    again = 3 * data.study.design.check_seeds * len(data.study.places)
    assert len(result.runs) <= sum(planned_at_most(data.study).values()) + again


def test_a_target_that_cannot_be_met_is_named_and_bends_nothing(tmp_path) -> None:
    free = ("mu_pp", "mu_roll_pp", "mu_pw")
    places = [*bench("A", "glued"), *bench("A", "steel")]
    data = planted_study(tmp_path, places, np.random.default_rng(5), free=free, design=BUDGET)
    name = next(t.name for t in data.study.targets if t.observable == "m1_g")
    old = data.scalars[name]
    bent = dataclasses.replace(old, value=1.6 * old.value)
    data = dataclasses.replace(data, scalars={**data.scalars, name: bent})
    result = calibrate_jointly(data, planted.run)
    rows = {row.name: row for row in result.check}
    assert not rows[name].met
    assert all(row.met for other, row in rows.items() if other != name)
    assert any(
        "most likely misses" in said and rows[name].label in said for said in result.sentences
    )
    for one in free:
        span = result.posterior.interval(one, 0.95)
        assert span.low <= TRUTH[one] <= span.high


def test_a_result_is_frozen_and_repeats_itself(tmp_path, glued) -> None:
    result, _ = glued
    with pytest.raises(dataclasses.FrozenInstanceError):
        result.best = {}
    again = calibrate_jointly(result.data, planted.run)
    assert np.array_equal(again.posterior.samples, result.posterior.samples)
    assert list(again.runs.table["case_id"]) == list(result.runs.table["case_id"])


def test_no_last_digit_becomes_another_run(glued) -> None:
    """Another processor rounds otherwise; piles would go their own ways from one other digit."""
    digits = np.random.default_rng(7)

    def nudged(specs, label):
        found = planted.run(specs, label)
        numbers = ["angle_deg", "t100_s"]
        return found.assign(**{n: found[n] * (1.0 + 1e-13 * digits.normal()) for n in numbers})

    result, _ = glued
    again = calibrate_jointly(result.data, nudged)
    asked = ["experiment", "seed", "mu_pp", "mu_roll_pp", "e_pp"]
    pd.testing.assert_frame_equal(
        again.runs.table[asked], result.runs.table[asked], check_exact=True
    )


def test_stored_runs_are_points_of_the_same_space(glued) -> None:
    result, _ = glued
    again = calibrate_jointly(result.data, planted.run, earlier=result.runs)
    assert len(again.runs) >= len(result.runs)
    assert again.provenance["runs_of_budget"] <= result.provenance["runs_of_budget"]


def test_exports_can_be_read_back(glued) -> None:
    result, _ = glued
    plain = json.loads(json_text(result))
    assert {row["name"] for row in plain["unknowns"]} == {"mu_pp", "mu_roll_pp", "e_pp"}
    assert len(plain["samples"]["mu_pp"]) == len(result.posterior.samples)
    assert csv_text(result).splitlines()[0].startswith("name,best,determined")


def test_liggghts_lines_hold_the_values(tmp_path, glued) -> None:
    result, _ = glued
    lines = [line.split() for line in liggghts_lines(result, "A").splitlines() if line[0] != "#"]
    properties = {words[4]: words[5:] for words in lines}
    assert properties["coefficientFriction"][:2] == ["peratomtypepair", "1"]
    assert float(properties["coefficientFriction"][2]) == pytest.approx(
        result.best["mu_pp"], rel=1e-5
    )
    assert properties["youngsModulus"] == ["peratomtype", "5e+06"]


def test_the_corner_plot_greys_what_is_not_determined(tmp_path, glued) -> None:
    result, _ = glued
    figure = result.figure()
    figure.savefig(tmp_path / "corner.png")
    words = [text.get_text() for axes in figure.axes for text in axes.texts]
    assert len(words) == 3
    assert ["not determined" in text for text in words] == [False, False, True]
    assert len(figure.axes[-1].get_lines()) == 2  # prior and posterior, and no value


def test_predictions_hold_what_was_not_measured(tmp_path, rng) -> None:
    measured = [m for m in bench("A", "steel") if m.observable != "m3_g"]
    data = planted_study(tmp_path, measured, rng, free=("e_pp", "e_pw"), design="runs = 100")
    result = calibrate_jointly(data, planted.run)
    predicted = result.predict("plate_impact", "m3_g", surface="steel")
    true = planted.stand_in.means(
        planted.spec_at(Measurement("A", "steel", "plate_impact", "m3_g"))
    )
    # One planted study: an interval of 90 % would miss in a tenth of machines and seeds.
    low, high = np.quantile(predicted.samples, (0.005, 0.995))
    assert low < true["m3_g"] < high
    assert high - low < 0.5 * true["m3_g"]
    with pytest.raises(CalibrationError, match="did you mean 'steel'"):
        result.predict("heap", "angle_deg", surface="stel")


def test_too_few_runs_are_an_error_with_the_reason(tmp_path, rng) -> None:
    data = planted_study(tmp_path, bench("A", "glued"), rng, design=BUDGET)

    def failing(specs, label) -> pd.DataFrame:
        table = planted.run(specs, label)
        bad = (table["experiment"] == "heap") & (np.arange(len(table)) % 4 != 0)
        return table.assign(
            status=np.where(bad, "failed", "ok"), reason=np.where(bad, "no heap was left", "")
        )

    with pytest.raises(CalibrationError, match=r"heap on a glued surface: .* no heap was left"):
        calibrate_jointly(data, failing)


def test_a_check_that_moves_the_answer_is_repeated_there(tmp_path) -> None:
    """The values given are those that were checked, and lie in the intervals beside them."""
    rng = np.random.default_rng(2)
    data = planted_study(tmp_path, bench("A", "glued"), rng, design="runs = 40")

    def two_faced(specs, label) -> pd.DataFrame:
        table = planted.run(specs, label)
        return table if label == "Final check" else table.assign(angle_deg=table["angle_deg"] + 2.5)

    told: list[str] = []
    result = calibrate_jointly(data, two_faced, tell=told.append)
    assert any("the check is repeated there" in line for line in told)
    best = np.array([result.best[name] for name in result.posterior.names])
    assert names_outside(best, result.posterior, 0.68) == ()
    assert all(row.seeds >= data.study.design.check_seeds for row in result.check)


def test_a_value_outside_its_interval_is_told(glued) -> None:
    result, _ = glued
    names = result.posterior.names
    best = np.array([result.best[name] for name in names])
    assert names_outside(best, result.posterior, 0.9) == ()
    best[0] = 2.0
    assert names_outside(best, result.posterior, 0.9) == (names[0],)
