"""``read_data`` and ``lattice``: what they refuse, by file and line."""

from __future__ import annotations

import math

import pytest

from minidem import ScriptError, run_script

HEADER = """title
2 atoms
1 atom types
0 1 xlo xhi
0 1 ylo yhi
0 1 zlo zhi

Atoms

"""
GOOD = HEADER + "1 1 0.1 2500 0.2 0.2 0.2\n2 1 0.1 2500 0.5 0.5 1.25\n"
SCRIPT = "atom_style granular\nboundary f f p\nread_data a.data\n"
BOX = "units si\nregion r block 0 1 0 1 0 1\ncreate_box 1 r\n"


def run(tmp_path, text, data=GOOD):
    (tmp_path / "a.data").write_text(data)
    (tmp_path / "in.script").write_text(text)
    return run_script(tmp_path / "in.script", root=tmp_path)


def test_particles_beyond_a_periodic_face_are_brought_back(tmp_path):
    text = SCRIPT + 'print "at $(bound(all,zmax))"\n'
    assert run(tmp_path, text).particles == 2
    assert "at 0.25\n" in (tmp_path / "log.liggghts").read_text()


def test_atom_style_hybrid_has_places_before_diameter_and_density(tmp_path):
    """As LIGGGHTS 3.8.0 reads and writes them."""
    hybrid = SCRIPT.replace("granular", "hybrid sphere")
    shown = 'print "mass $(mass(all)) at $(bound(all,zmax))"\nwrite_data b.data\n'
    run(tmp_path, hybrid + shown, HEADER + "1 1 0.2 0.2 0.2 1 3\n2 1 0.5 0.5 0.25 1 3\n")
    assert f"mass {math.pi:.6g}" in (tmp_path / "log.liggghts").read_text()
    written = (tmp_path / "b.data").read_text().split("Atoms\n\n")[1].split()
    assert list(map(float, written[:10])) == [1, 1, 0.2, 0.2, 0.2, 1, 3, 0, 0, 0]
    with pytest.raises(ScriptError, match="has radius and density twice"):
        run(tmp_path, SCRIPT.replace("granular", "hybrid sphere granular"))


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ("", "gives no 'atom types'"),
        (GOOD.replace("2 atoms", "3 atoms"), "a.data:12: atoms need 7 or 10 words, found 0"),
        (GOOD.replace("2 atoms", "1000000000000 atoms"), "a.data:1[23]: "),
        (GOOD.replace("2 atoms", "-2 atoms"), "a.data:2: atoms: -2 is negative"),
        (GOOD.replace("0 1 ylo", "1 0 ylo"), "a.data:5: Box bounds are invalid"),
        (GOOD.replace("0.2 0.2 0.2", "0.2 1.2 0.2"), r"Did not assign all atoms correctly: \[1\]"),
        (GOOD.replace("0.2 0.2 0.2", "0.2 nan 0.2"), "expected a number, found 'nan'"),
        (GOOD.replace("1 1 0.1", "2 1 0.1"), "an atom id is .* given twice"),
        (GOOD.replace("1 1 0.1", "1 2 0.1"), "an atom type is not between 1 and 1"),
        (GOOD.replace("1 1 0.1", "1 1 -0.1"), "a diameter is negative"),
        (GOOD.replace("Atoms", "Atom"), "section 'Atom' is not supported; did you mean 'Atoms'"),
        (GOOD.replace("1 atom types", "1 atom types\n3 bonds"), "the file is not of spheres"),
        (GOOD.replace("title", "title\n0 0 0 xy xz yz"), "tilted box"),
        (GOOD + "\nVelocities\n\n1 0 0 0 0 0 0\n7 0 0 0 0 0 0\n", "Invalid atom ID in Velocities"),
        (GOOD + "\nVelocities\n\n1 0 0 0\n", "velocities need 7 words, found 4"),
    ],
)
def test_mistakes_in_a_data_file_are_named(tmp_path, data, message):
    with pytest.raises(ScriptError, match=message):
        run(tmp_path, SCRIPT, data)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("read_data a.data", "Cannot read_data after simulation box is defined"),
        ("read_data b.data add", "Cannot open file b.data"),
        ("read_data ../a.data add", "leads out of the folder"),
        ("read_data a.data add\nread_data a.data add", "in use already"),
        ("create_atoms 1 box", "undefined lattice"),
        ("create_atoms 1 random 5 10007 NULL", "takes its number of particles for the seed"),
        ("lattice sq 1", "incompatible with simulation dimension"),
        ("lattice custom 1", "No basis atoms"),
        ("lattice sc 1 orient x 1 1 0", "not orthogonal"),
        ("lattice sc 1 orient x 0 1 0 orient y 1 0 0", "not right-handed"),
        ("lattice custom 1 basis 0 0 0 a1 0 1 0", "Degenerate"),
        ("lattice sc 1 origin 1 0 0", "0 to below 1"),
        ("lattice sc 1e-9\ncreate_atoms 1 box", "make its scale larger"),
    ],
)
def test_mistakes_in_a_script_are_named(tmp_path, line, message):
    with pytest.raises(ScriptError, match=message):
        run(tmp_path, BOX + line + "\n")
