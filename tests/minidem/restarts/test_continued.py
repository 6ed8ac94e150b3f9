"""Restart files of LIGGGHTS: runs that go on from them, and what is wrong with files."""

from __future__ import annotations

import shutil
import struct

import numpy as np
import pytest

from minidem import run_script
from minidem.errors import InputError, ScriptError
from minidem.run.restarts.liggghts_file import parse_restart
from tests.minidem.engine.cases import read
from tests.minidem.engine.test_cases import compare
from tests.minidem.restarts.continued_cases import CASES, begin, go_on, load, restart_files

STORED = load()
TEXT = struct.Struct("<i")


def file_of(name: str, folder) -> bytes:
    """Return the stored restart file of a case."""
    return restart_files(name, folder)[0].read_bytes()


def refusal(folder, case: str = "epsd2", data: bytes = b"", change=lambda text: text) -> str:
    """Return why the second script of a case is refused."""
    script = CASES[case].write(folder)
    script.write_text(change(script.read_text()))
    restart_files(case, folder)
    if data:
        (folder / "r.restart").write_bytes(data)
    with pytest.raises(ScriptError) as caught:
        run_script(script, root=folder)
    return str(caught.value).replace(f"{folder}/", "")


# -- runs that go on -------------------------------------------------------------------------------


@pytest.mark.parametrize("name", CASES)
def test_goes_on_as_liggghts_does(tmp_path, name):
    restart_files(name, tmp_path)
    run_script(CASES[name].write(tmp_path), root=tmp_path)
    compare(read(tmp_path), STORED[name], CASES[name].rtol)


@pytest.mark.liggghts
@pytest.mark.parametrize("name", CASES)
def test_stored_numbers_are_those_of_liggghts(tmp_path, name):
    begin(CASES[name], tmp_path)
    # the same program on the same kind of machine: compilers may differ in the last digits
    compare(go_on(CASES[name], tmp_path), STORED[name], 1e-12)


def test_stored_cases_are_those_there_are():
    assert list(STORED) == list(CASES)


def test_contacts_that_begin_anew_would_be_seen(tmp_path):
    """The comparison above is worth something: without histories the numbers are others."""
    data = file_of("luding", tmp_path)
    script = CASES["luding"].write(tmp_path)
    # another id for what keeps the histories, which then is of nobody
    (tmp_path / "r.restart").write_bytes(data.replace(b"contacthistory\0", b"contacthistorz\0"))
    run_script(script, root=tmp_path)
    with pytest.raises(AssertionError, match="force"):
        compare(read(tmp_path), STORED["luding"], 1e-4)


def test_the_script_need_not_have_all_that_the_file_has(tmp_path):
    """As with LIGGGHTS walls may go, and particles, before the first run."""
    script = CASES["epsd2"].write(tmp_path)
    lines = [
        line for line in script.read_text().splitlines()
        if not line.startswith(("fix pipe", "fix ins", "fix pd"))
    ]  # fmt: skip
    at = next(i for i, line in enumerate(lines) if line.startswith("thermo_style"))
    lines[at:at] = ["group some id 1:5", "delete_atoms group some"]
    script.write_text("\n".join([*lines, ""]))
    restart_files("epsd2", tmp_path)
    run_script(script, root=tmp_path)
    found = read(tmp_path)
    assert [len(rows) for rows in found.frames.values()] == [24, 24, 24]


def test_the_name_that_liggghts_would_give_the_first_of_several_files_is_minidems(tmp_path):
    script = CASES["history"].write(tmp_path)
    restart_files("history", tmp_path)
    text = script.read_text().replace("run 1000", "write_restart s.%.*")
    script.write_text(text)
    run_script(script, root=tmp_path)
    assert (tmp_path / "s.base.2000").is_file()
    script.write_text(text.replace("r.restart", "s.%.*"))
    run_script(script, root=tmp_path)


