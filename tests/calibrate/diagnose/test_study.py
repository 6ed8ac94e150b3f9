"""From a study file to a problem, and from a verdict to an extended study."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from calibrate.diagnose.extend import write_extended
from calibrate.diagnose.from_study import problem_of
from calibrate.diagnose.local.design import probe_levels
from calibrate.diagnose.pipeline import Diagnosis, diagnose
from calibrate.errors import CalibrationError
from calibrate.report.record import start_of
from calibrate.runs.reuse import StoredRunner, with_curves
from calibrate.study.data import load_data
from calibrate.study.load import load_study
from calibrate.study.measured.curves import first_time
from calibrate.study.schema.materials import Material
from calibrate.study.schema.settings import Known
from calibrate.study.write import study_text
from liggghts_io import CaseError, CaseResult, CaseSpec, load_spec
from liggghts_io.case.results import store_tables
from liggghts_io.case.spec import script_of
from liggghts_io.effects import EFFECTS
from tests.calibrate.diagnose import engine as recorded

STUDY = recorded.CASES / "hsp13_steel.toml"


def test_the_bundled_study_becomes_a_problem() -> None:
    problem = problem_of(load_data(STUDY), recorded.PUBLISHED)
    assert set(problem.order()) == {"_".join(w) for w in recorded.EXPERIMENTS}
    assert len(problem.observables) == 8
    assert problem.active["heap_glued"] == recorded.GLUED
    assert len(problem.active["plate_impact_steel"]) == 6
    tried = {name for name, effect in EFFECTS.items() if effect.candidate}
    assert {c.effect for c in problem.candidates} == tried
    assert tried == {*EFFECTS} - {"air_drag", "restitution_slope", "static_friction_ratio"}
    assert "mass_flow_factor:conveyor_glued" in {c.name for c in problem.candidates}
    repeats = {o.name: o.repeats for o in problem.observables}
    assert repeats["heap_steel.angle_deg"] == 15
    assert repeats["plate_impact_steel.m1_g"] == 0


def test_an_effect_of_which_too_little_is_known_is_no_candidate() -> None:
    data = load_data(STUDY)
    known = data.study.materials[0].model_dump(exclude_unset=True, by_alias=True)
    plain = {
        key: value for key, value in known.items() if key not in ("d10_um", "d50_um", "d90_um")
    }
    study = data.study.model_copy(update={"materials": [Material.model_validate(plain)]})
    problem = problem_of(dataclasses.replace(data, study=study), recorded.PUBLISHED)
    assert "size_distribution" not in {c.effect for c in problem.candidates}


def test_limits_and_signs_come_from_the_registry() -> None:
    problem = problem_of(load_data(STUDY), recorded.PUBLISHED)
    for one in problem.candidates:
        effect = EFFECTS[one.effect]
        assert effect.low <= one.lower <= 0.0 <= one.upper <= effect.high
        assert one.two_sided == (effect.low < 0.0)
        assert 0.0 < one.step <= one.upper


def test_a_new_effect_is_a_candidate_without_another_change(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    humid = dataclasses.replace(EFFECTS["cohesion_J_m3"], name="humidity", title="Humid air")
    monkeypatch.setitem(EFFECTS, "humidity", humid)
    problem = problem_of(load_data(STUDY), recorded.PUBLISHED)
    assert "humidity" in {c.name for c in problem.candidates}


def test_an_effect_that_is_on_already_is_no_candidate() -> None:
    study = recorded.changed(load_data(STUDY), effects={"plate_tilt_deg": 1.0})
    problem = problem_of(study, recorded.PUBLISHED)
    assert "plate_tilt_deg" not in {c.name for c in problem.candidates}
    assert problem.experiments["conveyor_steel"].effects == {"plate_tilt_deg": 1.0}


def test_a_missing_start_value_is_named() -> None:
    start = {k: v for k, v in recorded.PUBLISHED.items() if k != "e_pp"}
    with pytest.raises(CalibrationError, match=r"no start value for e_pp; run 'bulkcal calibrate"):
        problem_of(load_data(STUDY), start)


def test_a_record_without_parameters_is_refused(tmp_path: Path) -> None:
    record = tmp_path / "calibration.json"
    record.write_text(json.dumps({"stages": []}), encoding="utf-8")
    with pytest.raises(CalibrationError, match="holds no calibration"):
        start_of(record)


def test_time_at_a_mass_is_interpolated_and_missing_beyond_the_curve() -> None:
    time, mass = np.array([0.0, 1.0, 3.0]), np.array([0.0, 10.0, 20.0])
    assert first_time(time, mass, 15.0) == pytest.approx(2.0)
    assert first_time(time, mass, 10.0) == pytest.approx(1.0)
    assert np.isnan(first_time(time, mass, 21.0))


def test_a_curve_that_falls_is_refused_with_its_file(tmp_path: Path) -> None:
    data = {w: {n: (10.0, 0.1) for n in s} for w, s in recorded.TABLE_SEM.items()}
    for surface in ("glued", "steel"):
        data["conveyor", surface] = {f"t{m}_s": (5.0 + m, 0.1) for m in recorded.LEVELS}
    study = recorded.write_study(tmp_path, data, curve=True)
    problem = problem_of(study, recorded.PUBLISHED)
    steel = [o for o in problem.observables if o.experiment == "conveyor_steel"]
    assert [o.quantity for o in steel] == [f"mass_time@{level}" for level in recorded.LEVELS]
    # Written with six digits.
    assert all(o.sem == pytest.approx(0.1, rel=1e-5) for o in steel)
    (tmp_path / "mass_time_steel.csv").write_text("time_s,mass_g,sem_g\n1,5,1\n2,4,1\n3,6,1\n")
    with pytest.raises(CalibrationError, match=r"mass_time_steel.csv:3: mass_g = '4' is less"):
        load_data(study.path)


def test_missing_runs_are_announced_with_their_cost_and_stored_ones_are_not_run() -> None:
    known = recorded.Hidden().spec(("heap", "steel"), 1)
    other = recorded.Hidden().spec(("heap", "steel"), 2)
    store = {repr(known): CaseResult("a", Path(), "ok", "", {"angle_deg": 34.0}, 120.0)}
    asked: list[CaseSpec] = []
    told: list[str] = []

    read: list[CaseSpec] = []

    class Lost:
        def results(self, specs, label):
            del label
            asked.extend(specs)
            return [CaseResult("b", Path(), "failed", "lost", {}, 60.0) for _ in specs]

    def stored(spec: CaseSpec) -> CaseResult | None:
        read.append(spec)
        return store.get(repr(spec))

    runner = StoredRunner(Lost(), stored, told.append, workers=2)
    results = runner([known, other, known])
    # A run that was killed is not stored; what it was lost for is said all the same.
    assert [(r.status, r.reason) for r in results] == [("ok", ""), ("failed", "lost"), ("ok", "")]
    assert asked == [other]
    assert read == [known, other]  # every stored result is read once
    assert told == ["1 of 2 runs are missing: about 1.0 min on 2 processes"]


def test_curve_points_are_added_to_a_conveyor_result(tmp_path: Path) -> None:
    curve = {"time_s": np.array([0.0, 10.0]), "mass_g": np.array([0.0, 100.0])}
    tables = store_tables(tmp_path, {"mass_time.csv": curve})
    result = CaseResult("a", tmp_path, "ok", "", {"t100_s": 9.9}, 1.0, tables=tables)
    spec = recorded.Hidden().spec(("conveyor", "steel"), 1)
    levels = {("conveyor", "mass_time"): (50.0, 200.0)}
    shown = with_curves(result, spec, levels).observables
    assert with_curves(result, recorded.Hidden().spec(("heap", "steel"), 1), levels) == result
    # The curve ends before 200 g.
    assert shown == {"t100_s": 9.9, "mass_time@50": pytest.approx(5.0)}
    (tmp_path / "mass_time.csv").write_text("time_s,mass_g\n0,0\n10,200\n", encoding="utf-8")
    with pytest.raises(CaseError, match=r"mass_time.csv: was changed since the run"):
        with_curves(result, spec, levels)


@pytest.fixture(scope="module")
def tilted(tmp_path_factory: pytest.TempPathFactory) -> tuple[Diagnosis, Path]:
    directory = tmp_path_factory.mktemp("tilted")
    runs = recorded.read_runs()
    hidden = recorded.CASES_HIDDEN["tilt"]
    problem = recorded.problem(directory, runs, hidden, 11)
    rng = np.random.default_rng(11)
    runner = recorded.Recorded(runs)
    return diagnose(problem, runner, rng=rng, options=recorded.OPTIONS), directory


def test_the_extended_study_loads_and_its_cases_differ_where_the_effect_acts(
    tilted: tuple[Diagnosis, Path], tmp_path: Path
) -> None:
    found, directory = tilted
    data = load_data(directory / "study.toml")
    written = write_extended(found, data, tmp_path / "extended")
    extended = load_study(written[0])
    strength = found.verdict.suspects[0].strength
    assert extended.effects == {"plate_tilt_deg": pytest.approx(strength, rel=1e-5)}
    text = written[0].read_text(encoding="utf-8")
    assert data.sha256 in text
    assert data.sha256 == hashlib.sha256(data.path.read_bytes()).hexdigest()
    assert {p.name for p in written[1:]} == set(found.problem.experiments)
    for case in written[1:]:
        spec = load_spec(case)
        plain = script_of(dataclasses.replace(spec, effects={}))
        off = script_of(dataclasses.replace(spec, effects={"plate_tilt_deg": 0.0}))
        script = (case / "in.script").read_text(encoding="utf-8")
        assert off == plain  # strength zero is the base model, byte for byte
        assert (plain.rstrip() not in script) == case.name.startswith("conveyor")
    shutil.rmtree(tmp_path / "extended")


def test_an_independent_measurement_limits_a_candidate_and_costs_no_run() -> None:
    plain = problem_of(load_data(STUDY), recorded.PUBLISHED)
    study = recorded.changed(load_data(STUDY), known={"plate_period": [Known(se=0.005)]})
    known = problem_of(study, recorded.PUBLISHED)
    before = next(c for c in plain.candidates if c.name == "plate_period")
    after = next(c for c in known.candidates if c.name == "plate_period")
    assert (after.lower, after.upper) == pytest.approx((-0.015, 0.015))
    assert probe_levels(after) == probe_levels(before)


def test_known_values_survive_writing_the_study_again(tmp_path: Path) -> None:
    text = STUDY.read_text(encoding="utf-8") + "\n[known.plate_period]\nse = 0.005\n"
    for file in STUDY.parent.glob("*.csv"):
        (tmp_path / file.name).write_bytes(file.read_bytes())
    path = tmp_path / "study.toml"
    path.write_text(text, encoding="utf-8")
    study = load_study(path)
    path.write_text(study_text(study), encoding="utf-8")
    assert load_study(path) == study
    assert study.known == {"plate_period": [Known(se=0.005)]}


def test_an_extended_study_of_an_earlier_verdict_is_marked_as_outdated(
    tilted: tuple[Diagnosis, Path], tmp_path: Path
) -> None:
    found, directory = tilted
    data = load_data(directory / "study.toml")
    written = write_extended(found, data, tmp_path, lambda spec, place: place)
    none = dataclasses.replace(found.verdict, kind="none", names=(), intervals={})
    later = dataclasses.replace(found, verdict=none)
    assert write_extended(later, data, tmp_path, lambda spec, place: place) == []
    assert not written[0].exists()
    assert written[0].with_name(written[0].name + ".outdated").exists()
