"""``read_dump``: what it refuses, by file and line, and files that are cut or lie."""

from __future__ import annotations

import gzip

import pytest

from minidem import ScriptError, run_script
from tests.minidem.motion.dumped_cases import THERE, dump

BOX = (
    "atom_style granular\nnewton off\nunits si\ncommunicate single vel yes\n"
    "region r block -0.1 0.1 -0.1 0.1 -0.1 0.2\ncreate_box 2 r\n"
)
GOOD = "read_dump a.dump 200 x y z radius"
TEXT = dump()


def run(tmp_path, line, text=TEXT):
    (tmp_path / "a.dump").write_text(text)
    (tmp_path / "in.script").write_text(BOX + THERE + line + "\n")
    return run_script(tmp_path / "in.script", root=tmp_path)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("read_dump a.dump", "read_dump FILE STEP x y z"),
        ("read_dump a.dump 200 x y z", "the radius field is required"),
        ("read_dump a.dump 200 x x radius", "Duplicate fields"),
        ("read_dump a.dump 200 x radus", "unknown read_dump field or keyword 'radus'.*'radius'"),
        (GOOD + " purge yes", "cannot replace or trim; add 'replace no'"),
        (GOOD + " box perhaps", "unknown read_dump value 'perhaps'"),
        (GOOD + " format xyz", "expected 'native', found 'xyz'"),
        (GOOD + " label x vx", "LIGGGHTS 3.8.0 refuses it as well"),
        ("read_dump b.dump 200 radius", "Cannot open file b.dump"),
        ("read_dump ../a.dump 200 radius", "leads out of the folder"),
        ("read_dump a.dump 150 radius", "snapshot 150; it has steps 100 to 200"),
        ("read_dump a.dump 900 radius", "snapshot 900; it has steps 100 to 300"),
        ("read_dump a.dump -1 radius", "interval -1 is negative"),
    ],
)
def test_mistakes_in_the_line_are_named(tmp_path, line, message):
    with pytest.raises(ScriptError, match=message):
        run(tmp_path, line)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("ITEM: TIMESTEP\n200", "ITEM: TIMESTEP\n2e2", "a.dump: expected .* found '2e2'"),
        ("ITEM: TIMESTEP\n200", "TIMESTEP\n200", "a.dump:14: expected 'ITEM: TIMESTEP', found"),
        ("NUMBER OF ATOMS\n4", "NUMBER OF ATOMS\n-4", "a.dump:4: -4 is negative"),
        ("NUMBER OF ATOMS\n4", "NUMBER OF ATOMS\nfour", "a.dump: expected .* found 'four'"),
        ("BOX BOUNDS", "BOX BOUNDS xy xz yz", "the box is tilted"),
        ("-0.1 0.2", "0.3 0.2", "a lower side of the box is not below the upper one"),
        ("-0.1 0.2", "-0.1", "the box needs two numbers in each direction"),
        ("radius id", "size id", "no column 'radius'"),
        (" x y z", " a y z", "no column for x"),
        (" x y z", " xs y z", "do not have consistent scaling/wrapping"),
        ("0.0050000000000000001 5", "nan 5", "a.dump: radius: expected a number"),
        ("0.0050000000000000001 5", "-1 5", "a radius is negative"),
        ("0.0050000000000000001 5 1", "0.005 5 9", "an atom type is not between 1 and 2"),
    ],
)
def test_mistakes_in_the_dump_are_named(tmp_path, old, new, message):
    assert old in TEXT
    with pytest.raises(ScriptError, match=message):
        run(tmp_path, GOOD + " add yes", TEXT.replace(old, new))


@pytest.mark.parametrize(
    ("fields", "places", "flags"),
    [
        ("x y z radius iy", "x y z", "3 0 5"),
        ("x y z radius", "x y z", "3 4 5"),
        ("x y z radius iz", "xu yu zu", "1 0 -2"),
        ("radius ix", "x y z", "0 0 0"),
        ("radius", "x y z", "0 0 0"),
    ],
)
def test_which_crossings_of_faces_a_replaced_particle_keeps(tmp_path, fields, places, flags):
    """As LIGGGHTS 3.8.0 writes them: none if its places are unwrapped or not read at all."""
    line = f"set group all image 3 4 5\nread_dump a.dump 200 {fields} box no\n"
    shown = "write_dump all custom out.dump id ix iy iz"
    run(tmp_path, line + shown, dump(places))
    rows = [row.split() for row in (tmp_path / "out.dump").read_text().splitlines()[9:]]
    assert {row[0]: " ".join(row[1:]) for row in rows} == {"1": flags, "2": flags, "3": "3 4 5"}


