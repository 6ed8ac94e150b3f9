"""A user's own experiment from its folder to its numbers, without the folder."""

import math
import pickle
import shutil
from dataclasses import replace

import numpy as np
import pytest

from liggghts_io import (
    CaseError,
    CaseSpec,
    case_id,
    execute,
    experiment_files,
    experiment_of,
    load_spec,
    post_case,
    read_curve,
    read_experiment,
    render_case,
    run_case,
    write_case,
)
from liggghts_io.case.liggghts import find_liggghts
from liggghts_io.case.spec import script_of
from liggghts_io.effects import effects_in
from liggghts_io.experiments import own_experiment
from tests.liggghts_io.conftest import PARAMETERS, PARTICLES
from tests.liggghts_io.own.folders import SCRIPT, SHIPPED, make_folder

HEIGHT, RADIUS = 0.02, 0.5 * PARTICLES["Carbo HSP13"].d32_m


@pytest.fixture
def own_spec(tmp_path):
    """Make a spec of the falling grain."""

    def make(folder=None, **changes):
        own = read_experiment(folder or make_folder(tmp_path / "fall"))
        grain = PARTICLES["Carbo HSP13"]
        spec = CaseSpec(own.name, grain, "flat", "quick", PARAMETERS, own=own)
        return replace(spec, **changes)

    return make


def fall_time(depth, gravity=9.81):
    return math.sqrt(2.0 * depth / gravity)


def test_a_plain_script_keeps_every_other_byte(own_spec):
    written = script_of(own_spec(apparatus={"height_m": 0.03})).splitlines()
    before = SCRIPT.splitlines()
    changed = [k for k, line in enumerate(before) if written[k] != line]
    assert len(written) == len(before)
    assert {before[k].split()[1] for k in changed} <= {"d", "mu", "e", "h", "s1", "s2"}
    assert written[0] == "variable d  equal 0.001595   # diameter [m]"
    assert written[3] == "variable h  equal 0.03"


@pytest.mark.parametrize("folder", SHIPPED.values(), ids=list(SHIPPED))
def test_its_files_are_the_folder_and_nothing_else_that_lies_there(folder, tmp_path):
    copy = shutil.copytree(folder, tmp_path / "copy")
    (copy / "secret.txt").symlink_to("/etc/hostname")
    own = read_experiment(copy)
    for name, content in experiment_files(own).items():
        (tmp_path / "again" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "again" / name).write_bytes(content)
    assert read_experiment(tmp_path / "again") == own
    assert not (tmp_path / "again" / "secret.txt").exists()


def test_an_own_experiment_is_run_and_measured(own_spec, tmp_path):
    result = execute(own_spec(), tmp_path / "runs")
    assert result.status == "ok", result.reason
    # zmax is that of the centre; the print is linear between steps of 1e-4 s.
    assert result.observables["t_ground_s"] == pytest.approx(fall_time(0.5 * HEIGHT), abs=2e-5)
    height = read_curve(result, experiment_of(own_spec()).curves[0])
    expected = [1e3 * (HEIGHT - 0.5 * 9.81 * t**2) for t in (0.01, 0.02)]
    np.testing.assert_allclose(height, expected, atol=0.01)


def test_an_effect_of_its_own_acts(own_spec, tmp_path):
    light = execute(own_spec(effects={"weight": -0.5}), tmp_path / "runs")
    expected = fall_time(0.5 * HEIGHT, 0.5 * 9.81)
    assert light.observables["t_ground_s"] == pytest.approx(expected, abs=2e-5)
    assert set(effects_in(experiment_of(own_spec()))) == {"weight"}
    with pytest.raises(CaseError, match="cohesion_J_m3 = 1 cannot act in the experiment fall"):
        case_id(own_spec(effects={"cohesion_J_m3": 1.0}))
    with pytest.raises(CaseError, match="effect weight: strength 9 - outside -1 to 1"):
        case_id(own_spec(effects={"weight": 9.0}))


def test_a_case_needs_its_folder_no_more(own_spec, tmp_path):
    folder = make_folder(tmp_path / "fall")
    spec = own_spec(folder)
    case = write_case(spec, tmp_path / "case")
    shutil.rmtree(folder)
    first = run_case(case)
    assert load_spec(case).own == spec.own
    assert post_case(case).observables == first.observables
    assert run_case(case, again=True).observables == first.observables
    assert render_case(case).stat().st_size > 1000
    assert case_id(load_spec(case)) == first.case_id


def test_the_id_covers_definition_script_and_meshes(own_spec, tmp_path):
    spec = own_spec()
    own = spec.own
    others = [
        replace(own, definition=own.definition.replace("0.5 * height_m", "0.4 * height_m")),
        replace(own, script=own.script.replace("1e-5", "2e-5")),
        replace(own, meshes=(("a.stl", b"solid a"),)),
    ]
    ids = {case_id(replace(spec, own=one)) for one in (own, *others)}
    assert len(ids) == 4
    assert pickle.loads(pickle.dumps(own)) == own
    assert len(repr(replace(own, meshes=(("a.stl", b"x" * 10_000),)))) < 200


def test_another_name_than_that_of_the_folder_is_refused(own_spec):
    with pytest.raises(CaseError, match="the own experiment is named 'fall'"):
        case_id(own_spec(experiment="heap"))


def test_a_glued_wall_gets_the_friction_of_grains_glued_on(own_spec):
    folder = SHIPPED["hopper"]
    text = script_of(own_spec(folder, surface="glued"))
    assert "fric_pw  equal 1000\n" in text.replace(" # ", "\n")
    assert f"rest_pw  equal {PARAMETERS['e_pp']:g}" in text


@pytest.mark.parametrize("name", sorted(SHIPPED))
def test_a_shipped_folder_says_what_it_gives(name):
    one = own_experiment(read_experiment(SHIPPED[name]))
    assert one.name == name
    assert one.acting("glued")
    assert {p.name for p in one.parameters}
    for observable in one.observables:
        assert observable.part_of in ("", *(curve.name for curve in one.curves))


NEAR = {"t_half_s": 0.02, "left_over": 3.0, "bed_mm": 1.0, "level_mm": 0.5}
"""What two seeds of one engine may differ by."""


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(SHIPPED))
def test_a_shipped_folder_runs_on_both_engines_alike(own_spec, tmp_path, name):
    spec = own_spec(SHIPPED[name])
    mini = execute(spec, tmp_path / "runs")
    assert mini.status == "ok", mini.reason
    assert set(mini.observables) == {one.name for one in experiment_of(spec).observables}
    if find_liggghts() is None:
        pytest.skip("LIGGGHTS is not installed")
    ligg = execute(replace(spec, engine="liggghts"), tmp_path / "runs")
    assert ligg.status == "ok", ligg.reason
    for one, value in mini.observables.items():
        assert ligg.observables[one] == pytest.approx(value, abs=NEAR[one]), one
