"""What if something had been measured: the whole loop, and that it is the table [known]."""

from __future__ import annotations

import pytest

from calibrate.causes.offers import Trial
from calibrate.causes.studies.from_study import with_effects
from calibrate.causes.studies.result import StudyDiagnosis
from calibrate.causes.studies.study_diagnosis import diagnose_runs
from calibrate.causes.studies.suppose import Supposed, suppose
from calibrate.causes.studies.what_if import diagnose_again
from calibrate.errors import CalibrationError
from calibrate.study.data import StudyData, load_data
from tests.calibrate.causes import studies

PERIOD, TRUTH = studies.PERIOD, studies.TRUTH
FLOW, TILT = "mass_flow_factor", "plate_tilt_deg"


@pytest.fixture(scope="module")
def slow_plate(tmp_path_factory) -> StudyDiagnosis:
    """Diagnose a study whose plate is slow; a wrong flow would look the same.

    The plate is level, and friction was measured, so that something is seen to be wrong.
    """
    folder = tmp_path_factory.mktemp("slow")
    data = studies.study(folder, {PERIOD: TRUTH}, 5, studies.LEVEL + studies.SHEAR)
    base = studies.base_runs(data)
    return diagnose_runs(data, base, studies.run, more=16, further=60, options=studies.FEW)


def _again(found: StudyDiagnosis, data: StudyData) -> StudyDiagnosis:
    return diagnose_again(
        data, found.runs, twins=found.twins, added=found.added, few=found.unseen,
        options=studies.FEW,
    )  # fmt: skip


def _supposed(data: StudyData, name: str, value: float, se: float, where: str = "") -> StudyData:
    return suppose(data, [Supposed(name, where, value, se)], "--with")[0]


def _shares(found: StudyDiagnosis) -> dict[str, float]:
    answers = found.found.verdict.answers
    return {**answers.single, **{" and ".join(two): p for two, p in answers.pairs.items()}}


def test_the_next_measurement_leads_from_look_alikes_to_the_cause(slow_plate) -> None:
    verdict = slow_plate.found.verdict
    assert verdict.kind == "set"
    assert {one.partition(":")[0] for one in verdict.names} == {PERIOD, FLOW}
    # As docs/diagnosis.md tells; another order of sums may move them by a few hundredths.
    prospect = slow_plate.found.prospect
    assert verdict.answers.inclusion[PERIOD] == pytest.approx(0.69, abs=0.05)
    assert prospect.entropy == pytest.approx(0.65, abs=0.05)
    assert prospect.offers[0].information == pytest.approx(0.62, abs=0.05)
    first = slow_plate.found.prospect.offers[0]
    best = first.measurement
    assert best.name.partition(":")[0] in (PERIOD, FLOW)
    # What each result would mean: the one names what is measured, the other what looks like it.
    for result in first.outcomes[:2]:
        lead = next(iter(result.probability))
        same = lead.partition(":")[0] == best.effect
        assert same is (abs(result.values[0]) > 5.0 * best.se)
    true = TRUTH if best.effect == PERIOD else 0.0
    after = _again(slow_plate, _supposed(slow_plate.data, PERIOD, true, best.se)).found
    assert (after.verdict.kind, after.verdict.names) == ("named", (PERIOD,))
    span = after.interval(PERIOD)
    assert span.low <= TRUTH <= span.high
    assert after.prospect.entropy < 0.5 * slow_plate.found.prospect.entropy
    # As much as was expected on average comes about, and never more than was open.
    assert first.information <= slow_plate.found.prospect.entropy + 1e-3


def test_further_experiments_are_ranked_with_the_measurements(slow_plate) -> None:
    """Another period of the plate tells a wrong one from a wrong flow, if later than a clock."""
    assert 0 < slow_plate.further <= 60
    assert slow_plate.record()["further_runs"] == slow_plate.further
    offers = {one.measurement.name: one for one in slow_plate.found.prospect.offers}
    name, faster = next(one for one in offers.items() if one[0].startswith("conveyor_frequency"))
    assert isinstance(faster.measurement, Trial)
    assert faster.information > 0.5 * slow_plate.found.prospect.entropy
    assert list(offers).index(PERIOD) < list(offers).index(name)
    # Of runs that are there nothing more can be asked.
    again = _again(slow_plate, slow_plate.data).found.prospect.offers
    assert [one.measurement.name for one in again] == [
        one.measurement.name for one in offers.values() if not isinstance(one.measurement, Trial)
    ]


def test_the_other_result_leads_to_the_look_alike(slow_plate) -> None:
    after = _again(slow_plate, _supposed(slow_plate.data, PERIOD, 0.0, 0.002)).found.verdict
    assert after.answers.inclusion[PERIOD] < 0.05
    assert after.names
    assert {one.partition(":")[0] for one in after.names} == {FLOW}


