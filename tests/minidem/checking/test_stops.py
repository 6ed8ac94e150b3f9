"""Where LIGGGHTS 3.8.0 stops: what is refused with the same meaning, and what is warned of."""

from __future__ import annotations

import struct

import pytest

from minidem import run_script
from minidem.errors import ScriptError
from tests.minidem.engine.cases import plate, stl_text
from tests.minidem.script.test_acceptance import SCRIPT

MAP = "atom_modify map array sort 0 0\n"
MESH = "fix cad all mesh/surface/planar file m.stl type 1 move 0.05 0.05 0\n"
COUNTER = MESH + "fix mf all massflow/mesh mesh cad count once vec_side 0 0 -1 delete_atoms yes\n"


def script(folder, lines: str, *, ids: str = MAP):
    """Write a script with some lines before its run."""
    (folder / "m.stl").write_text(stl_text(plate(0.02, 0.01)))
    path = folder / "in.script"
    path.write_text(SCRIPT.replace("run 3\n", lines + "run 3\n").replace(MAP, ids))
    return path


REFUSED = {
    "compute r all reduce sum radius": "give 'compute ID GROUP property/atom radius' and its c_ID",
    "compute r all reduce sum z raduis": "unknown compute reduce input 'raduis'",
    "compute r all property/atom id density": "unknown particle property 'density'",
    "compute r all property/atom c_thermo_temp": "'c_thermo_temp' is no property of particles",
    "fix r all ave/atom 1 1 1 radius": "unknown fix ave/atom input 'radius'",
    "fix r all store/state 0 xsu": "unknown input 'xsu'; did you mean",
    "dump r all custom 1 r.txt id r": "unknown dump column 'r'",
    "dump r all custom 1 r.txt id\ndump_modify r fileper 2": "fileper without % in dump file name",
    "dump r all mesh/stl 1 r*.stl\ndump_modify r nfile 2": "nfile without % in dump file name",
    "dump r all custom 1 r.txt id\ndump_modify r flush maybe": "unknown dump_modify value 'maybe'",
    'print "$(elapsed)"': "'elapsed' has a value only during a run",
    'variable c equal cpu\nprint "${c}"': "variable c: 'cpu' has a value only during a run",
    "atom_modify map array": "atom_modify map command after simulation box is defined",
    "atom_modify map yes": "unknown atom_modify map 'yes'",
    "fix r all ave/time 1 1 10 c_thermo_temp c_p mode vector": (
        "cannot set output array intensive/extensive from these inputs"
    ),
}


@pytest.mark.parametrize("line", REFUSED)
def test_a_word_that_liggghts_lacks_is_refused(tmp_path, line):
    before = "compute p all pressure thermo_temp\n"
    with pytest.raises(ScriptError) as error:
        run_script(script(tmp_path, before + line + "\n"), root=tmp_path)
    assert REFUSED[line] in str(error.value)


def test_words_of_a_run_have_values_in_it_and_between_its_parts(tmp_path):
    lines = "variable e equal elaplong\nthermo_style custom step v_e cpu\n"
    lines += "run 4 every 2 \"print '$(elapsed) $e $(step)' append e.txt\"\n"
    run_script(script(tmp_path, lines), root=tmp_path)
    # as LIGGGHTS 3.8.0 prints them: of every part of the run
    assert (tmp_path / "e.txt").read_text().splitlines() == ["2 2 2", "2 2 4"]


NEEDS_MAP = {
    'print "$(x[1])"\n': "to find particles by their ids LIGGGHTS needs an atom map",
    "variable q equal vx[1]\nthermo_style custom step v_q\n": "variable q: to find particles",
    COUNTER: "Fix massflow/mesh (id mf): 'delete_atoms yes' requires an atom map of type 'array'",
}


@pytest.mark.parametrize("lines", NEEDS_MAP)
def test_ids_are_looked_up_with_an_atom_map_only(tmp_path, lines):
    with pytest.raises(ScriptError) as error:
        run_script(script(tmp_path, lines, ids=""), root=tmp_path)
    assert NEEDS_MAP[lines] in str(error.value)
    run_script(script(tmp_path, lines), root=tmp_path)
    hashed = script(tmp_path, lines, ids="atom_modify map hash\n")
    if lines == COUNTER:
        with pytest.raises(ScriptError, match="type 'array'"):
            run_script(hashed, root=tmp_path)
    else:
        run_script(hashed, root=tmp_path)


def log(folder, lines: str, **more: str) -> str:
    """Return the log of a script with some lines before its run."""
    run_script(script(folder, lines, **more), root=folder)
    return (folder / "log.liggghts").read_text()


def binary_stl(name: bytes) -> bytes:
    """Return a binary file of two triangles."""
    found = name.ljust(80, b" ") + struct.pack("<I", 2)
    for triangle in plate(0.02, 0.01):
        found += struct.pack("<12fH", 0, 0, 1, *(c for point in triangle for c in point), 0)
    return found


CAPITALS = stl_text(plate(0.02, 0.01)).replace("vertex", "VERTEX").encode()
FILES = {
    "which is binary and begins with 'solid'": binary_stl(b"solid of a program"),
    "which has 'VERTEX' in capitals": CAPITALS,
    "": binary_stl(b"made by a program"),
}


@pytest.mark.parametrize("why", FILES)
def test_a_mesh_that_liggghts_cannot_read_is_told(tmp_path, why):
    (tmp_path / "odd.stl").write_bytes(FILES[why])
    found = log(tmp_path, MESH.replace("m.stl", "odd.stl"))
    assert ("LIGGGHTS stops at its file" in found) == bool(why)
    assert why in found


def test_lists_that_are_empty_in_liggghts_are_told(tmp_path):
    assert "in LIGGGHTS-PUBLIC this finds no neighbours" in log(tmp_path, "neighbor 0.001 multi\n")
    assert "finds no neighbours" not in log(tmp_path, "neighbor 0.001 nsq\n")
