"""Mistakes in a folder: each told with its file, line, value and remedy, and all at once."""

import os
from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from liggghts_io import CaseError, read_experiment
from liggghts_io.experiments.own.reading import read_definition
from tests.liggghts_io.own.folders import CONTACT, DEFINITION, SCRIPT, make_folder

GOOD = CONTACT + DEFINITION


def told(folder, definition=GOOD, script=SCRIPT):
    """Return what is said about a folder."""
    with pytest.raises(CaseError) as refused:
        read_experiment(make_folder(folder, definition, script))
    return str(refused.value)


def line_of(text, part):
    """Return the line of a text on which a part begins, from 1."""
    return text[: text.index(part)].count("\n") + 1


MISTAKES = [
    ('title = "A', 'titel = "A', "unknown key 'titel'; did you mean 'title'?"),
    ('unit = "m"\n', "", "unit is missing; add unit = ..."),
    ("default = 0.02", "default = 5.0", "the value 5 lies outside its limits, 0.01 to 1"),
    ("default = 0.02", 'default = "0.02"', "default = '0.02'"),
    ("default = 0.02", "quick = 0.02", "give default, or one value for each of quick, lab and"),
    ("limits = [0.01, 1.0]", "limits = [1.0, 0.01]", "the lower one comes first"),
    ('variable = "h"', 'variable = "hh"', "no line 'variable hh equal VALUE'; did you mean 'h'?"),
    ('d32_m = "d"', 'd32 = "d"', "unknown quantity 'd32'; did you mean 'd32_m'?"),
    ('seeds = ["s1", "s2"]', 'seeds = ["s1", "s1"]', "'s1' of the script is given 2 values"),
    ('extract = "time_to"', 'extract = "time_too"', "'time_too': unknown extractor; did you mean"),
    ('column = "z_m"', 'colum = "z_m"', "unknown key 'colum'; did you mean 'column'?"),
    ('file = "level.txt"\ncolumn', 'file = "../level.txt"\ncolumn', "name a file inside"),
    ('file = "level.txt"\ncolumn', 'file = "/etc/passwd"\ncolumn', "name a file inside"),
    ('"0.5 * height_m"', '"0.5 * heigth_m"', "unknown name 'heigth_m'; did you mean 'height_m'?"),
    ('"0.5 * height_m"', '"__import__(1)"', "has no value; write numbers, names"),
    ("levels = [0.01, 0.02]", "levels = [0.02, 0.01]", "levels must rise"),
    ('how = "scale"', 'how = "times"', "how = 'times'"),
    ("step = 0.1", "step = 0.0", "step = 0.0"),
    ("step = 0.1", 'step = 0.1\nsign = "positive"\nlimits = [-1.0, 1.0]', "the limits begin at -1"),
    ('variable = "g"', 'variable = "gg"', "the script takes no such number"),
    ('name = "t_ground_s"', 'name = "t_ground_s"\npart_of = "heigt"', "unknown curve 'heigt'"),
    ('contact = ["mu_pp", "e_pp"]', 'contact = ["mu_pp", "e_pq"]', "no contact parameter; there"),
    ('contact = ["mu_pp", "e_pp"]', 'contact = "mu_pp"', "contact = 'mu_pp': must be a list"),
    ('unit = "mm"', 'unit = "mm"\nlow = 9.0\nhigh = -1.0', "low = 9 is not below high = -1"),
    ('column = "z_m"', 'column = "z_m"\nhigh = -1.0', "low = 0 is not below high = -1"),
    ('name = "weight"', 'name = "height_m"', "'height_m' is a parameter, too"),
    ('name = "fall"', 'name = "Fall"', "'Fall': write at most 40 small letters, digits and _"),
    ('name = "weight"', 'name = "my weight"', "write at most 64 letters, digits and _, a letter"),
    ('whole = false', 'whole = "yes"', "whole = 'yes': must be true or false"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "message"), MISTAKES, ids=[one[1] for one in MISTAKES])
def test_a_mistake_is_told_with_its_line(tmp_path, old, new, message):
    assert GOOD.count(old) >= 1
    found = told(tmp_path / "fall", GOOD.replace(old, new, 1))
    assert message in found
    assert f"{tmp_path / 'fall' / 'experiment.toml'}:" in found


def test_a_mistake_in_the_only_observable_is_told_alone(tmp_path):
    text = GOOD.replace('extract = "time_to"', "").replace('extract = "columns"', 'extract = "c"')
    found = told(tmp_path / "fall", text).splitlines()
    assert len(found) == 2
    assert all("unknown extractor" in one for one in found)  # and not that it gives nothing


