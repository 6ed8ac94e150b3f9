"""Particles that leave the box: the default, the warning, the stop, and the order of those left."""

from __future__ import annotations

import io
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from minidem import SimulationError, run_script
from minidem.run.losses import LossWatch
from minidem.world.world import World
from tests.minidem.engine.cases import plate, stl_text

HEAD = """atom_style granular
atom_modify map array sort 0 0
boundary f f f
newton off
communicate single vel yes
units si
region reg block 0 0.1 0 0.1 0 0.1 units box
create_box 1 reg
neighbor {skin} bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype 5e6
fix m2 all property/global poissonsRatio peratomtype 0.3
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.5
fix m4 all property/global coefficientFriction peratomtypepair 1 0.5
pair_style gran model hertz tangential history
pair_coeff * *
timestep {dt}
"""
FOUR = """create_atoms 1 single 0.05 0.05 0.01
create_atoms 1 single 0.05 0.05 0.05
create_atoms 1 single 0.05 0.02 0.05
create_atoms 1 single 0.02 0.02 0.05
set group all diameter 0.004 density 2500
set atom 1 vz -1
set atom 3 vy -0.4
fix i all nve/sphere
thermo_style custom step atoms
thermo 50
dump d all custom 50 d_*.dump id
"""
"""Grain 1 leaves after some 100 steps, grain 3 after some 500."""


def four(lost: str) -> str:
    return HEAD.format(skin=0.002, dt=1e-4) + FOUR + lost + "run 300\nrun 300\n"


def scattering() -> str:
    """Return a script in which several grains leave through several faces at once."""
    rng = np.random.default_rng(7)
    places, speeds = rng.uniform(0.004, 0.096, (24, 3)), rng.uniform(-30.0, 30.0, (24, 3))
    lines = [f"create_atoms 1 single {x:.4f} {y:.4f} {z:.4f}" for x, y, z in places]
    lines.append("set group all diameter 0.0004 density 2500")
    lines += [f"set atom {i} vx {u:.3f} vy {v:.3f} vz {w:.3f}"
              for i, (u, v, w) in enumerate(speeds, start=1)]  # fmt: skip
    lines += ["fix i all nve/sphere", "thermo_style custom step atoms", "thermo 50"]
    lines += ["dump d all custom 100 d_*.dump id", "run 300", ""]
    return HEAD.format(skin=0.02, dt=1e-5) + "\n".join(lines)


LEFT = {
    0: list(range(1, 25)),
    100: [1, 21, 3, 4, 5, 6, 24, 8, 22, 10, 11, 12, 13, 19, 15, 16, 17, 18],
    200: [18, 12, 3, 16, 5, 6, 24, 8, 22, 19, 11],
    300: [24, 11, 3, 8, 5, 6],
}
"""Ids in the order of LIGGGHTS 3.8.0, by step; written by ``scattering`` and that program."""


def flowing() -> str:
    """Return a script with a refilled region, a plate, an outlet, losses and two runs."""
    return (
        HEAD.format(skin=0.004, dt=1e-4)
        + """fix p all particletemplate/sphere 15485863 atom_type 1 density constant 2500 &
  radius constant 0.002
fix d all particledistribution/discrete 15485867 1 p 1.0
region bc block 0.03 0.07 0.03 0.07 0.06 0.09 units box
fix ins all insert/pack seed 32452843 distributiontemplate d insert_every 100 &
  overlapcheck yes all_in yes vel constant 0.9 0.2 -1 particles_in_region 25 region bc
fix cad all mesh/surface file plate.stl type 1 move 0.04 0.05 0
fix out all mesh/surface/planar file outlet.stl type 1 move 0.05 0.05 0
fix mf all massflow/mesh mesh out count once vec_side 0 0 -1
fix g all gravity 9.81 vector 0 0 -1
fix w all wall/gran model hertz tangential history mesh n_meshes 1 meshes cad
fix i all nve/sphere
thermo_style custom step atoms ke f_mf[1] f_mf[2] f_ins[1]
thermo 100
thermo_modify norm no format float %.12g
dump dd all custom 100 d_*.dump id type x y z vx vy vz
run 1200
write_restart half
run 800
"""
    )


