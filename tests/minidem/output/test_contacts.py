"""Contacts in dumps: forces, torques and histories of pairs and with meshes, as in LIGGGHTS."""

from __future__ import annotations

import numpy as np
import pytest

from minidem import run_script
from minidem.errors import ScriptError
from tests.minidem.output import scenes

ROLLING = "fix mr all property/global coefficientRollingFriction peratomtypepair 2 .1 .1 .1 .1\n"
HEAD = scenes.HEAD.replace(" history", " history rolling_friction epsd2").replace(
    "fix m5", ROLLING + "fix m5"
)
PAIR, WALL = 27, 35  # columns
IDS = slice(12, 15)


def columns(name: str, count: int) -> str:
    """Return the columns of a compute."""
    return " ".join(f"c_{name}[{k + 1}]" for k in range(count))


def formats(count: int) -> str:
    """Return formats of many digits."""
    return '"' + " ".join(["%.13g"] * count) + '"'


LINES = f"""compute pl all pair/gran/local
compute wl all wall/gran/local pos vel id force force_normal force_tangential torque &
 torque_normal torque_tangential history contactArea delta
compute sw all reduce sum c_wl[13] c_wl[16]
dump f all local 20 f*.loc {columns("pl", PAIR)}
dump_modify f format {formats(PAIR)}
dump g all local 20 g*.loc {columns("wl", WALL)}
dump_modify g format {formats(WALL)}
dump h all local/gran/vtk 20 h*.vtk pl
thermo_style custom step ke c_sw[1] c_sw[2]
run 1
run 200
"""
# LIGGGHTS takes one compute of a kind
PARTS = """compute pl all pair/gran/local pos force_normal force_tangential torque_normal &
 torque_tangential delta contactPoint
dump h all local/gran/vtk 100 h*.vtk pl
dump i all local/gran/vtk 100 h*.vtp pl
dump j all local/gran/vtk 100 h*.vtu pl
dump k all local 200 k.loc index c_pl[19]
dump_modify k label CONTACTS sort -2
run 200
"""


def rows(text: str) -> np.ndarray:
    """Return the rows of a local dump, sorted by ids: their order is that of search bins."""
    lines = text.split("ITEM: ENTRIES")[1].splitlines()[1:]
    found = [[float(word) for word in line.split()] for line in lines]
    return np.array(sorted(found, key=lambda row: row[IDS]))


def compare(mine: str, theirs: str) -> None:
    """Compare two local dumps."""
    assert mine.split("ITEM: ENTRIES")[0] == theirs.split("ITEM: ENTRIES")[0]
    np.testing.assert_allclose(rows(mine), rows(theirs), rtol=scenes.RTOL, atol=scenes.ATOL)


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Return the files that minidem writes."""
    return scenes.run_minidem(tmp_path_factory.mktemp("mine"), scenes.scene(LINES, HEAD))


def test_contacts_are_those_of_liggghts(files):
    for name in ("f200.loc", "g100.loc"):
        compare(files[name], (scenes.STORED / name).read_text())
    assert len(rows(files["g100.loc"])) > 5


@pytest.mark.liggghts
def test_all_contacts_are_those_of_liggghts(files, tmp_path):
    theirs = scenes.run_liggghts(tmp_path, scenes.scene(LINES, HEAD))
    for name in theirs:
        if name.endswith(".loc"):
            compare(files[name], theirs[name])
    vtk = {name: text for name, text in theirs.items() if name.endswith(".vtk")}
    assert scenes.different({name: files[name] for name in vtk}, vtk) == []


@pytest.mark.liggghts
def test_parts_of_forces_and_points_of_contact_are_those_of_liggghts(tmp_path):
    mine = scenes.run_minidem(tmp_path / "mine", scenes.scene(PARTS, HEAD))
    theirs = scenes.run_liggghts(tmp_path / "theirs", scenes.scene(PARTS, HEAD))
    assert len(theirs) == 10
    assert scenes.different(mine, theirs) == []


def test_forces_of_contacts_add_up_to_those_of_the_particles(tmp_path):
    """At the start of a run both are worked out at once, with the same velocities."""
    lines = f"""unfix grav
run 180
compute pl all pair/gran/local id force
compute wl all wall/gran/local id force
dump f all local 180 f*.loc {columns("pl", 6)}
dump g all local 180 g*.loc {columns("wl", 6)}
dump q all custom 180 q*.dump id fx fy fz
run 0
"""
    files = scenes.run_minidem(tmp_path, scenes.scene(lines, HEAD))
    sums = np.zeros((8, 3))
    for line in files["f180.loc"].split("c_pl[6]")[1].splitlines()[1:]:
        one, other, _, *force = map(float, line.split())
        sums[int(one)] += force
        sums[int(other)] -= force
    for line in files["g180.loc"].split("c_wl[6]")[1].splitlines()[1:]:
        _, _, one, *force = map(float, line.split())
        sums[int(one)] += force
    forces = [line.split() for line in files["q180.dump"].splitlines()[9:]]
    for id, *force in forces:
        # six digits are in the files
        np.testing.assert_allclose(sums[int(id)], [float(f) for f in force], rtol=2e-5, atol=1e-7)
    assert np.abs(sums).max() > 0.01


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("compute a all pair/gran/local forces", "did you mean 'force'?"),
        ("compute a all pair/gran/local heatFlux", "belongs to heat or clumps"),
        ("unfix w\ncompute a all wall/gran/local", "needs a fix wall/gran with meshes"),
        ("dump a all local 1 f c_b[1]", "'b' is no compute of contacts"),
        ("dump a all local 1 f index", "no column is one of a compute"),
        ("compute a all pair/gran/local id\ndump a all local/gran/vtk 1 f*.vtk a", "keyword 'pos'"),
        ("compute a all pair/gran/local id\ndump a all local 1 f c_a[4]\nrun 0", "has 3 columns"),
        ("compute a all pair/gran/local id\ndump a all local 1 f c_a[0]\nrun 0", "count from 1"),
    ],
)
def test_mistake_names_file_and_line(tmp_path, line, message):
    script = scenes.write(tmp_path, scenes.scene(line + "\n"))
    with pytest.raises(ScriptError) as error:
        run_script(script, root=tmp_path)
    assert message in str(error.value)


def test_a_moving_mesh_rests_for_output_where_a_run_begins(tmp_path):
    """Its wall comes first, so that the forces know its velocity, and what is asked later not."""
    lines = scenes.HEAD.splitlines()
    moves = [line for line in lines if line.startswith("fix mm")]
    head = "\n".join([*(line for line in lines if line not in moves), *moves, ""])
    dumps = f"""compute wl all wall/gran/local vel id force
run 100
dump v all mesh/vtk 100 v*.vtk vel cm
dump g all local 100 g*.loc {columns("wl", 12)}
dump p all custom 100 p*.dump id fx fy fz
dump_modify p sort id
run 100
"""
    files = scenes.run_minidem(tmp_path, scenes.scene(dumps, head))
    # of grain 1, as LIGGGHTS 3.8.0 writes it for this script
    assert "0 0 0 0.189595 0.35445 1.31382 0 0 1 -0.616693 0.355767 0.702642" in files["g100.loc"]
    assert "1 -0.332137 0.361345 1.00852" in files["p100.dump"]
    assert files["v100.vtk"].splitlines()[-1].split() == ["0"] * 6
    assert files["v200.vtk"].splitlines()[-1].split()[:3] == ["0.19416110387", "0", "0.19416110387"]
