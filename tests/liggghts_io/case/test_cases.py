"""Case directories: identity, records, failures as data, repeated execution."""

import json
import pickle
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace

import pytest

from liggghts_io import (
    CaseError,
    case_id,
    execute,
    load_result,
    load_spec,
    post_case,
    run_case,
    write_case,
)
from liggghts_io.case import execution, liggghts, sources
from liggghts_io.case.spec import identity_of
from liggghts_io.experiments import EXPERIMENTS


def test_walls_of_one_kind_share_their_case_at_equal_numbers(make_spec):
    assert {case_id(make_spec(surface=one)) for one in ("flat", "steel", "alumina")} == {
        case_id(make_spec(surface="steel"))
    }


def test_case_id_is_stable_and_depends_on_every_input(make_spec, particles, monkeypatch):
    base = make_spec()
    assert case_id(base) == case_id(make_spec())
    changes = [
        {"seed": 2}, {"surface": "glued"}, {"scale": "lab"}, {"particle": particles["SG10H"]},
        {"engine": "liggghts"}, {"apparatus": {"pour_grains": 700}},
        {"parameters": {**base.parameters, "mu_pp": 0.5}}, {"effects": {"cohesion_J_m3": 1.0}},
    ]  # fmt: skip
    ids = {case_id(make_spec(**change)) for change in changes}
    assert len(ids | {case_id(base)}) == len(changes) + 1
    monkeypatch.setattr("liggghts_io.case.sources.engine_code", lambda engine: "another")
    assert case_id(base) not in ids | {case_id(make_spec(seed=3))}


def test_case_id_does_not_depend_on_order_or_integer_spelling(make_spec):
    base = make_spec(apparatus={"pour_grains": 700, "pour_tau": 80})
    other = make_spec(
        apparatus={"pour_tau": 80.0, "pour_grains": 700.0},
        parameters=dict(reversed(base.parameters.items())),
    )
    assert case_id(base) == case_id(other)


def test_wall_parameters_do_not_matter_on_a_glued_plate(make_spec):
    base = make_spec(surface="glued")
    other = make_spec(surface="glued", parameters={**base.parameters, "mu_pw": 0.9, "e_pw": 0.1})
    assert case_id(base) == case_id(other)


def test_written_case_is_read_back(make_spec, tmp_path):
    spec = make_spec("conveyor", effects={"plate_tilt_deg": 1.0}, seed=4)
    write_case(spec, tmp_path)
    assert case_id(load_spec(tmp_path)) == case_id(spec)
    assert {path.name for path in tmp_path.iterdir()} == {
        "case.json",
        "in.script",
        "meshes",
        "lock",
    }


@pytest.mark.parametrize(
    "name", ["in.script", "meshes/plate.stl", "experiment.toml", "case.json", "lock"]
)
def test_nothing_of_others_is_written_over(make_spec, tmp_path, name):
    others = {tmp_path / name: "theirs\n", tmp_path / "meshes" / "hopper.stl": "theirs\n"}
    for path, text in others.items():
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
    with pytest.raises(CaseError, match=rf"{name}: is no file of a case, .* another --out"):
        write_case(make_spec(), tmp_path)
    assert {path: path.read_text() for path in tmp_path.rglob("*") if path.is_file()} == others


def test_a_case_that_was_never_run_is_replaced_and_nothing_else(make_spec, tmp_path):
    write_case(make_spec("conveyor"), tmp_path)
    meshes = {path.name for path in (tmp_path / "meshes").iterdir()}
    (tmp_path / "meshes" / "mine.stl").write_text("mine")
    (tmp_path / "in.script").write_text((tmp_path / "in.script").read_text() + "run 1\n")
    write_case(make_spec("heap"), tmp_path)
    left = {path.name for path in (tmp_path / "meshes").iterdir()}
    assert case_id(load_spec(tmp_path)) == case_id(make_spec("heap"))
    assert left == {"plate.stl", "mine.stl"}
    assert meshes - left


def test_a_changed_record_is_refused(make_spec, tmp_path):
    write_case(make_spec(), tmp_path)
    path = tmp_path / "case.json"
    path.write_text(path.read_text().replace('"mu_pp": 0.694', '"mu_pp": 0.7'))
    with pytest.raises(CaseError, match="do not match the case id"):
        load_spec(tmp_path)
    path.write_text(path.read_text()[:100])
    with pytest.raises(CaseError, match="not a case record"):
        load_spec(tmp_path)
    path.unlink()
    with pytest.raises(CaseError, match="bulkcal generate"):
        load_spec(tmp_path)


def test_a_case_of_an_earlier_version_is_refused_with_a_remedy(make_spec, tmp_path):
    """Cases once held the name of the particle, whose numbers stood in the program."""
    write_case(make_spec(), tmp_path)
    record = json.loads((tmp_path / "case.json").read_text())
    record["inputs"]["spec"]["particle"] = "Carbo HSP13"
    record["case_id"] = identity_of(record["inputs"])
    (tmp_path / "case.json").write_text(json.dumps(record))
    with pytest.raises(CaseError, match=r"written by another version.*generate the case again"):
        load_spec(tmp_path)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"experiment": "heep"}, "unknown experiment 'heep'; did you mean 'heap'"),
        ({"surface": "steal"}, "unknown surface 'steal'; did you mean 'steel'"),
        ({"scale": "qick"}, "unknown scale 'qick'; did you mean 'quick'"),
        ({"engine": "minidm"}, "unknown engine 'minidm'; did you mean 'minidem'"),
        ({"apparatus": {"pour_grain": 5}}, "'pour_grain'; did you mean 'pour_grains'"),
        ({"parameters": {"mu_rol_pp": 0.5}}, "'mu_rol_pp'; did you mean 'mu_roll_pp'"),
        ({"parameters": {"mu_pp": 0.5}}, "mu_roll_pp, mu_pw, mu_roll_pw, e_pp, e_pw missing"),
    ],
)
def test_mistakes_name_the_nearest_word(make_spec, changes, message):
    with pytest.raises(CaseError, match=message):
        case_id(make_spec(**changes))


