"""A run from a restart file is bit for bit the second run of the script that wrote it."""

from __future__ import annotations

import hashlib
import json
import re
import shutil

import numpy as np
import pytest

from minidem import run_script
from minidem.errors import ScriptError
from minidem.run.restarts.own_file import MAGIC
from tests.paths import DATA

START = """atom_style sphere
atom_modify map array sort 0 0
newton off
communicate single vel yes
units si
"""
BOX = """boundary f f f
region reg block -0.05 0.05 -0.05 0.05 -0.01 0.1 units box
create_box 1 reg
"""
REST = """region bc block -.02 .02 -.02 .02 .02 .06
neighbor 0.002 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype 5e6
fix m2 all property/global poissonsRatio peratomtype .3
fix m3 all property/global coefficientRestitution peratomtypepair 1 .6
fix m4 all property/global coefficientFriction peratomtypepair 1 .5
fix m5 all property/global coefficientRollingFriction peratomtypepair 1 .1
pair_style gran model hertz tangential history rolling_friction epsd2
pair_coeff * *
timestep 1e-5
fix g all gravity 9.81 vector 0 0 -1
fix cm all mesh/surface file m.stl type 1
fix face all mesh/surface file f.stl type 1
fix w all wall/gran model hertz tangential history rolling_friction epsd2 mesh n_meshes 1 meshes cm
fix w2 all wall/gran model hertz tangential history rolling_friction epsd2 primitive type 1 &
  zplane -0.002
fix mv all move/mesh mesh cm wiggle amplitude 0 0 0.001 period 0.05
fix p all particletemplate/sphere 15485863 atom_type 1 density constant 2500 radius constant 0.002
fix d all particledistribution/discrete 15485867 1 p 1.0
fix d2 all particledistribution/discrete 49979687 1 p 1.0
fix ins all insert/rate/region seed 32452843 distributiontemplate d nparticles 300 &
  particlerate 10000 insert_every 300 vel constant 0 0 -1 region bc
fix st all insert/stream seed 32452867 distributiontemplate d2 nparticles 300 particlerate 2000 &
  vel constant 0 0 -1 insertion_face face extrude_length 0.01
fix mf all massflow/mesh mesh face count once vec_side 0 0 -1
fix integr all nve/sphere
thermo_style custom step atoms ke f_mf[1] f_mf[2] f_ins[1]
thermo 500
thermo_modify lost ignore norm no
dump a all custom 500 d_*.dump id type x y z vx vy vz fx fy fz omegax omegay omegaz tqx tqy tqz
dump_modify a sort id format "%d %d %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g &
%.17g %.17g %.17g %.17g %.17g"
"""


def square(z: float, r: float) -> str:
    """Return a square of two triangles as STL."""
    facets = [[(-r, -r), (r, -r), (r, r)], [(-r, -r), (r, r), (-r, r)]]
    lines = ["solid m"]
    for corners in facets:
        lines += ["facet normal 0 0 1", "outer loop"]
        lines += [f"vertex {x} {y} {z}" for x, y in corners]
        lines += ["endloop", "endfacet"]
    return "\n".join([*lines, "endsolid m", ""])


def case(folder, script: str) -> None:
    """Write meshes and script, and run it."""
    folder.mkdir(exist_ok=True)
    (folder / "m.stl").write_text(square(0.0, 0.03))
    (folder / "f.stl").write_text(square(0.07, 0.01))
    (folder / "in.s").write_text(script)
    run_script(folder / "in.s", root=folder)


def thermo(folder) -> list[str]:
    lines = (folder / "log.liggghts").read_text().splitlines()
    return [line for line in lines if len(line.split()) == 6 and line.split()[0].isdigit()]


