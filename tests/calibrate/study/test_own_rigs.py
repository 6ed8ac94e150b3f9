"""A study with experiments of its own: what is read, what is refused, and where its names count."""

from __future__ import annotations

import pickle
from pathlib import Path

import pytest

from calibrate.errors import StudyError
from calibrate.questions.core.from_study import forms_of
from calibrate.runs.cost import cost_of
from calibrate.study.cases import case_spec, middle
from calibrate.study.data import StudyData, load_data
from calibrate.study.places import Layout, Place
from liggghts_io import case_id, execute, read_curve, read_experiment
from liggghts_io.experiments import EXPERIMENTS
from liggghts_io.experiments.own.experiment import own_experiment
from tests.calibrate.study.conftest import GOOD
from tests.calibrate.study.rigs import CURVE, STUDY, write_rig
from tests.liggghts_io.own.folders import CONTACT, DEFINITION, make_folder
from tests.liggghts_io.own.test_left_out import DEFINITION as PAIR
from tests.liggghts_io.own.test_left_out import TEMPLATE as BALLS
from tests.paths import ROOT

PAIRS, WALLS = '["mu_pp", "e_pp"]', '["mu_pp", "e_pp", "e_pw"]'
"""Contacts of an experiment without a wall under test, and with one."""
HERE = Place("glass", "steel", "fall")


def mistakes_of(path: Path) -> list[str]:
    with pytest.raises(StudyError) as caught:
        load_data(path)
    return [one.removeprefix(str(path)) for one in caught.value.mistakes]


def line_of(text: str, word: str) -> int:
    return text[: text.index(word)].count("\n") + 1


def spec_of(data: StudyData, **values: float):
    named = {(name, data.study.instances(name)[0]): one for name, one in values.items()}
    return case_spec(data.study, HERE, {**middle(data.study), **named}, 3)


def test_a_case_holds_the_experiment_of_the_folder(tmp_path: Path) -> None:
    data = load_data(write_rig(tmp_path))
    assert set(data.study.experiments) == {*EXPERIMENTS, "fall"}
    spec = spec_of(data, height_m=0.02)
    assert spec.own is not None
    assert spec.own == pickle.loads(pickle.dumps(spec)).own
    assert set(spec.parameters) == {"mu_pp", "e_pp"}  # those that act, as the folder says
    assert spec.apparatus == {"height_m": 0.02}
    (tmp_path / "rig" / "fall.in").unlink()
    result = execute(spec, tmp_path / "runs")
    # A fall over half the height of 20 mm.
    assert result.observables["t_ground_s"] == pytest.approx((2 * 0.01 / 9.81) ** 0.5, rel=1e-2)


@pytest.mark.parametrize(("contact", "acts"), [(PAIRS, False), (WALLS, True)])
def test_without_a_wall_no_effect_of_walls_is_tried(
    tmp_path: Path, contact: str, acts: bool
) -> None:
    text = PAIR.replace(PAIRS, contact)
    own = read_experiment(make_folder(tmp_path / "pair", text, BALLS, "script.in.j2"))
    here = Place("glass", "steel", "pair")
    experiments = {"pair": own_experiment(own)}
    layout = Layout((here,), {"steel": "flat"}, experiments, {})
    assert layout.acts("wall_adhesion_J_m3", here) is acts
    assert layout.acts("cohesion_J_m3", here)


