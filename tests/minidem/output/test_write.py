"""Data files, single snapshots, ``info`` and groups, held against what LIGGGHTS writes."""

from __future__ import annotations

import numpy as np
import pytest

from minidem import run_script
from minidem.errors import ScriptError
from tests.minidem.output import scenes

LINES = """variable q atom x>0
group pos variable q
group low id < 3
group mid id <> 2 4
group big type >= 2
group eq id == 3
group seq id 1 4:7:2
group sub id 1 2 3
group sub subtract all mid
group gone id 1
group gone delete
group again id 5
compute k all ke
dump a all custom 100 a*.dump id x
run 20
write_data all.data
write_data b*.data pair ij tag_offset 10
write_dump all custom w.dump id x y z modify sort id format "%d %.10g %g %g"
write_dump low xyz w*.xyz
write_dump again custom/vtk w*.vtk id x y z vx vy vz
info all out overwrite info.txt
info groups out append info.txt
run 10
"""


def body(text: str) -> str:
    """Return a data file without its first line, which names the program."""
    return text.split("\n", 1)[1]


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Return the files that minidem writes, and its log."""
    folder = tmp_path_factory.mktemp("mine")
    found = scenes.run_minidem(folder, scenes.scene(LINES))
    return found | {"log": (folder / "log.liggghts").read_text()}


def test_data_file_is_that_of_liggghts(files):
    stored = (scenes.STORED / "written.data").read_text()
    assert scenes.alike(body(files["all.data"]), body(stored))
    assert files["b20.data"].split("Atoms\n\n")[1].startswith("11 1 8.0")


def test_groups_have_the_members_that_they_have_in_liggghts(files):
    # as LIGGGHTS prints them for these lines
    members = ["4 pos", "2 low", "3 mid", "3 big", "1 eq", "3 seq", "3 sub", "4 sub", "1 gone"]
    told = [line for line in files["log"].splitlines() if " atoms in group " in line]
    assert told == [one.replace(" ", " atoms in group ") for one in (*members, "1 again")]


def test_info_names_what_there_is(files):
    text = files["info.txt"]
    for line in (
        "Group[ 0]: all ", "Compute[  0]: thermo_temp,  style = temp,  group = all",
        "Dump[  0]: a,  file = a*.dump,  style = custom,  group = all,  every = 100",
        "Variable[  0]: q           style = atom", "Region[  0]: reg",
    ):  # fmt: skip
        assert line in text
    assert text.count("Group information:") == 2


@pytest.mark.liggghts
def test_all_files_are_those_of_liggghts(files, tmp_path):
    script = scenes.scene(LINES.replace(" tag_offset 10", ""))
    theirs = scenes.run_liggghts(tmp_path, script)
    log = (tmp_path / "log.liggghts").read_text(errors="replace").splitlines()
    assert [x for x in log if "atoms in group" in x] == [
        x for x in files["log"].splitlines() if "atoms in group" in x
    ]
    for name in theirs:
        if name == "all.data":
            assert scenes.alike(body(files[name]), body(theirs[name]))
        elif name not in ("info.txt", "b20.data"):
            assert files[name] == theirs[name], name


def test_data_file_is_read_again(tmp_path):
    """Particles behind a periodic face are written within the box, those outside not at all."""
    head = scenes.HEAD.replace("boundary f f m", "boundary p f f").replace("-0.1 0.2", "-0.1 0.1")
    more = "create_atoms 1 single 0.1999 0.05 0.0 units box\n"
    more += "create_atoms 1 single 0 0 0.0999 units box\n"
    more += "set atom 8*9 diameter 0.004 density 2000 vx 5 vz 5\n"
    scenes.run_minidem(tmp_path, scenes.scene(more + "run 10\nwrite_data p.data\n", head))
    lines = (tmp_path / "p.data").read_text().splitlines()
    assert lines[2] == "8 atoms"
    row = next(line.split() for line in lines if line.startswith("8 1 "))
    np.testing.assert_allclose(float(row[4]), 0.1999 + 5e-4 - 0.4, atol=1e-12)
    assert row[7:] == ["1", "0", "0"]
    again = head.split("region reg")[0] + "read_data p.data\nrun 0\n"
    (tmp_path / "in.t").write_text(again.replace("units si", "units si\ntimestep 1e-5"))
    with pytest.raises(ScriptError, match="pair_style"):  # all is read, only the model is missing
        run_script(tmp_path / "in.t", root=tmp_path)


def test_faces_of_a_data_file_are_where_the_particles_are(tmp_path):
    """Wrapped faces follow the particles at once, as in LIGGGHTS, and all of them lie within."""
    head = scenes.HEAD.replace("boundary f f m", "boundary s m s")
    head = head[: head.index("fix cm")]
    files = scenes.run_minidem(tmp_path, scenes.scene("", head).split("fix integr")[0] + (
        "fix integr all nve/sphere\nrun 200\nwrite_data p.data\nvariable hi equal xhi\n"
        "print '${hi}' file hi.txt\nclear\natom_style sphere\nboundary s m s\n"
        "newton off\ncommunicate single vel yes\nread_data p.data\n"
        "write_dump all custom q.dump id\n"
    ))  # fmt: skip
    # the lines that LIGGGHTS 3.8.0 writes for this script
    wanted = "-2.9039999999999691e-02 3.0240000000000197e-02 xlo xhi"
    assert wanted in files["p.data"]
    assert len(files["q.dump"].splitlines()) == 9 + 7
    assert files["hi.txt"].strip() == f"{float(wanted.split()[1]):.15g}"


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("group a variable v", "'v' is no variable of style atom"),
        ("group a variable", "expected one name"),
        ("group a id", "expected numbers, ranges"),
        ("group a id <> 3", "expected 2 whole numbers"),
        ("group a id < x", "expected a whole number, found 'x'"),
        ("group a id != 3", "takes these that are equal; use 'subtract all GROUP'"),
        ("group a typ 3", "did you mean 'type'?"),
        ("group all delete", "Cannot delete group all"),
        ("group a id 1\nfix f a freeze\ngroup a delete", "used by fix f; 'unfix f' first"),
        ("write_data", "write_data FILE"),
        ("write_data ../a", "leads out of the folder"),
        ("write_data a pair kk", "known: ii, ij"),
        ("write_dump all custom a", "COLUMN"),
        ("write_dump all custm a id", "unknown dump 'custm'"),
        ("write_dump all custom a id modify sorted id", "did you mean 'sort'?"),
        ("write_dump all custom /a id", "is an absolute path"),
        ("info al", "unknown info category 'al'"),
        ("info all out file", "known: screen, log, append, overwrite"),
    ],
)
def test_mistake_names_file_and_line(tmp_path, line, message):
    script = scenes.write(tmp_path, scenes.scene(line + "\n"))
    with pytest.raises(ScriptError) as error:
        run_script(script, root=tmp_path)
    assert message in str(error.value)