def test_restarted_run_continues_to_the_last_bit(tmp_path):
    """Insertion, streams in flight, contacts, moving mesh and flow counter in full swing."""
    first, second = tmp_path / "first", tmp_path / "second"
    case(first, START + BOX + REST + "run 2300\nwrite_restart r_*.npz\nrun 1500\n")
    second.mkdir()
    shutil.copy(first / "r_2300.npz", second)
    case(second, START + "read_restart r_2300.npz\n" + REST + "run 1500\n")
    names = sorted(path.name for path in second.glob("d_*.dump"))
    assert names == ["d_2500.dump", "d_3000.dump", "d_3500.dump"]
    for name in names:
        assert (first / name).read_text() == (second / name).read_text(), name
    rows = thermo(second)
    assert rows == thermo(first)[-len(rows) :]
    assert float(rows[-1].split()[4]) > 10  # the flow counter has counted


def test_servo_that_turns_continues_to_the_last_bit(tmp_path):
    """How fast it may turn follows from its nodes, which are where the first run left them."""
    kept = DATA / "golden" / "w_servo_torque"
    text = (kept / "in.case").read_text()
    begun = text[: text.index("run 900")]
    again = re.sub(r"^(region reg|create_atoms|set atom) .*\n", "", begun, flags=re.MULTILINE)
    again = again.replace("create_box 2 reg", "read_restart r.npz")
    for folder, script in (
        (tmp_path / "first", f"{begun}run 900\nwrite_restart r.npz\nrun 300\n"),
        (tmp_path / "second", f"{again}run 300\n"),
    ):
        folder.mkdir()
        shutil.copy(kept / "plate.stl", folder)
        (folder / "in.s").write_text(script)
        if folder.name == "second":
            shutil.copy(tmp_path / "first" / "r.npz", folder)
        run_script(folder / "in.s", root=folder)
    first, second = ((tmp_path / name / "traj.dump").read_text() for name in ("first", "second"))
    last = second.split("ITEM: TIMESTEP")[-3:]
    assert len(last) == 3
    assert first.split("ITEM: TIMESTEP")[-3:] == last


def test_steps_can_be_renumbered_before_the_run(tmp_path):
    """Insertion keeps its distance to the present step."""
    first, second = tmp_path / "first", tmp_path / "second"
    case(first, START + BOX + REST + "run 1000\nwrite_restart r.npz\nrun 900\n")
    second.mkdir()
    shutil.copy(first / "r.npz", second)
    reset = "reset_timestep 0\nreset_timestep 50000\n"
    case(second, START + "read_restart r.npz\n" + REST + reset + "run 900\n")
    assert thermo(second)[0].split()[:2] == ["50000", thermo(first)[-3].split()[1]]
    assert thermo(second)[-1].split()[1] == thermo(first)[-1].split()[1]


def test_restart_every_so_many_steps(tmp_path):
    case(tmp_path, START + BOX + REST + "restart 200 post/r*.npz\nrun 500\nrestart 0\nrun 300\n")
    names = sorted(path.name for path in (tmp_path / "post").iterdir())
    assert names == ["r200.npz", "r400.npz"]
    with (tmp_path / "post" / "r400.npz").open("rb") as file:
        file.seek(len(MAGIC) + hashlib.sha256().digest_size)
        with np.load(file, allow_pickle=False) as archive:
            meta = json.loads(archive["meta"].tobytes())
    assert meta["step"] == 400
    assert meta["groups"] == {"all": 1}


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (None, "cannot read restart file"),
        (b"", "no restart file of minidem"),
        (b"LIGGGHTS RESTART", "no restart file of minidem"),
    ],
)
def test_bad_restart_file_is_named(tmp_path, content, message):
    if content is not None:
        (tmp_path / "r.npz").write_bytes(content)
    (tmp_path / "in.s").write_text(START + "read_restart r.npz\n")
    with pytest.raises(ScriptError, match=message):
        run_script(tmp_path / "in.s", root=tmp_path)


def test_object_arrays_are_never_loaded(tmp_path):
    """A pickled object would run code on loading."""
    np.savez(tmp_path / "r.npz", meta=np.array([print], dtype=object))
    (tmp_path / "in.s").write_text(START + "read_restart r.npz\n")
    with pytest.raises(ScriptError, match="of another version"):
        run_script(tmp_path / "in.s", root=tmp_path)
