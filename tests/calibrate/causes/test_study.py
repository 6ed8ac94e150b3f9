"""The diagnosis of a study through its runs: twins, what they save, the extended study."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibrate.causes.diagnosis import Diagnosis
from calibrate.causes.studies import study_diagnosis
from calibrate.causes.studies.extend import extended_study, write_extended
from calibrate.causes.studies.result import StudyDiagnosis
from calibrate.causes.studies.sharpen import BATCH, MORE, POINTS_SEED
from calibrate.causes.studies.study_diagnosis import diagnose_runs, first_twins
from calibrate.causes.studies.verify import VERIFY_SEED, EngineSays
from calibrate.causes.studies.words import study_sentences
from calibrate.causes.sway import sways
from calibrate.errors import CalibrationError
from calibrate.report.diagnosis.section import section_html
from calibrate.report.diagnosis.tables import diagnosis_tables
from calibrate.report.record import plain
from calibrate.study.load import load_study
from calibrate.study.write import study_text
from tests.calibrate.causes import studies

FLOW = "mass_flow_factor"


@pytest.fixture(scope="module")
def slow_funnel(tmp_path_factory) -> tuple[StudyDiagnosis, list, list[str]]:
    """Diagnose a study whose period was timed and whose plate is level; the flow is wrong."""
    known = "[known.plate_period]\nse = 0.002\n[known.plate_tilt_deg]\nse = 0.05\n"
    data = studies.study(tmp_path_factory.mktemp("flow"), {FLOW: 0.25}, 5, known)
    asked, told = [], []

    def run(specs, label):
        asked.extend(specs)
        return studies.run(specs, label)

    found = diagnose_runs(data, studies.base_runs(data), run, options=studies.FEW, tell=told.append)
    return found, asked, told


def test_what_was_measured_on_its_own_is_not_blamed(slow_funnel) -> None:
    found, _, _ = slow_funnel
    verdict = found.found.verdict
    assert verdict.kind in ("named", "set")
    assert FLOW in verdict.names
    assert verdict.answers.inclusion["plate_period"] < 0.05
    assert verdict.answers.inclusion["plate_tilt_deg"] < 0.05
    span = found.found.interval(FLOW)
    assert span.low <= 0.25 <= span.high


def test_what_cannot_be_seen_gets_few_twins(slow_funnel) -> None:
    found, asked, told = slow_funnel
    assert "wall_adhesion_J_m3" in found.unseen
    assert "wall_adhesion_J_m3" in told[0]
    counts = {
        name: sum(name in spec.effects and spec.seed < VERIFY_SEED for spec in asked)
        for name in ("cohesion_J_m3", "wall_adhesion_J_m3")
    }
    # Per place; some cases are asked for twice, first among the few and then among all.
    assert counts["cohesion_J_m3"] > 3 * counts["wall_adhesion_J_m3"] > 0


def test_runs_are_added_where_the_evidence_is_uncertain(slow_funnel) -> None:
    found, asked, told = slow_funnel
    added = [s for s in asked if POINTS_SEED <= s.seed - found.data.study.run.seed < VERIFY_SEED]
    near = [line.split(": ")[1] for line in told if line.endswith("near the strength found")]
    assert 0 < len(added) == found.added - sum(int(line.split()[0]) for line in near) <= MORE
    # They are of the base model, and of the causes that lead; of nothing else.
    leaders = {
        name for line in told for name in found.found.verdict.answers.inclusion if name in line
    }
    on = {name for spec in added for name, strength in spec.effects.items() if strength}
    assert on <= leaders
    said = [line for line in told if "with other runs it might differ" in line]
    assert len(said) == -(-len(added) // BATCH)
    numbers = [float(word.strip(";:")) for word in said[0].split() if word[0].isdigit()]
    ratio, sway = numbers[:2]
    # As emulators learn, less of the evidence is luck.
    now = sways(found.found.found, [(FLOW,)], 1)[FLOW,]
    assert now / found.found.log_ratio(FLOW) < sway / ratio


def test_the_engine_is_asked_with_seeds_that_nothing_has_learnt_from(slow_funnel) -> None:
    found, asked, told = slow_funnel
    fresh = [spec for spec in asked if spec.seed >= VERIFY_SEED]
    assert {spec.seed for spec in fresh}.isdisjoint(spec.seed for spec in found.runs.specs)
    seeds, places = found.data.study.design.check_seeds, len(found.data.study.places)
    # Without the cause, with it, and again after each round of runs near its strength.
    rounds = 2 + sum(line.endswith("near the strength found") for line in told)
    assert len(fresh) == rounds * seeds * places
    assert {row.name for row in found.engine_before} == {t.name for t in found.data.study.targets}


def test_the_page_is_made_from_plain_data(slow_funnel) -> None:
    found, _, _ = slow_funnel
    facts = {"extended": ["a/b.toml", "<case>"], "next": "bulkcal calibrate a/b.toml"}
    record = json.loads(json.dumps(plain({**found.record(), **facts}), allow_nan=False))
    html = section_html(record, b"png")
    for sentence in found.sentences[:2]:
        assert sentence.split("=")[0].split("'")[0] in html
    assert "&lt;case&gt;" in html
    # No residuals: readings were not left out.
    assert html.count("<table>") == 3 + bool(record["measure_next"]["offers"])
    assert found.figure().axes
    parts = {**record, "groups": [{"kind": "wall", "name": "glued", "z": 2.7}]}
    assert html.count("<table>") + 1 == section_html(parts, b"png").count("<table>")
    (table,) = (one for one in diagnosis_tables(parts) if "left out" in str(one.title))
    assert [list(column.cells) for column in table.columns] == [["wall"], ["glued"], ["2.7"]]
    row = record["candidates"][0]
    nasty = {**record, "candidates": [{**row, "name": "<script>"}]}
    assert "<script>" not in section_html(nasty, b"png")


def test_a_cause_of_one_apparatus_is_free_there_alone(slow_funnel) -> None:
    found, _, _ = slow_funnel
    own = _named(found.found, f"{FLOW}:conveyor_flat")
    study = extended_study(found.data.study, own)
    parameter = study.parameters[FLOW]
    assert (parameter.scope, set(parameter.range)) == ("surface", {"steel"})
    assert parameter.value["glued"] == 0.0
    both = extended_study(found.data.study, _named(found.found, FLOW)).parameters[FLOW]
    assert (both.scope, set(both.range)) == ("global", {""})


def test_the_extended_study_loads_and_an_outdated_one_is_marked(slow_funnel, tmp_path) -> None:
    found, _, _ = slow_funnel
    for name in (FLOW, f"{FLOW}:conveyor_flat"):
        named = _named(found.found, name)
        written = write_extended(named, found.data, tmp_path / "x", lambda spec, place: place)
        text = written[0].read_text(encoding="utf-8")
        assert found.data.sha256 in text
        again = load_study(written[0])
        assert study_text(again).strip() in text
        assert len(written) == (5 if name == FLOW else 3)
    none = replace(found.found.verdict, kind="none", names=())
    assert write_extended(replace(found.found, verdict=none), found.data, tmp_path / "x") == []
    assert not written[0].exists()
    assert written[0].with_name(written[0].name + ".outdated").exists()


def _named(found: Diagnosis, name: str) -> Diagnosis:
    return replace(found, verdict=replace(found.verdict, kind="named", names=(name,)))


def test_what_the_engine_still_misses_with_the_cause_is_said(slow_funnel) -> None:
    found, _, _ = slow_funnel
    named = _named(found.found, FLOW)
    before = [replace(row, z=3.0) for row in found.engine_before]
    good = [replace(row, z=0.5) for row in before]
    said = " ".join(study_sentences(named, before, EngineSays(tuple(good))))
    assert f"standard errors; with {FLOW} 0.50." in said
    assert "still misses" not in said
    missed = replace(good[0], z=-2.6)
    said = " ".join(study_sentences(named, before, EngineSays((missed, *good[1:]))))
    assert f"the engine still misses {good[0].name} (+2.6)" in said
    said = " ".join(study_sentences(named, before, EngineSays(tuple(before))))
    assert "the engine does not confirm the gain, so the cause is not established" in said


def test_where_emulators_know_less_than_was_measured_is_said(slow_funnel) -> None:
    found, _, _ = slow_funnel
    before = [
        replace(row, measured_se=3.0, simulated_se=4.0, error_ratio=1.0)
        for row in found.engine_before
    ]
    known = " ".join(study_sentences(found.found, before, EngineSays()))
    assert "the emulators know" not in known
    # sqrt(25) of 3 against sqrt(3^2 + 4^2)
    loose = [replace(before[0], error_ratio=25.0), *before[1:]]
    said = " ".join(study_sentences(found.found, loose, EngineSays()))
    assert f"the emulators know 1 of {len(before)} targets to more than 2 standard errors" in said
    assert f"({before[0].name}: 3)" in said


def test_none_is_no_verdict_where_the_engine_misses_by_more_than_luck(slow_funnel) -> None:
    found, _, _ = slow_funnel
    none = replace(found.found.verdict, kind="none", names=(), reason="errors explain it")
    quiet = replace(found, found=replace(found.found, verdict=none))
    near = [replace(row, z=1.0) for row in found.engine_before]
    far = [replace(near[0], z=-6.0), *near[1:]]  # chi2 of 36 + n - 1: p < 1e-3 for n < 30
    named, doubted = "No cause named:", "Not told yet: no cause is named"
    for rows, begin in (([], named), (near, named), (far, doubted)):
        record = replace(quiet, engine_before=tuple(rows)).record()
        assert record["headline"].startswith(begin)
        assert record["sentences"][0] == record["headline"]
    off = np.sqrt((36.0 + len(far) - 1) / len(far))
    assert f"off by {off:.1f} standard errors" in record["headline"]


def test_a_study_without_any_effect_left_is_told_so(slow_funnel, monkeypatch) -> None:
    found, _, _ = slow_funnel
    monkeypatch.setattr(study_diagnosis, "considered", lambda study: ())
    with pytest.raises(CalibrationError, match="no effect is left that could be missing"):
        first_twins(found.data, found.runs)


def test_twins_of_a_study_with_an_effect_on_keep_it(tmp_path: Path) -> None:
    data = studies.study(tmp_path, {}, 1, "[effects]\nplate_tilt_deg = 1.0\n")
    twins = first_twins(data, studies.base_runs(data))
    conveyed = [spec for spec in twins if spec.experiment == "conveyor"]
    assert conveyed
    assert all(spec.effects["plate_tilt_deg"] == 1.0 for spec in conveyed)
    assert {len(spec.effects) for spec in conveyed} == {2}
    assert np.all([spec.effects.get(FLOW, 1.0) != 0.0 for spec in twins])
