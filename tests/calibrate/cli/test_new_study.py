"""`bulkcal init` writes a study that is refused until its numbers are filled in, and then right."""

from __future__ import annotations

import itertools
import re
import shutil
from pathlib import Path

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from calibrate.cli.files import new_study
from calibrate.errors import CalibrationError, StudyError
from calibrate.study.data import load_data
from calibrate.study.resources import bundled_particles
from calibrate.study.writing.skeleton import FILL_IN, Plan, skeleton_text
from liggghts_io import read_experiment
from liggghts_io.experiments import EXPERIMENTS
from tests.liggghts_io.own.folders import CONTACT, DEFINITION, make_folder

# What may stand in place of each zero.
NUMBERS = {"d32_um": 1000, "density_kg_m3": 2500, "value": 5.0, "se": 0.1, "repeats": 5}


def filled(text: str) -> str:
    """Fill in every number that is marked."""

    def number(found: re.Match[str]) -> str:
        return f"{found[1]} = {NUMBERS.get(found[1], 20.0)}"

    return re.sub(rf"(?m)^(\w+) = 0(?:\.0)?  # {FILL_IN}.*$", number, text)


names = st.lists(
    st.sampled_from(
        ["Sand", "glued", "steel", "glass 16-30", "Ä", "b.c", "b-c", "Песок", "Грунт", "x" * 80]
    ),
    min_size=1, max_size=3, unique=True,
)  # fmt: skip


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(
    materials=names,
    surfaces=names,
    experiments=st.lists(st.sampled_from([*EXPERIMENTS]), min_size=1, max_size=3, unique=True),
)
def test_what_init_writes_is_right_once_it_is_filled_in(
    tmp_path_factory, materials, surfaces, experiments
):
    # On a plate with grains glued to it nothing slides.
    places = {
        (material, surface, experiment)
        for material, surface, experiment in itertools.product(materials, surfaces, experiments)
        if (surface, experiment) != ("glued", "tilting_plate")
    }
    assume({place[2] for place in places} == set(experiments))
    text = skeleton_text(Plan("new study", materials, surfaces, experiments))
    path = tmp_path_factory.mktemp("new") / "study.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(StudyError) as caught:
        load_data(path)
    marked = {n for n, line in enumerate(text.splitlines(), 1) if FILL_IN in line}
    told = {int(re.search(r"toml:(\d+):", one)[1]) for one in caught.value.mistakes}
    assert told <= marked
    path.write_text(filled(text), encoding="utf-8")
    data = load_data(path)
    assert set(data.study.places) == places
    assert FILL_IN not in filled(text).split("\n", 1)[1]


@pytest.mark.parametrize("name", ["a/b", "", " Sand", "a\nb", "x" * 81])
@pytest.mark.parametrize("option", ["--material", "--surface"])
def test_a_name_that_no_study_takes_is_refused(bulkcal, tmp_path: Path, name: str, option: str):
    words = {"--material": "Sand", "--surface": "steel", "--experiment": "heap"} | {option: name}
    out = tmp_path / "new.toml"
    flags = [word for pair in words.items() for word in pair]
    code, _, err = bulkcal("init", *flags, "--out", str(out))
    assert code == 2
    assert f"{option.strip('-')} {name!r}: " in err
    assert not out.exists()


def test_check_names_all_that_is_to_be_filled_in_at_once(bulkcal, tmp_path: Path):
    path = tmp_path / "new.toml"
    flags = ["--material", "Grit", "--surface", "steel", "--experiment", "heap"]
    assert bulkcal("init", *flags, "--experiment", "conveyor", "--out", str(path))[0] == 0
    code, _, err = bulkcal("check", str(path))
    assert code == 2
    for name in ("d32_um", "density_kg_m3", "flow_flat_g_s"):
        assert f"material 'Grit': {name} = 0.0" in err
    for name in ("angle_steel", "t100_steel"):
        assert f"{name!r} is still to be filled in: its value and se are 0" in err


def test_init_from_flags_with_a_table_of_particles(bulkcal, tmp_path: Path):
    shutil.copy(bundled_particles(), tmp_path)
    path = tmp_path / "new.toml"
    words = ["--material", "SG10H", "--surface", "glued", "--surface", "steel", "--out", str(path)]
    code, out, err = bulkcal("init", *words, "--experiment", "heap", "--experiment", "conveyor")
    assert code == 0, err
    assert "fill in the numbers marked FILL IN" in out
    assert f"next: bulkcal check {path}" in out
    assert "d32_um" not in path.read_text()
    code, _, err = bulkcal("check", str(path))
    assert code == 2
    assert f"{path}:" in err
    path.write_text(filled(path.read_text()))
    study = load_data(path).study
    assert study.materials[0].d32_um == 1201.0
    assert [stage.free for stage in study.stages] == [
        ["mu_pp", "mu_roll_pp"],
        ["mu_pw", "mu_roll_pw"],
    ]


