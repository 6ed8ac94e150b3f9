"""Words of LIGGGHTS' manual that few scripts have, with the numbers that it prints for them."""

from __future__ import annotations

import pytest

from minidem import run_script
from tests.minidem.output import scenes

HEAD = scenes.HEAD.replace("boundary f f m", "boundary f f f")
LINES = """change_box all ortho
compute l all pair/gran/local id delta
compute far all reduce max c_l[1] c_l[4] replace 1 2
compute v all property/atom vx vz
compute k all ke/atom
compute half all ke halfstep
fix s all store/state 0 x y
fix mean all ave/atom 1 5 10 vz
variable twice atom 2*x
variable a equal c_k[3]
variable b equal c_v[4][2]
variable c equal f_s[6][2]
variable d equal v_twice[5]
variable e equal f_mean[2]
variable f equal c_k[99]
fix above all wall/gran model hertz tangential history primitive type 1 zplane -0.06 &
 contact_area constant 1e-6
fix p all print 50 "${a} ${b} ${c} ${d} ${e} ${f}" file values.txt screen no title none
fix q all ave/time 50 1 50 c_far[1] c_far[2] c_half file far.txt
fix t all ave/spatial 10 2 20 x -0.1 0.02 z -0.1 0.02 vz density/mass units box &
 std 1 2 once.txt
fix u all ave/spatial 10 2 20 x -0.1 0.03 vz units box ave running std 2 100 running.txt
dump d all custom 100 d.%.txt id x
dump_modify d nfile 1
run 200
write_dump all custom w.%.txt id modify sort id
"""
LAST = {
    "values.txt": "0.000899564693554 1.87439276065306 0.02 0.0596272552990135 1.40055708923607 0",
    "far.txt": "200 1 6.00972e-05 0.00503664",
    "once.txt": "200 7 336 2 331 0 0 5 1.4 1.16392 0.995925 0.713002 6.15565 5.50585 1.97943",
    "running.txt": "200 70 15 30 12 0 0 3 23.3333 2.45269 0.286057 0.278177",
    "d.0.txt": "7 -0.0180694 ",
    "w.0.txt": "7 ",
}
"""Last line of each file that LIGGGHTS 3.8.0 writes."""


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Return the files that minidem writes."""
    return scenes.run_minidem(tmp_path_factory.mktemp("mine"), scenes.scene(LINES, HEAD))


@pytest.mark.parametrize("name", LAST)
def test_last_lines_are_those_of_liggghts(files, name):
    assert scenes.alike(files[name].splitlines()[-1], LAST[name], rtol=2e-6)  # six digits


@pytest.mark.liggghts
def test_all_files_are_those_of_liggghts(files, tmp_path):
    theirs = scenes.run_liggghts(tmp_path, scenes.scene(LINES, HEAD))
    assert theirs.keys() == LAST.keys()
    assert scenes.different(files, theirs) == []


def test_massflow_goes_on_with_a_file(tmp_path):
    lines = """print "before" file flow.txt
fix f all massflow/mesh mesh cm count once point_at_outlet 0 0 -1 append flow.txt
run 10
"""
    found = scenes.run_minidem(tmp_path, scenes.scene(lines, HEAD))
    assert found["flow.txt"] == "before\n# ID diameter x y z u v w  (ex ey ez, color)\n"


def test_restarts_in_turns_are_named_as_those_of_one_process(tmp_path):
    """LIGGGHTS has a file called base, and one of each process."""
    script = scenes.write(tmp_path, scenes.scene("restart 5 one.% two.%\nrun 10\n", HEAD))
    run_script(script, root=tmp_path)
    assert {path.name for path in tmp_path.iterdir()} >= {"one.base", "two.base"}