def test_the_digest_covers_the_folders(tmp_path: Path) -> None:
    path = write_rig(tmp_path)
    before = load_data(path).sha256
    (tmp_path / "rig" / "notes.txt").write_text("not part of the experiment")
    assert load_data(path).sha256 == before
    script = tmp_path / "rig" / "fall.in"
    script.write_text(script.read_text().replace("run 8000", "run 8001"))
    assert load_data(path).sha256 != before


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('folder = "rig"', 'folder = "rigg"', "'rigg' does not exist in {}; did you mean 'rig'?"),
        ('folder = "rig"', 'folder = "../rig"', "'../rig' lies outside the study's directory"),
        ('folder = "rig"', 'folder = "/etc"', "folder = '/etc' lies outside"),
        ('folder = "rig"', 'folder = "link"', "folder = 'link' lies outside"),
        ('folder = "rig"', 'folder = "."', "folder = '.' lies outside"),
        ('folder = "rig"', 'folder = "study.toml"', "folder = 'study.toml' does not exist"),
        ('name = "fall"', 'name = "drop"', "has name = 'fall', and this table says 'drop'"),
    ],
)  # fmt: skip
def test_a_wrong_folder_is_told_once_at_its_line(
    tmp_path: Path, old: str, new: str, expected: str
) -> None:
    home = tmp_path / "study"
    home.mkdir()
    make_folder(tmp_path / "rig")
    (home / "link").symlink_to(tmp_path / "rig")
    path = write_rig(
        home, (old, new), *[('experiment = "fall"', 'experiment = "drop"')] * ("drop" in new)
    )
    (told,) = mistakes_of(path)
    assert told.startswith(f":{line_of(STUDY, 'folder = ')}: ")
    assert expected.format(home) in told


def test_mistakes_of_a_folder_stand_among_those_of_the_study(tmp_path: Path) -> None:
    wrong = CONTACT + DEFINITION.replace('extract = "time_to"', 'extract = "time_too"').replace(
        "limits = [0.01, 1.0]", "limits = [1.0, 0.01]"
    )
    path = write_rig(tmp_path, ("seed = 7", "seed = -7"), definition=wrong)
    told = mistakes_of(path)
    assert len(told) == 3  # and nothing of its parameters and observables, which nobody knows
    assert "run.seed" in told[0]
    where = f":{line_of(STUDY, 'folder = ')}: {tmp_path}/rig/experiment.toml:"
    assert all(one.startswith(where) for one in told[1:])
    assert any("time_to" in one for one in told[1:])


def test_names_of_an_own_experiment_have_nearest_words(tmp_path: Path) -> None:
    path = write_rig(tmp_path, ('"t_ground_s"', '"t_grund_s"'), more="[effects]\nweigth = 0.1\n")
    told = mistakes_of(path)
    assert any(
        "fall: unknown observable 't_grund_s'; did you mean 't_ground_s'?" in o for o in told
    )
    assert any("unknown name 'weigth'; did you mean 'weight'?" in one for one in told)


def test_a_folder_cannot_take_the_name_of_a_known_experiment(tmp_path: Path) -> None:
    path = write_rig(
        tmp_path,
        ('name = "fall"', 'name = "heap"'),
        ('experiment = "fall"', 'experiment = "heap"'),
        definition=CONTACT + DEFINITION.replace('name = "fall"', 'name = "heap"'),
    )  # fmt: skip
    assert any("'heap' is that of a known experiment" in one for one in mistakes_of(path))


def test_an_own_effect_is_switched_on_or_free(tmp_path: Path) -> None:
    on = load_data(write_rig(tmp_path, more="[effects]\nweight = 0.2\n"))
    assert spec_of(on).effects == {"weight": 0.2}
    free = load_data(write_rig(tmp_path, more="[parameter.weight]\nrange = [-0.3, 0.3]\n"))
    (form,) = forms_of(free).values()
    (switch,) = form.switches
    assert (switch.name, switch.step, switch.low, switch.high) == ("weight", 0.1, -0.3, 0.3)
    assert spec_of(free, weight=-0.1).effects == {"weight": -0.1}
    assert [axis.name for axis in form.axes] == ["height_m"]


@pytest.mark.parametrize(
    ("more", "expected"),
    [
        ("[effects]\nplate_tilt_deg = 0.5\n", "plate_tilt_deg acts in "),
        ("[parameter.cohesion_J_m3]\nrange = [0.0, 1.0]\n", "'cohesion_J_m3' matters in no"),
        ("[effects]\nweight = 7.0\n", "effect weight: strength 7 - outside -1 to 1"),
        ("[parameter.mu_pw]\nrange = [0.1, 0.8]\n", "'mu_pw' matters in no experiment"),
    ],
)  # fmt: skip
def test_what_cannot_act_in_an_own_experiment_is_refused(
    tmp_path: Path, more: str, expected: str
) -> None:
    (told,) = mistakes_of(write_rig(tmp_path, more=more))
    assert expected in told