def test_a_folder_is_told_as_the_script_has_it(tmp_path):
    for word in ("read_dump some/w.dump 200 radius", "read_data some/w.dump add"):
        with pytest.raises(ScriptError, match=r"Cannot open file some/w\.dump"):
            run(tmp_path, word)


def test_faces_that_differ_are_told(tmp_path):
    for faces, told in (("pp pp ff", True), ("pp pp pp", False)):
        run(tmp_path, GOOD, dump(faces=faces))
        assert ("do not match simulation" in (tmp_path / "log.liggghts").read_text()) == told


def test_a_count_that_lies_takes_no_memory(tmp_path):
    """Whether it is that of the snapshot that is wanted or of one that is passed over."""
    lying = TEXT.replace("NUMBER OF ATOMS\n4", "NUMBER OF ATOMS\n1000000000000")
    with pytest.raises(ScriptError, match="does not contain requested snapshot 200"):
        run(tmp_path, GOOD, lying)
    with pytest.raises(ScriptError, match=r"a\.dump|memory"):
        run(tmp_path, GOOD.replace("200", "100"), lying)


def test_a_dump_that_is_cut_gives_the_snapshot_or_a_message(tmp_path):
    whole = TEXT.index("ITEM: TIMESTEP\n300")
    for end in range(0, whole, 37):
        with pytest.raises(ScriptError, match=r"a\.dump"):
            run(tmp_path, GOOD, TEXT[:end])
    assert run(tmp_path, GOOD, TEXT[:whole]).particles == 3


def test_a_compressed_dump_is_read_as_the_plain_one(tmp_path):
    (tmp_path / "p.dump").write_bytes(gzip.compress(TEXT.encode()))
    shown = "\nwrite_dump all custom out.dump id x y z"
    found = []
    for name in ("a", "p"):
        run(tmp_path, GOOD.replace("a.dump", f"{name}.dump") + shown)
        found.append((tmp_path / "out.dump").read_bytes())
    assert found[0] == found[1]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (gzip.compress(TEXT.encode())[:-40], "cannot be read further"),
        (b"\x1f\x8bnothing", "cannot be read further"),
        (gzip.compress(b"ITEM: TIMESTEP\n" + b"0" * 100_000), "this is no dump"),
    ],
    ids=["cut", "no gzip", "a line without end"],
)
def test_a_compressed_dump_that_is_damaged_is_named(tmp_path, content, message):
    (tmp_path / "p.dump").write_bytes(content)
    with pytest.raises(ScriptError, match=f"p.dump: .*{message}"):
        run(tmp_path, GOOD.replace("a.dump", "p.dump").replace("200", "300"))


def test_a_dump_that_the_script_writes_itself_is_no_mistake_before_it_runs(tmp_path):
    """It is not there when the script is looked through."""
    line = "dump w all custom 1 w.dump id type x y z radius\nread_dump w.dump 0 x y z radius"
    with pytest.raises(ScriptError, match=r"Cannot open file w\.dump"):
        run(tmp_path, line)  # no run has written it
    contact = "pair_style gran model hertz\npair_coeff * *\nfix i all nve/sphere\n"
    moduli = "".join(
        f"fix {name[:5]} all property/global {name} {values}\n"
        for name, values in (
            ("youngsModulus", "peratomtype 5e6 5e6"),
            ("poissonsRatio", "peratomtype 0.3 0.3"),
            ("coefficientRestitution", "peratomtypepair 2 0.5 0.5 0.5 0.5"),
        )
    )
    made = run(tmp_path, moduli + contact + line.replace("\nread", "\nrun 1\nread") + "\nrun 1")
    assert made.particles == 3