def test_grains_of_a_stream_are_free_if_the_script_has_none(tmp_path):
    script = CASES["stream"].write(tmp_path)
    lines = [line for line in script.read_text().splitlines() if not line.startswith("fix ins")]
    script.write_text("\n".join([*lines, ""]))
    restart_files("stream", tmp_path)
    run_script(script, root=tmp_path)
    first, *_, last = read(tmp_path).frames.values()
    # all of them fall freely from the first step on
    fallen = last[:, 7] - first[:, 7]
    assert fallen[last[:, 4] > 0.006] == pytest.approx(-9.81 * 1000 * 1e-5, rel=1e-6)


def test_the_newest_of_several_files_is_read(tmp_path):
    restart_files("history", tmp_path)
    (tmp_path / "sub").mkdir()
    shutil.move(tmp_path / "r.restart", tmp_path / "sub" / "r.2000.restart")
    for other in ("r.300.restart", "r.9x.restart", "r.restart"):
        (tmp_path / "sub" / other).write_bytes(b"none")
    script = CASES["history"].write(tmp_path)
    script.write_text(script.read_text().replace("r.restart", "sub/r.*.restart"))
    run_script(script, root=tmp_path)
    compare(read(tmp_path), STORED["history"], CASES["history"].rtol)


def test_the_wear_of_a_mesh_goes_on(tmp_path):
    name = "rotate, stress and wear"
    _, wrote = parse_restart(file_of(name, tmp_path)).fixes["cad"]
    worn = wrote[3:-8].reshape(2, 12)[:, 11]  # of two triangles: size, nodes, number, wear
    assert worn.min() > 1e-12
    script = CASES[name].write(tmp_path)
    dump = "dump w all mesh/vtk 1 w_*.vtk wear cad\nrun 0\n"
    script.write_text(script.read_text().replace("run 1000\n", dump))
    run_script(script, root=tmp_path)
    found = (tmp_path / "w_2000.vtk").read_text().split("wear 1 2 double\n")[1].split()
    assert [float(one) for one in found] == pytest.approx(worn, rel=1e-9)  # 11 digits are written


def test_units_and_groups_come_from_the_file(tmp_path):
    data = bytearray(file_of("history", tmp_path))
    state = parse_restart(bytes(data))
    assert (state.units, state.groups, state.step) == ("si", {"all": 1}, 2000)
    assert state.boundary == ("ff", "ff", "ff")
    np.testing.assert_array_equal(state.lo, [-0.1, -0.1, -0.1])
    np.testing.assert_array_equal(state.hi, [0.1, 0.1, 0.2])
    np.testing.assert_allclose(
        state.mass, 4.0 / 3.0 * np.pi * state.radius**3 * state.density, rtol=1e-14
    )


def test_crossings_of_periodic_faces_are_read(tmp_path):
    state = parse_restart(file_of("periodic", tmp_path))
    assert set(state.image[:, 0].tolist()) == {0, 1}
    assert not state.image[:, 1:].any()


# -- what is wrong ---------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["rotate, stress and wear", "washino", "stream"])
def test_a_cut_file_is_refused_wherever_it_is_cut(tmp_path, name):
    data = file_of(name, tmp_path)
    for length in (*range(0, 1500, 7), *range(1500, len(data), 149), len(data) - 1):
        with pytest.raises(InputError):
            parse_restart(data[:length])


def test_a_changed_file_is_refused_or_read(tmp_path):
    """Whatever a byte is changed to, nothing else is raised and no memory is taken."""
    data = file_of("washino", tmp_path)
    random = np.random.default_rng(5)
    outcomes = []
    for _ in range(400):
        changed = bytearray(data)
        at = int(random.integers(min(len(data), int(random.choice([1200, len(data)])))))
        changed[at] = int(random.integers(256))
        try:
            parse_restart(bytes(changed))
        except InputError:
            outcomes.append(False)
        else:
            outcomes.append(True)
    assert 20 < sum(outcomes) < 380  # both happen


def with_entry(data: bytes, key: int, old: bytes, new: bytes) -> bytes:
    """Return a file with another value in the header."""
    before, after = TEXT.pack(key) + old, TEXT.pack(key) + new
    assert data.count(before) == 1
    return data.replace(before, after)


def text(words: str) -> bytes:
    """Return a text as it stands in a file."""
    raw = words.encode() + b"\0"
    return TEXT.pack(len(raw)) + raw


