"""Variables that a run would ask for in some step are missed before the first one."""

from __future__ import annotations

import pytest

from minidem import run_script
from minidem.checking import check_script
from minidem.errors import ScriptError
from tests.minidem.engine.cases import plate, stl_text
from tests.minidem.script.test_acceptance import SCRIPT

MESH = "fix cad all mesh/surface file m.stl type 1"
USES = {
    "fix a all addforce v_nope 0 0": "fix a",
    "fix a all setforce NULL v_nope 0": "fix a",
    "fix a all addforce v_there 0 0 energy v_nope": "fix a",
    "fix a all aveforce v_nope NULL NULL": "fix a",
    "fix a all gravity v_nope vector 0 0 -1": "fix a",
    "fix a all adapt 1 atom diameter v_nope": "fix a",
    "fix a all deform 1 x variable v_nope v_there": "fix a",
    f"{MESH.replace('cad', 'b')} surface_vel v_nope 0 0": "fix b",
    "fix b all mesh/surface/stress/servo file m.stl type 1 com 0 0 0 ctrlPV force axis 0 0 1 "
    "vel_max 1 kp 1 target_val v_nope": "fix b",
    "dump a all xyz 10 a.xyz\ndump_modify a every v_nope": "dump a",
    "thermo v_nope": "thermo",
    "restart v_nope r.*": "restart",
    "restart v_nope a b": "restart",
}
"""Line, and who asks in a run; LIGGGHTS 3.8.0 refuses them all, some of them at the line itself."""
AT_ONCE = {
    "fix a all ave/time 1 1 10 v_there v_nope": "fix ave/time",
    "fix a all ave/atom 1 1 10 vx v_nope": "fix ave/atom",
    "fix a all ave/spatial 1 1 10 z lower 0.1 v_nope": "fix ave/spatial",
    "fix a all ave/histo 1 1 10 0 1 10 v_nope": "fix ave/histo",
    "fix a all ave/correlate 1 10 10 v_nope": "fix ave/correlate",
    "fix a all store/state 0 v_nope": "fix store/state",
    "fix a all move/mesh mesh cad linear/variable v_there v_nope v_there": (
        "fix move/mesh linear/variable"
    ),
    "fix a all move/mesh mesh cad rotate/variable origin 0 0 0 axis 0 0 1 omega v_nope": (
        "fix move/mesh rotate/variable"
    ),
    "compute a all reduce sum v_nope": "compute reduce",
    "dump a all custom 10 a.dump id v_nope": "dump a",
    "thermo_style custom step v_nope": "thermo_style custom",
}
"""Line, and who asks at once, as in LIGGGHTS."""


def script(folder, lines: str, run: str = "run 3\n"):
    """Write a script with some lines before its run."""
    (folder / "m.stl").write_text(stl_text(plate(0.02, 0.01)))
    path = folder / "in.script"
    path.write_text(SCRIPT.replace("run 3\n", f"variable there equal 1.\n{MESH}\n{lines}\n{run}"))
    return path


@pytest.mark.parametrize("line", USES)
def test_the_user_of_a_variable_is_named_before_the_first_step(tmp_path, line):
    path = script(tmp_path, line, "variable nap equal 1.\nrun 3\nrun 5\n")
    at = len(path.read_text().splitlines()) - 1
    with pytest.raises(ScriptError) as caught:
        run_script(path, root=tmp_path)
    wanted = f"in.script:{at}: {USES[line]}: there is no variable 'nope'"
    assert wanted in str(caught.value)
    assert not list(tmp_path.glob("*dump")), "steps were made"
    (found,) = check_script(path, root=tmp_path)
    assert wanted in str(found.error)


@pytest.mark.parametrize("line", USES)
def test_a_variable_may_be_defined_after_its_use(tmp_path, line):
    kind = "atom" if "adapt" in line else "equal"
    value = "step+10" if USES[line] in ("thermo", "restart") or "every" in line else "0.004"
    path = script(tmp_path, line, f"variable nope {kind} {value}\nrun 3\n")
    assert not check_script(path, root=tmp_path)


@pytest.mark.parametrize("line", AT_ONCE)
def test_a_variable_is_defined_before_those_who_look_for_it_at_once(tmp_path, line):
    per_atom = any(word in line for word in ("/atom", "spatial", "state", "reduce", "custom 10"))
    later = f"variable nope {'atom' if per_atom else 'equal'} 0.004\n"
    path = script(tmp_path, line, later + "run 3\n")
    at = path.read_text().splitlines().index(line) + 1
    (found,) = check_script(path, root=tmp_path)
    wanted = f"in.script:{at}: {AT_ONCE[line]}: there is no variable 'nope'; define it before"
    assert wanted in str(found.error)
    assert not check_script(script(tmp_path, later + line), root=tmp_path)


@pytest.mark.parametrize("line", [line for line in AT_ONCE if "histo" not in line])
def test_a_variable_has_the_style_that_is_needed(tmp_path, line):
    (found,) = check_script(script(tmp_path, "variable nope string 1\n" + line), root=tmp_path)
    assert "variable 'nope' is of style string; expected" in str(found.error)


@pytest.mark.parametrize(
    "line",
    [
        "fix a all ave/time 1 1 10 c_k", "thermo_style custom step c_k",
        "compute r all reduce max c_k", "fix a all ave/correlate 1 10 10 f_k",
        "thermo_style custom step f_k[1]", "dump a all custom 10 a.dump id c_k",
        "fix a all store/state 0 c_k",
    ],
)  # fmt: skip
def test_computes_and_fixes_are_defined_before_those_who_look_for_them(tmp_path, line):
    compute = "ke/atom" if "reduce" in line or "dump" in line or "store" in line else "ke"
    made = f"compute k all {compute}"
    if "f_k" in line:
        made = "fix k all ave/time 1 1 10 c_thermo_temp"
    (found, *_) = check_script(script(tmp_path, line, made + "\nrun 3\n"), root=tmp_path)
    assert "'k'; define it before this line" in str(found.error)


def test_a_variable_of_a_branch_that_may_be_taken_is_not_missed(tmp_path):
    lines = 'if "$(ke) > 1" then "variable nope equal 1"\nfix a all ave/time 1 1 10 v_nope'
    assert not check_script(script(tmp_path, lines), root=tmp_path)


def test_a_variable_whose_own_line_is_wrong_is_told_once(tmp_path):
    lines = "variable nope file missing.txt\nthermo_style custom step v_nope"
    (found,) = check_script(script(tmp_path, lines), root=tmp_path)
    assert "missing.txt" in str(found.error)


def test_a_name_that_is_nearly_right_is_proposed(tmp_path):
    path = script(tmp_path, "thermo_style custom step v_ther")
    with pytest.raises(ScriptError, match=r"no variable 'ther'; did you mean 'there'\?"):
        run_script(path, root=tmp_path)