def written(folder: Path, script: str) -> Path:
    """Write a script and its meshes; return the script."""
    folder.mkdir(exist_ok=True)
    (folder / "plate.stl").write_text(stl_text(plate(0.03, 0.03)))
    (folder / "outlet.stl").write_text(stl_text(plate(0.01, 0.049)))
    (folder / "in.s").write_text(script)
    return folder / "in.s"


def liggghts(folder: Path, script: str) -> subprocess.CompletedProcess[str]:
    program = shutil.which("liggghts")
    assert program
    written(folder, script)
    return subprocess.run(
        [program, "-in", "in.s"],
        cwd=folder,
        capture_output=True,
        text=True,
        errors="replace",
        check=False,
    )


def order(folder: Path, step: int) -> list[int]:
    rows = (folder / f"d_{step}.dump").read_text().splitlines()[9:]
    return [int(row.split()[0]) for row in rows]


def table(folder: Path) -> list[str]:
    """Return the thermo lines of a log."""
    lines = (folder / "log.liggghts").read_text().splitlines()
    return [line for line in lines if len(line.split()) == 6 and line.split()[1].isdigit()]


def test_by_default_a_lost_grain_is_deleted_without_a_word(tmp_path):
    screen = io.StringIO()
    summary = run_script(written(tmp_path, four("")), root=tmp_path, screen=screen)
    assert (summary.steps, summary.particles, summary.lost) == (600, 2, 2)
    assert "WARNING" not in screen.getvalue()
    assert "ost" not in (tmp_path / "log.liggghts").read_text()
    assert order(tmp_path, 600) == [4, 2]  # the last one takes the place of the first


def test_error_stops_at_the_next_line_of_output_and_names_the_grain(tmp_path):
    with pytest.raises(SimulationError, match="particle 1: left the box at step 1") as caught:
        run_script(written(tmp_path, four("thermo_modify lost error\n")), root=tmp_path)
    assert (caught.value.step, caught.value.particle) == (150, 1)
    assert "0.05, 0.05, -" in str(caught.value)


def test_warning_comes_once_and_on_the_screen_only(tmp_path):
    screen = io.StringIO()
    script = written(tmp_path, four("thermo_modify lost warn\n"))
    run_script(script, root=tmp_path, screen=screen)
    said = [line for line in screen.getvalue().splitlines() if line.startswith("WARNING")]
    assert said == ["WARNING: Lost atoms: original 4 current 3"]
    assert "WARNING" not in (tmp_path / "log.liggghts").read_text()


def test_new_thermo_style_forgets_the_stop(tmp_path):
    text = four("thermo_modify lost error\nthermo_style custom step atoms\n")
    assert run_script(written(tmp_path, text), root=tmp_path).lost == 2


@pytest.mark.parametrize(("now", "lost", "stops"), [(4, 1, True), (3, 0, True), (5, 0, False)])
def test_hidden_losses_and_deletions_count_too(tmp_path, now, lost, stops):
    """A loss that an insertion makes up for; a decrease without a loss, as LIGGGHTS sees it."""
    world, watch = World(tmp_path), LossWatch()
    world.thermo.lost = "error"
    world.state.reserve(8)
    world.state.n = 4
    watch.start(world)
    assert watch.look(world) == ""
    if lost:
        world.lose(np.array([0]))
    world.state.n = now
    if not stops:
        assert watch.look(world) == ""
        return
    with pytest.raises(SimulationError, match="left the box" if lost else "none has left"):
        watch.look(world)


def test_order_of_those_left_is_that_of_liggghts(tmp_path):
    run_script(written(tmp_path, scattering()), root=tmp_path)
    assert {step: order(tmp_path, step) for step in LEFT} == LEFT


@pytest.mark.liggghts
def test_stored_order_is_that_of_liggghts(tmp_path):
    assert liggghts(tmp_path, scattering()).returncode == 0
    assert {step: order(tmp_path, step) for step in LEFT} == LEFT