@pytest.mark.parametrize(
    ("key", "old", "new", "why"),
    [
        (22, text("granular"), text("ellipsoid"), "atom_style ellipsoid; minidem has spheres only"),
        (6, TEXT.pack(3), TEXT.pack(2), "two dimensions"),
        (4, text("si"), text("real"), "has units real; minidem has si, cgs"),
        (16, TEXT.pack(1), TEXT.pack(7), "boundaries along x make no sense"),
        (24, TEXT.pack(2), TEXT.pack(0), "box or counts make no sense"),
        (
            23,
            struct.pack("<q", 29),
            struct.pack("<q", 2**40),
            "no room for its 1099511627776 atoms",
        ),
        (23, struct.pack("<q", 29), struct.pack("<q", 28), "more than its 28 atoms"),
        (7, TEXT.pack(1), TEXT.pack(3), "ends too early"),
        (3, TEXT.pack(8), TEXT.pack(5), "whole numbers of this size"),
    ],
)
def test_what_minidem_has_not_is_refused_by_name(tmp_path, key, old, new, why):
    data = with_entry(file_of("history", tmp_path), key, old, new)
    said = refusal(tmp_path, "history", data)
    assert why in said
    assert said.startswith("in.script:7: ")


def test_restart_files_of_other_programs_are_refused(tmp_path):
    data = file_of("history", tmp_path)
    old = data[8 : 8 + TEXT.unpack(data[4:8])[0] - 1].decode()
    assert "LIGGGHTS-PUBLIC 3.8.0" in old
    two = data.replace(text(old), text(old.replace("3.8.0", "2.3.8")))
    assert "those of LIGGGHTS 3 can" in refusal(tmp_path, "history", two)
    lammps = data.replace(text(old), text("23 Jun 2022"))
    assert "is no restart file of minidem or of LIGGGHTS" in refusal(tmp_path, "history", lammps)


def test_clumps_are_refused(tmp_path):
    data = file_of("passages", tmp_path)
    clumps = data.replace(text("massflow/mesh"), text("multisphere/x"), 1)
    assert clumps != data
    said = refusal(tmp_path, "passages", clumps)
    assert "restart file has clumps (fix mf multisphere/x); minidem has spheres only" in said


@pytest.mark.parametrize("value", [np.nan, np.inf, 1e60])
def test_numbers_of_a_fix_that_make_no_sense_are_refused(tmp_path, value):
    data = file_of("insertion goes on", tmp_path)
    seed, *_ = parse_restart(data).fixes["ins"][1]
    wrong = data.replace(struct.pack("<d", seed), struct.pack("<d", value), 1)
    assert "what fix ins wrote makes no sense" in refusal(tmp_path, "insertion goes on", wrong)


def test_another_contact_model_is_refused(tmp_path):
    said = refusal(tmp_path, change=lambda script: script.replace(" rolling_friction epsd2", ""))
    assert "the pair style: the restart file was written with another contact model" in said
    assert "remember 6 numbers, not 3" in said


def test_another_mesh_is_refused(tmp_path):
    def other(script: str) -> str:
        (tmp_path / "m.stl").write_bytes((tmp_path / "high.stl").read_bytes())
        stl = (tmp_path / "m.stl").read_text().split("endfacet")
        (tmp_path / "m.stl").write_text("endfacet".join([stl[0], stl[-1]]))
        return script

    said = refusal(tmp_path, "wiggle", change=other)
    assert "mesh 'cad' is not the one of the restart file" in said


def test_missing_files_are_named(tmp_path):
    def search(script: str) -> str:
        return script.replace("r.restart", "none/r.*.restart")

    assert "cannot search 'none' for restart files" in refusal(tmp_path, change=search)
    said = refusal(tmp_path, change=lambda script: script.replace("r.restart", "r.*.data"))
    assert "Found no restart file matching pattern 'r.*.data'" in said
    assert "outside" not in said
    out = refusal(tmp_path, change=lambda script: script.replace("r.restart", "../r.*.data"))
    assert "leads out of the folder of the case" in out