def test_a_wrong_word_in_contact_is_told_once(tmp_path):
    found = told(tmp_path / "fall", GOOD.replace('"e_pp"]', '"e_pq"]'))
    assert len(found.splitlines()) == 1
    assert "contact = 'e_pq': no contact parameter" in found


def test_an_unknown_list_of_tables_is_told_at_its_first_one(tmp_path):
    text = GOOD.replace("[[effect]]", "[[effekt]]")
    found = told(tmp_path / "fall", text)
    assert f"toml:{line_of(text, '[[effekt]]')}: unknown key 'effekt'; did you mean" in found


def test_all_mistakes_are_told_at_once(tmp_path):
    text = GOOD.replace("step = 0.1", "step = -0.1").replace("levels = [0.01", "levels = [0.03")
    found = told(tmp_path / "fall", text.replace('title = "A', 'titel = "A')).splitlines()
    assert len(found) == 4  # the missing title too
    assert any(f":{line_of(text, '[[curve]]')}: levels must rise" in one for one in found)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda folder: (folder / "fall.in").unlink(), "one script is needed"),
        (lambda folder: (folder / "in.other").write_text("run 1\n"), "one script is needed"),
        (lambda folder: (folder / "experiment.toml").unlink(), "missing, or not a file"),
        (lambda folder: (folder / "experiment.toml").write_text("name = "), "not a TOML file"),
        (lambda folder: (folder / "fall.in").write_bytes(b"\xff\n"), "fall.in:1: not a text"),
        (lambda folder: (folder / "fall.in").write_bytes(b"\xef\xbb\xbfrun 1"), "byte order mark"),
        (lambda folder: (folder / "experiment.toml").write_text("a" * 2**21), "at most 1000000"),
    ],
)  # fmt: skip
def test_a_folder_that_lacks_something_is_refused(tmp_path, change, message):
    folder = make_folder(tmp_path / "fall")
    change(folder)
    with pytest.raises(CaseError, match=message):
        read_experiment(folder)


def test_the_name_of_a_known_experiment_is_refused(tmp_path):
    assert "is that of a known experiment" in told(tmp_path / "x", GOOD.replace('"fall"', '"heap"'))


MESH = '\n[[mesh]]\nfile = "meshes/a.stl"\n'


def test_a_mesh_that_leads_out_of_the_folder_is_refused(tmp_path):
    (tmp_path / "secret").write_text("solid secret")
    folder = make_folder(tmp_path / "fall", GOOD + MESH)
    (folder / "meshes").mkdir()
    (folder / "meshes" / "a.stl").symlink_to(tmp_path / "secret")
    with pytest.raises(CaseError, match=r"toml:\d+: .*a.stl: leads out of the folder"):
        read_experiment(folder)


def test_a_mesh_that_is_no_file_is_refused_and_does_not_hang(tmp_path):
    folder = make_folder(tmp_path / "fall", GOOD + MESH)
    (folder / "meshes").mkdir()
    os.mkfifo(folder / "meshes" / "a.stl")
    with pytest.raises(CaseError, match="missing, or not a file"):
        read_experiment(folder)


def test_a_mesh_lies_where_the_script_looks_for_it(tmp_path):
    folder = make_folder(tmp_path / "fall", GOOD + MESH.replace("meshes/", ""))
    with pytest.raises(CaseError, match=r"a mesh lies at meshes/NAME\.stl"):
        read_experiment(folder)


@given(st.text(max_size=300))
def test_any_text_is_read_or_refused(text):
    with suppress(CaseError):  # any other exception fails
        read_definition(text, "any.toml")


VALUES = st.recursive(
    st.one_of(st.integers(-5, 5), st.floats(-1, 1), st.booleans(), st.text(max_size=5)).map(repr),
    lambda inner: st.lists(inner, max_size=3).map(lambda items: f"[{', '.join(items)}]"),
    max_leaves=5,
).map(lambda text: text.replace("True", "true").replace("False", "false"))


@given(line=st.sampled_from([line for line in GOOD.splitlines() if "=" in line]), value=VALUES)
def test_any_value_of_any_key_is_read_or_refused(line, value):
    key = line.partition("=")[0]
    with suppress(CaseError):  # any other exception fails
        read_definition(GOOD.replace(line, f"{key}= {value}", 1), "any.toml")