@pytest.mark.liggghts
def test_losses_among_insertion_walls_and_counters_equal_those_of_liggghts(tmp_path):
    mine, theirs = tmp_path / "minidem", tmp_path / "liggghts"
    summary = run_script(written(mine, flowing()), root=mine)
    assert liggghts(theirs, flowing()).returncode == 0
    assert summary.lost > 100
    frames = sorted(path.name for path in theirs.glob("d_*.dump"))
    assert len(frames) == 21
    for name in frames:
        assert (mine / name).read_text() == (theirs / name).read_text(), name
    assert table(mine) == table(theirs)


@pytest.mark.liggghts
@pytest.mark.parametrize("lost", ["", "error", "warn", "ignore"])
def test_what_happens_is_what_happens_in_liggghts(tmp_path, lost):
    text = four(f"thermo_modify lost {lost}\n" if lost else "")
    there = liggghts(tmp_path / "liggghts", text)
    screen = io.StringIO()
    mine = tmp_path / "minidem"
    try:
        run_script(written(mine, text), root=mine, screen=screen)
        stopped = False
    except SimulationError:
        stopped = True
    assert stopped == (there.returncode != 0) == (lost == "error")
    assert ("WARNING: Lost atoms" in screen.getvalue()) == ("WARNING: Lost atoms" in there.stdout)
    frames = [
        {path.name for path in (tmp_path / name).glob("d_*")} for name in ("minidem", "liggghts")
    ]
    assert frames[0] == frames[1]


def test_run_goes_on_from_a_restart_after_a_loss(tmp_path):
    whole = tmp_path / "whole"
    run_script(written(whole, flowing()), root=whole)
    first = ("boundary", "region reg", "create_box")
    lines = flowing().replace("run 1200\nwrite_restart half\n", "").splitlines()
    text = "\n".join(line for line in lines if not line.startswith(first))
    text = text.replace("units si\n", "units si\nread_restart half\n")
    after = tmp_path / "after"
    script = written(after, text + "\n")
    shutil.copy(whole / "half", after)
    run_script(script, root=after)
    assert (after / "d_2000.dump").read_text() == (whole / "d_2000.dump").read_text()


def reused() -> str:
    """Return a script whose grain of the highest id leaves, or is deleted, before more come."""
    lines = [f"create_atoms 1 single {x} 0.05 0.01" for x in (0.02, 0.04, 0.06)]
    lines += [
        "set group all diameter 0.004 density 2500",
        "set atom 3 vz -1",
        "fix i all nve/sphere",
    ]
    lines += ["thermo_style custom step atoms", "dump d all custom 300 d_*.dump id x", "run 300"]
    lines += ["create_atoms 1 single 0.07 0.05 0.01", "set atom 3 diameter 0.004 density 2500"]
    lines += ["group one id 1", "delete_atoms group one compress no"]
    lines += ["create_atoms 1 single 0.08 0.05 0.01", "set atom 4 diameter 0.004 density 2500"]
    lines += ["group last id 4", "delete_atoms group last compress no"]
    lines += ["create_atoms 1 single 0.09 0.05 0.01", "set atom 4 diameter 0.004 density 2500"]
    return HEAD.format(skin=0.002, dt=1e-4) + "\n".join([*lines, "run 300", ""])


def test_the_next_grain_gets_the_id_above_the_highest_there_is(tmp_path):
    run_script(written(tmp_path, reused()), root=tmp_path)
    assert order(tmp_path, 300) == [1, 2]
    assert order(tmp_path, 600) == [3, 2, 4]


@pytest.mark.liggghts
def test_so_it_does_in_liggghts(tmp_path):
    mine, theirs = tmp_path / "minidem", tmp_path / "liggghts"
    run_script(written(mine, reused()), root=mine)
    assert liggghts(theirs, reused()).returncode == 0
    for name in ("d_300.dump", "d_600.dump"):
        assert (mine / name).read_text() == (theirs / name).read_text()
