"""``minidem --check`` names values and files that are not there, and none that the script makes."""

from __future__ import annotations

import pytest

from minidem import ScriptError, check_script, run_script
from minidem.checking import findings_text, is_refused
from tests.minidem.engine.cases import plate, stl_text
from tests.minidem.script.test_acceptance import SCRIPT, after, instead

FRICTION = "fix m4 all property/global coefficientFriction peratomtypepair 1 0.5\n"
MODEL = "pair_style gran model hertz tangential history"
ROLLS = MODEL + " rolling_friction epsd"


def find(folder, text):
    script = folder / "in.s"
    script.write_text(text)
    return check_script(script, root=folder)


def test_missing_values_are_listed_at_once_where_the_run_begins(tmp_path):
    text = instead(FRICTION, "").replace(MODEL, ROLLS)
    (found,) = find(tmp_path, text)
    assert found.error.line == len(text.splitlines())
    assert is_refused([found])
    said = findings_text("in.s", [found])
    for name in ("coefficientFriction", "coefficientRollingViscousDamping"):
        assert f"'fix ID all property/global {name} peratomtypepair 1 VALUE'" in said
    assert "id you mean" not in said
    with pytest.raises(ScriptError, match="coefficientFriction as requested by tangential_model"):
        run_script(tmp_path / "in.s", root=tmp_path)


def test_missing_value_is_told_once(tmp_path):
    text = instead(FRICTION, "") + "run 4\nrun 10 upto\n"
    assert len(find(tmp_path, text)) == 1


def test_name_that_is_nearly_right_is_told(tmp_path):
    (found,) = find(tmp_path, SCRIPT.replace("youngsModulus", "youngModulus"))
    assert "Did you mean 'youngModulus'?" in found.error.message


def test_missing_value_of_a_wall_is_told(tmp_path):
    walls = "fix w2 all wall/gran model hooke tangential history primitive type 1 zplane 0"
    (found,) = find(tmp_path, after(walls))
    assert "characteristicVelocity as requested by normal_model hooke" in found.error.message
    assert "characteristicVelocity scalar VALUE" in found.error.message


@pytest.mark.parametrize(
    "text",
    [
        'variable e equal ke\nif "${e} > 1" then "pair_style gran model hooke tangential history"',
        'variable e equal ke\nif "${e} > 1" then &\n "fix w2 all wall/gran model hooke tangential '
        'history primitive type 1 zplane 0" &\n else "print few"',
        'variable e equal ke\nif "${e} > 1" then "unfix m4" else "print few"',
    ],
)
def test_models_that_only_the_simulation_decides_on_are_not_judged(tmp_path, text):
    assert not find(tmp_path, after(text))


@pytest.mark.parametrize(
    ("line", "other", "remedy"),
    [
        ("newton off", "newton on", "use 'newton off'"),
        ("atom_style granular", "", "use 'atom_style granular'"),
        ("pair_coeff * *", "", "give 'pair_coeff * *'"),
    ],
)
def test_settings_with_which_no_run_starts_are_told(tmp_path, line, other, remedy):
    (found,) = find(tmp_path, instead(line, other))
    assert remedy in found.error.message


def test_what_follows_from_a_pair_style_that_is_refused_is_not_told(tmp_path):
    found = find(tmp_path, instead(MODEL, MODEL.replace("hertz", "hartz")))
    assert [one.text.split()[0] for one in found] == ["pair_style"]


def test_what_follows_from_a_wall_that_is_refused_is_not_told(tmp_path):
    wall = "fix w2 all wall/gran model hartz mesh n_meshes 1 meshes m"
    found = find(tmp_path, after(f"{wall}\ncompute c all wall/gran/local id"))
    assert [one.text.split()[1] for one in found] == ["w2"]


@pytest.mark.parametrize(
    ("words", "remedy"),
    [
        ("com 0 0 0 ctrlPV force axis 0 0 1 target_val 1", "vel_max"),
        ("com 0 0 0 ctrlPV force vel_max 1 axis 0 0 1 surface_vel v_a 0 0", "not supported"),
    ],
)
def test_a_wall_of_a_mesh_that_is_refused_is_no_fault(tmp_path, words, remedy):
    (tmp_path / "m.stl").write_text(stl_text(plate(half=0.08, cells=2)))
    servo = "fix s all mesh/surface/stress/servo file m.stl type 1 "
    wall = "fix w2 all wall/gran model hertz tangential history mesh n_meshes 1 meshes s"
    (found,) = find(tmp_path, after(f"variable a equal 1\n{servo}{words}\n{wall}"))
    assert remedy in found.error.message


def test_a_compute_of_walls_without_one_is_told(tmp_path):
    (found,) = find(tmp_path, after("compute c all wall/gran/local id"))
    assert "needs a fix wall/gran with meshes" in found.error.message


def test_missing_coefficients_hide_no_missing_value(tmp_path):
    lines = [line for line in SCRIPT.splitlines(keepends=True) if line != "pair_coeff * *\n"]
    (found,) = find(tmp_path, "".join(lines).replace(FRICTION, ""))
    for missing in ("pair_coeff * *", "coefficientFriction"):
        assert missing in found.error.message


FILES = (
    "fix c all mesh/surface file none.stl type 1",
    "variable f file none.txt",
    "variable a atomfile none.txt",
    "region r mesh/tet file none.vtk scale 1 move 0 0 0 rotate 0 0 0",
    "read_data none.data add",
    "include none.s",
)


@pytest.mark.parametrize("line", FILES)
def test_missing_file_is_told_with_what_to_do(tmp_path, line):
    found = find(tmp_path, after(f"dump d all custom 2 d.* id\nlog l.txt\n{line}"))
    assert [one.missing_file for one in found] == [True]
    assert "none." in found[0].error.message
    assert "refused; put the file there or correct its name" in findings_text("in.s", found)


def test_all_missing_files_are_listed(tmp_path):
    # of what comes behind a missing part of the script only files and words are judged
    found = find(tmp_path, after("\n".join([*FILES[:4], FILES[5], FILES[0].replace("c", "k")])))
    assert [one.error.line for one in found] == [25, 26, 27, 28, 29, 30]


@pytest.mark.parametrize(
    "lines",
    [
        "write_restart r.1\nclear\nread_restart r.1",
        "write_data a.data\nread_data a.data add",
        "dump d all mesh/stl 1 m*.stl\nrun 1\nfix c all mesh/surface file m1.stl type 1",
        'print "1" file t.txt\nvariable f file t.txt',
        'variable n string a\nprint "1" file ${n}.txt\nvariable f file ${n}.txt',
        'variable n string a\nprint "x" file ${n}.stl\nfix c all mesh/surface file ${n}.stl type 1',
    ],
)
def test_file_that_the_script_writes_is_not_missing(tmp_path, lines):
    assert not find(tmp_path, after(lines))


def test_file_that_a_shell_line_may_make_is_no_refusal(tmp_path):
    found = find(tmp_path, after(f"shell mv a none.stl\n{FILES[0]}"))
    assert [one.certain for one in found] == [False]
    assert not is_refused(found)
    said = findings_text("in.s", found)
    assert "not there; ends the run unless it is made before the script gets to it" in said


def test_values_in_units_that_are_not_there_are_not_judged(tmp_path):
    found = find(tmp_path, instead("units si", "units real").replace("5e6", "5"))
    assert [one.text for one in found] == ["units real"]


def test_particles_that_no_run_can_have_inserted_are_missed_before_the_first_step(tmp_path):
    found = find(tmp_path, after("delete_atoms group all\nvelocity all zero linear"))
    assert [one.text for one in found] == ["velocity all zero linear"]