def test_two_folders_may_not_share_an_effect(tmp_path: Path) -> None:
    other = CONTACT + DEFINITION.replace('name = "fall"', 'name = "drop"')
    make_folder(tmp_path / "second", other)
    more = '[[experiment]]\nname = "drop"\nfolder = "second"\n'
    told = mistakes_of(write_rig(tmp_path, more=more))
    assert any("effect 'weight' stands in fall and in drop" in one for one in told)


def test_an_own_curve_is_a_target(tmp_path: Path) -> None:
    rows = "time_s,height_mm,sem_mm\n0.005,19.9,0.1\n0.015,18.9,0.1\n0.03,15.6,0.1\n"
    (tmp_path / "path.csv").write_text(rows)
    data = load_data(write_rig(tmp_path, more=CURVE))
    target = data.study.target_named("path")
    assert (target.simulated_unit, target.model_scale) == ("mm", "linear")
    assert list(data.curves["path"].levels) == [0.01, 0.02]  # the folder's own
    assert list(data.curves["path"].values) == pytest.approx([19.4, 17.8])
    spec = spec_of(data, height_m=0.02)
    curve = data.study.experiments["fall"].curves[0]
    at = read_curve(execute(spec, tmp_path / "runs"), curve)
    assert at == pytest.approx([20.0 - 500.0 * 9.81 * t**2 for t in curve.levels], abs=0.05)


@pytest.mark.parametrize(
    ("experiment", "observable", "x", "y", "unit", "scale"),
    [
        ("heap", "flank", "distance", "height", "-", "linear"),
        ("plate_impact", "landing", "r_mm", "mass_g", "g", "linear"),
        ("conveyor", "mass_time", "level_g", "time_s", "s", "log"),
    ],
)
def test_every_curve_of_the_program_is_a_target(
    folder: Path, experiment: str, observable: str, x: str, y: str, unit: str, scale: str
) -> None:
    curve = EXPERIMENTS[experiment].curve_named(observable)
    levels = [*curve.levels, 2.0 * curve.levels[-1] - curve.levels[-2]]
    rows = "".join(f"{one},{0.5 + k},0.1\n" for k, one in enumerate(levels))
    (folder / "curve.csv").write_text(f"{x},{y},error\n{rows}")
    path = folder / "study.toml"
    more = f"""
[[target]]
name = "curve"
surface = "glued"
experiment = "{experiment}"
observable = "{observable}"
file = "curve.csv"
x_column = "{x}"
column = "{y}"
se_column = "error"
"""
    if experiment == "plate_impact":
        more = more.replace('"glued"', '"steel"') + '[[surface]]\nname = "steel"\n'
        more += "".join(f"[parameter.{one}_pw]\nvalue = 0.3\n" for one in ("mu", "mu_roll", "e"))
    path.write_text(GOOD + more, encoding="utf-8")
    data = load_data(path)
    target = data.study.target_named("curve")
    assert (target.simulated_unit, target.model_scale) == (unit, scale)
    assert tuple(data.curves["curve"].levels) == curve.levels
    assert data.curves["curve"].values[0] == pytest.approx(0.5)


def test_flat_walls_share_their_cases(tmp_path: Path) -> None:
    ids = [
        case_id(case_spec(study, Place("glass", wall, "fall"), middle(study), 3))
        for wall in ("steel", "alumina", "teflon")
        for study in [load_data(write_rig(tmp_path, ('name = "steel"', f'name = "{wall}"'))).study]
    ]
    assert len(set(ids)) == 1


@pytest.mark.parametrize("name", ["drum", "drawdown", "plain_script"])
def test_the_shipped_examples_are_studies(name: str) -> None:
    data = load_data(ROOT / "cases" / name / "study.toml")
    ((experiment, kind),) = forms_of(data)
    assert experiment in (EXPERIMENTS if name in EXPERIMENTS else data.study.own)
    assert kind == "flat"
    assert all(one.repeats == 5 for one in (*data.scalars.values(), *data.curves.values()))


def test_an_own_experiment_has_a_cost(tmp_path: Path) -> None:
    cost = cost_of(load_data(write_rig(tmp_path)).study, 2)
    assert cost.failed == ()
    assert cost.places[0].steps == 8000
    assert cost.wall_s > 0.0