@pytest.mark.parametrize(("name", "value"), [("e_pp", 0.05), ("e_pw", 1.2), ("mu_pp", -0.1)])
def test_values_that_liggghts_refuses_are_refused_before(make_spec, name, value):
    parameters = {**make_spec().parameters, name: value}
    with pytest.raises(CaseError, match=name):
        case_id(make_spec(parameters=parameters))


def test_execute_runs_once(small_spec, tmp_path):
    spec = small_spec()
    first = execute(spec, tmp_path)
    assert (first.status, first.reason) == ("ok", "")
    assert 5.0 < first.observables["angle_deg"] < 80.0
    script = first.path / "in.script"
    before = script.stat().st_mtime_ns
    assert execute(spec, tmp_path) == first
    assert script.stat().st_mtime_ns == before
    assert post_case(first.path).observables == first.observables


def test_execute_works_in_worker_processes(small_spec, tmp_path):
    spec = small_spec()
    assert pickle.loads(pickle.dumps(spec)) == spec
    with ProcessPoolExecutor(max_workers=1) as pool:
        there = pool.submit(execute, spec, tmp_path / "there").result()
    here = execute(spec, tmp_path / "here")
    assert there.observables == here.observables  # the same seed gives the same numbers


def test_a_damaged_result_is_run_again(small_spec, tmp_path):
    first = execute(small_spec(), tmp_path)
    path = first.path / "result.json"
    stored = json.loads(path.read_text())
    stored["result"]["observables"]["angle_deg"] = 1.0
    path.write_text(json.dumps(stored))
    with pytest.raises(CaseError, match="does not match its hash"):
        load_result(first.path)
    assert execute(small_spec(), tmp_path).observables == first.observables


def test_a_result_of_another_case_is_refused(small_spec, tmp_path):
    first = execute(small_spec(), tmp_path)
    write_case(small_spec(seed=9), tmp_path / "other")
    (tmp_path / "other" / "result.json").write_text((first.path / "result.json").read_text())
    with pytest.raises(CaseError, match="belongs to another case"):
        load_result(tmp_path / "other")


def test_a_run_that_stops_is_data(small_spec, write_changed, tmp_path):
    write_changed(tmp_path, small_spec(), "fix motion", "fix motoin all nve/spher\nfix m")
    result = run_case(tmp_path)
    assert (result.status, result.failure) == ("failed", "physics")
    assert "nve/spher" in result.reason
    assert result.observables == {}
    assert load_result(tmp_path) == result


def test_an_observable_out_of_reach_is_data(small_spec, tmp_path):
    result = execute(small_spec("conveyor"), tmp_path)
    assert result.status == "failed"
    assert "simulate longer" in result.reason
    assert load_result(result.path) == result


def test_plate_impact_accounts_for_all_mass(small_spec, tmp_path):
    result = execute(small_spec("plate_impact"), tmp_path)
    assert result.status == "ok", result.reason
    total = sum(result.observables.values())
    # What is still in the air at the end is in none of the five; there is little.
    assert 0.9 * 68.73 < total <= 68.73 * (1 + 1e-9)


@pytest.mark.liggghts
def test_liggghts_failure_is_data_with_its_message(small_spec, write_changed, tmp_path):
    write_changed(tmp_path, small_spec(engine="liggghts"), "newton off", "newton on")
    result = run_case(tmp_path)
    assert (result.status, result.failure) == ("failed", "physics")
    assert "ERROR" in result.reason
    assert "ERROR: Pair granular" in result.log_tail
    assert load_result(tmp_path) == result


def test_liggghts_missing_is_said_plainly(small_spec, tmp_path, monkeypatch):
    for module in (execution, liggghts, sources):
        monkeypatch.setattr(module, "find_liggghts", lambda: None)
    write_case(small_spec(engine="liggghts"), tmp_path / "liggghts")
    write_case(small_spec(), tmp_path / "minidem")
    for name in ("liggghts", "minidem"):
        with pytest.raises(CaseError, match="BULKCAL_LIGGGHTS"):
            run_case(tmp_path / name, engine="liggghts")


def test_a_case_keeps_its_apparatus_when_defaults_change(small_spec, tmp_path, monkeypatch):
    result = execute(small_spec(), tmp_path)
    heap = EXPERIMENTS["heap"]
    changed = tuple(
        replace(one, quick=0.8) if one.name == "measured_from" else one for one in heap.parameters
    )
    monkeypatch.setitem(EXPERIMENTS, "heap", replace(heap, parameters=changed))
    assert post_case(result.path).observables == result.observables
    assert case_id(small_spec()) != result.case_id