def test_it_is_the_table_known(slow_plate, tmp_path) -> None:
    """The same runs and the table in the file give the same numbers to the last digit."""
    supposed = _again(slow_plate, _supposed(slow_plate.data, PERIOD, 0.01, 0.005))
    text = slow_plate.data.path.read_text(encoding="utf-8")
    path = tmp_path / "study.toml"
    path.write_text(f"{text}\n[known.plate_period]\nvalue = 0.01\nse = 0.005\n", encoding="utf-8")
    written = _again(slow_plate, load_data(path))
    assert _shares(supposed) == _shares(written)
    assert supposed.found.verdict.kind == written.found.verdict.kind


def test_the_same_runs_without_anything_give_the_same_again(slow_plate) -> None:
    assert _shares(_again(slow_plate, slow_plate.data)) == _shares(slow_plate)


def test_a_measurement_of_one_funnel_says_nothing_of_the_other(slow_plate) -> None:
    data = slow_plate.data
    one = _supposed(data, FLOW, 0.0, 0.01, "conveyor_flat")
    (known,) = one.study.known[FLOW]
    assert (known.experiment, known.surface) == ("conveyor", "steel")
    after = _again(slow_plate, one).found
    assert after.board.measured(after.board.candidate(f"{FLOW}:conveyor_glued")) == ()
    (bench,) = after.board.measured(after.board.candidate(FLOW))
    assert (bench.value, bench.se) == (0.0, 0.01)
    # A funnel that was weighed is no cause any more; one that was not may be.
    assert after.verdict.answers.inclusion[f"{FLOW}:conveyor_flat"] < 0.02
    assert after.verdict.answers.inclusion[FLOW] < 0.02


def test_an_unknown_of_the_base_model_can_be_supposed(slow_plate) -> None:
    found = _again(slow_plate, _supposed(slow_plate.data, "mu_roll_pp", 0.2, 0.01)).found
    index = found.board.problem.space.index("mu_roll_pp")
    values, before = (one.samples(())[0][:, index] for one in (found, slow_plate.found))
    # No vaguer than the measurement alone, 0.01, but for 2000 draws of 60 effective ones.
    assert values.std() < 0.013 < before.std()
    assert abs(values.mean() - 0.2) < 0.03


def test_what_is_there_is_replaced_and_said(slow_plate) -> None:
    data, said = suppose(slow_plate.data, [Supposed(TILT, "", 1.0, 0.5)], "--with")
    assert said == ["plate_tilt_deg = 0 ± 0.05"]
    (known,) = data.study.known[TILT]
    assert (known.value, known.se) == (1.0, 0.5)
    assert slow_plate.data.study.known[TILT][0].se == 0.05
    funnels = [Supposed(FLOW, w, 0.0, 0.01) for w in ("conveyor_flat", "conveyor_glued")]
    both, said = suppose(slow_plate.data, funnels, "--with")
    assert (len(both.study.known[FLOW]), said) == (2, [])
    _, said = suppose(both, [Supposed(FLOW, "conveyor_flat", 0.02, 0.01)], "--with")
    assert said == ["mass_flow_factor = 0 ± 0.01"]


@pytest.mark.parametrize(
    ("one", "expected"),
    [
        (Supposed("plate_perod", "", 0.0, 0.1), "did you mean 'plate_period'"),
        (Supposed(FLOW, "conveyor_steel", 0.0, 0.1), "did you mean 'conveyor_flat'"),
        (Supposed(PERIOD, "conveyor", 0.0, 0.1), "is the same everywhere; leave out ':conveyor'"),
        (Supposed(PERIOD, "", 3.0, 0.1), "lies outside -0.3 to 0.3 -; check its unit"),
        (Supposed("mu_pw", "", -3.0, 0.1), "known.mu_pw: mu_pw = -3"),
        (Supposed("e_pp", "", 0.5, 0.1), "e_pp is not free in this study; free it under"),
        (Supposed("size_distribution", "", 1.0, 0.1), "is no candidate cause in this study"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_with_its_place(slow_plate, one, expected) -> None:
    with pytest.raises(CalibrationError, match="--with ") as told:
        suppose(slow_plate.data, [one], "--with")
    assert str(told.value).startswith(f"--with {one.word}: ")
    assert expected in str(told.value)


def test_a_site_is_where_a_number_is_one(slow_plate) -> None:
    study = slow_plate.data.study
    steel = next(p for p in study.places if p.surface == "steel" and p.experiment == "conveyor")
    heap = next(p for p in study.places if p.experiment == "heap")
    site = study.layout.site
    assert site(FLOW, heap) is None
    assert site(FLOW, steel) == "conveyor_flat"
    assert site("cohesion_J_m3", steel) == "A"
    assert site("wall_adhesion_J_m3", steel) == "steel"
    assert site(PERIOD, steel) == ""
    assert site("mu_pw", steel) == "A/steel"
    # What a study frees is one number where the study says so.
    freed = with_effects(slow_plate.data).study
    assert freed.layout.site(FLOW, steel) == ""
