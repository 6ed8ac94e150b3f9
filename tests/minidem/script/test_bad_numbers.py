"""Numbers that are none, or too large, are named; nothing is computed with them."""

from __future__ import annotations

import warnings

import pytest

from minidem import ScriptError, run_script
from tests.minidem.laws.law_scripts import Ball, Scene

BALL = (Ball((0.0, 0.0, 0.1)),)
STL = """solid s
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 0.1 0 0
vertex 0 0.1 0
endloop
endfacet
endsolid s
"""
MESH = "fix m all mesh/surface file s.stl type 1"
MOVE = "fix v all move/mesh mesh m"
SERVO = "fix m all mesh/surface/stress/servo file s.stl type 1"
CONTROL = "ctrlPV force com 0 0 0 axis 0 0 1 vel_max 1 target_val 1"


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("fix g all gravity INF vector 0 0 -1", "gravity: expected a number, found 'INF'"),
        ("fix g all gravity nan vector 0 0 -1", "expected a number, found 'nan'"),
        ("fix g all gravity 9.81 vector 0 0 1e999", "expected a number, found '1e999'"),
        ("fix g all gravity 9.81 vector 0 0 1e300", "has no direction"),
        ("fix g all gravity 1e308 vector 0 0 -1e-300", "has no direction"),
        ("fix g all gravity 9.81 vector 0 0 0", "has no direction"),
        ("fix g all gravity 9.81 vector 0 0 -1 5", "unexpected word '5'"),
        ("fix g all gravity 9.81 chute", "too few words"),
        ("fix g all gravity 9.81 vectr 0 0 -1", "did you mean 'vector'"),
        ("fix g all gravity 1_0 vector 0 0 -1", "expected a number, found '1_0'"),
        ("run 1_0", "whole number"),
        ("run 99999999999999999999", "whole number"),
        ("fix a all addforce 0 0 1e999", "expected a number"),
        ("fix a all addforce 0 0 0 region nowhere", "unknown region of fix addforce 'nowhere'"),
        ("fix a all addforce 0 0 0 energy 5", "expected a variable v_NAME"),
        ("fix a all addforce 0 0 0 energy v_x", "Cannot use variable energy with constant"),
        ("fix a all setforce 0 0 0 energy v_x", "unknown fix setforce keyword 'energy'"),
        ("fix a all viscous 0.1 scale 5 2.0", "type 5 is not between 1 and 2"),
        ("fix a all adapt 10 atom diametr v_x", "did you mean 'diameter'"),
        ("fix a all adapt 10 atom diameter 5", "expected a variable v_NAME"),
        ("fix a all adapt -1 atom diameter v_x", "interval -1 is negative"),
        (f"{MESH} scale inf", "mesh/surface: expected a number, found 'inf'"),
        (f"{MESH} rotate axis 0 0 0 angle 5", "illegal magnitude of rotation axis"),
        (f"{MESH} curvature 60", "smallest angle of mesh element 0 is lower"),
        (f"{MESH} curvature 61", "curvature 61 is not above 0 and at most 60 degrees"),
        (f"{MESH}\n{MOVE} wiggle amplitude 1 1 1 period 0", "period must not be zero"),
        (f"{MESH}\n{MOVE} viblin axis 0 0 1 order 1 amplitude 1 phase 0 period 0", "period"),
        (f"{MESH}\n{MOVE} rotate origin 0 0 0 axis 0 0 1e200 period 1", "has no direction"),
        (f"{SERVO} mode off {CONTROL}", "mode 'off' .known: auto."),
        (f"{SERVO} mode auto {CONTROL}", "please define 'ratio'"),
        (f"{SERVO} mode auto ratio x {CONTROL}", "number"),
        (f"{SERVO} com 0 0 0 axis 0 0 1 vel_max 1 target_val 1", "please define 'ctrlPV'"),
        (f"{SERVO} target_val 0", "has to be != 0.0"),
        (f"{SERVO} kp -1 {CONTROL}", "must not be negative"),
        (f"{SERVO} {CONTROL}\n{MOVE} linear 0 0 1", "is moved by its servo"),
        (f"{SERVO} {CONTROL}\nfix_modify m gain 1", "unknown fix_modify keyword 'gain'"),
        ("displace_atoms all rotate 0 0 0 0 0 0 90", "Zero length rotation vector"),
        ("displace_atoms all ramp z 0 1 x 1 1", "both coordinates are 1"),
        ("displace_atoms all random 1 1 1 10", "must be a prime number above 10000"),
        ("displace_atoms all move 1e400 0 0", "expected a number"),
        ("velocity none zero linear", "Could not find group 'none'"),
        ("fix a all momentum 0 angular", "interval 0 is not positive"),
        ("fix a all momentum 10", "give 'linear X Y Z'"),
        ("fix a all momentum 10 linear 1 1 2", "known: 0, 1"),
        ("fix a all lineforce 0 0 0", "has no direction"),
        ("fix a all buoyancy density 1000", "you have to specify 'dim'"),
        ("fix a all buoyancy density 0 dim z", "expected a number above zero"),
        ("fix a all nve/limit ratio 1", "unknown fix nve/limit limit 'ratio'"),
        (f"{MESH} precision 0.01", "precision 0.01 is not between 0 and 0.001"),
        (f"{MESH} min_feature_length 0.1", "min_feature_length is not available"),
        (f"{MESH} region none", "unknown region 'none'"),
        (f"{MESH} element_exclusion_list read a", "a: cannot read element_exclusion_list"),
        (f"{MESH} element_exclusion_list read s.stl", "s.stl: expected a whole number"),
        ("minimize x", "let the particles come to rest"),
        ("clear all", "clear takes no words"),
        ("dimension 2", "after simulation box is defined"),
    ],
)
def test_number_is_named(tmp_path, line, message):
    text = Scene(BALL, floor=False).text(1, 1).replace("fix g all", "fix gg all", 1)
    at = text.index("fix integr")
    (tmp_path / "s.stl").write_text(STL)
    (tmp_path / "in.script").write_text(text[:at] + line + "\n" + text[at:])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(ScriptError, match=message) as caught:
            run_script(tmp_path / "in.script", root=tmp_path)
    assert caught.value.line == 1 + text[:at].count("\n") + line.count("\n")


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("fix a all addforce v_x 0 0", "fix a: there is no variable 'x'"),
        ("fix g all gravity v_x vector 0 0 -1", "fix g: there is no variable 'x'"),
        ("variable d equal -1.0\nfix a all adapt 10 atom diameter v_d", "a diameter of -1 m at"),
        ("variable z equal 0.0\nfix g all gravity 9.81 vector 0 0 v_z", "has no direction"),
        ("variable b equal 1e308\nfix g all gravity v_b vector 0 0 v_b", "no direction"),
    ],
)
def test_variable_without_sense_is_named_when_it_is_used(tmp_path, line, message):
    text = Scene(BALL, floor=False).text(1, 1).replace("fix g all", "fix gg all", 1)
    at = text.index("fix integr")
    (tmp_path / "in.script").write_text(text[:at] + line + "\n" + text[at:])
    with pytest.raises(ScriptError, match=message):
        run_script(tmp_path / "in.script", root=tmp_path)


@pytest.mark.parametrize("word", ["echo_off", "set_timing yes", "dump_rate x", "coarsegraining 2"])
def test_words_that_liggghts_does_not_know_are_unknown(tmp_path, word):
    (tmp_path / "in.script").write_text(f"atom_style granular\n{word}\n")
    with pytest.raises(ScriptError, match=f"unknown command '{word.split()[0]}'"):
        run_script(tmp_path / "in.script", root=tmp_path)