def test_init_asks_in_a_terminal_and_says_the_option_elsewhere(
    bulkcal, tmp_path: Path, monkeypatch
):
    path = tmp_path / "asked.toml"
    code, _, err = bulkcal("init", "--out", str(path))
    assert code == 2
    assert "--material: is missing; name the materials, for example --material Sand" in err
    monkeypatch.setattr("sys.stdin.isatty", lambda: True, raising=False)
    answers = iter(["Sand, Gravel", "steel", "heap"])
    monkeypatch.setattr(new_study.typer, "prompt", lambda *_words, **_more: next(answers))
    code, _, err = bulkcal("init", "--out", str(path))
    assert code == 0, err
    path.write_text(filled(path.read_text()))
    assert [one.name for one in load_data(path).study.materials] == ["Sand", "Gravel"]


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["--experiment", "heep"], "--experiment: unknown name 'heep'; did you mean 'heap'?"),
        (
            ["--experiment", "heap", "--experiment", "heap"],
            "experiments: heap, heap; name each once",
        ),
        (["--experiment", "heap", "--out", "nowhere/new.toml"], "nowhere: no such directory"),
        (["--experiment", "heap", "--out", "."], "'.': is no name of a file"),
        (["--experiment", "heap", "--scale", "huge"], "--scale: unknown name 'huge'"),
    ],
)
def test_what_init_refuses(bulkcal, tmp_path: Path, monkeypatch, words, expected: str):
    monkeypatch.chdir(tmp_path)
    code, _, err = bulkcal("init", "--material", "Sand", "--surface", "steel", *words)
    assert code == 2
    assert expected in " ".join(err.split())
    assert list(tmp_path.iterdir()) == []


def test_init_writes_over_nothing(bulkcal, tmp_path: Path):
    path = tmp_path / "mine.toml"
    path.write_text("mine")
    words = ["--material", "Sand", "--surface", "steel", "--experiment", "heap", "--out", str(path)]
    code, _, err = bulkcal("init", *words)
    assert code == 2
    assert "exists already" in err
    assert path.read_text() == "mine"
    with pytest.raises(CalibrationError, match="materials: none; name each once"):
        Plan("x", [], ["steel"], ["heap"])
    with pytest.raises(CalibrationError, match="no contact parameter acts on glued; name a flat"):
        Plan("x", ["Sand"], ["glued"], ["heap", "tilting_plate"])


def test_an_experiment_of_ones_own_is_written_with_its_folder(bulkcal, tmp_path):
    more = """
[[observable]]
name = "t_landed_s"
unit = "s"
meaning = "time until the grain has landed"
extract = "time_to"
file = "level.txt"
column = "z_m"
reaches = 0.0

[[observable]]
name = "t_landed_x"
unit = "-"
meaning = "a name that differs in its end only"
extract = "last"
file = "level.txt"
column = "z_m"
"""
    folder = make_folder(tmp_path / "rigs" / "fall", CONTACT + DEFINITION + more)
    out = tmp_path / "new.toml"
    words = ["--material", "Sand", "--surface", "steel", "--experiment", str(folder)]
    assert bulkcal("init", *words, "--out", str(out))[0] == 0
    out.write_text(filled(out.read_text()))
    study = load_data(out).study
    assert study.own["fall"] == read_experiment(folder)
    assert [one.name for one in study.targets] == [
        "t_ground_steel", "t_landed_s_steel", "t_landed_x_steel",
    ]  # fmt: skip
    assert sorted(study.parameters) == ["e_pp", "mu_pp"]  # those that act
    assert "# Its curve 'height' (height of the grain) is a target with file" in out.read_text()


def test_a_folder_that_the_study_could_not_read_is_refused(bulkcal, tmp_path):
    folder = make_folder(tmp_path / "fall")
    (tmp_path / "studies").mkdir()
    words = ["--material", "Sand", "--surface", "steel", "--experiment", str(folder)]
    code, _, err = bulkcal("init", *words, "--out", str(tmp_path / "studies" / "new.toml"))
    assert (code, "lies outside the study's directory; copy it to" in err) == (2, True)
    assert not list((tmp_path / "studies").iterdir())
