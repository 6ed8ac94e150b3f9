"""The engine as a whole: same result every time, mistakes named, accidents noticed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from minidem import ScriptError, SimulationError, run_script
from minidem.cli import main
from tests.minidem.engine.cases import plate, stl_text
from tests.minidem.laws.law_scripts import RADIUS, Ball, Scene, run
from tests.paths import ROOT

BALLS = (
    Ball((0.0, 0.0, 0.0049)),
    Ball((0.0098, 0.0, 0.0049), (0.0, 0.1, 0.0)),
    Ball((0.0049, 0.0005, 0.0145), (0.0, 0.0, -0.2), (3.0, 0.0, 5.0)),
)
MODEL = "hertz tangential history rolling_friction epsd2"


def write(folder: Path, text: str) -> Path:
    path = folder / "in.script"
    path.write_text(text)
    return path


def test_same_script_gives_the_same_bits(tmp_path):
    tracks = []
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        tracks.append(run(Scene(BALLS, model=MODEL), tmp_path / name, 2000, 100))
    np.testing.assert_array_equal(tracks[0].x, tracks[1].x)
    np.testing.assert_array_equal(tracks[0].w, tracks[1].w)


def test_interpreted_kernels_give_the_same_bits(tmp_path):
    text = Scene(BALLS, model=MODEL).text(120, 40)
    outputs = []
    for name, flag in (("compiled", "0"), ("interpreted", "1")):
        folder = tmp_path / name
        folder.mkdir()
        write(folder, text)
        subprocess.run(
            [sys.executable, "-m", "minidem", "-in", "in.script", "-screen", "none"],
            cwd=folder,
            env={**os.environ, "NUMBA_DISABLE_JIT": flag, "PYTHONPATH": str(ROOT)},
            check=True,
            timeout=300,
        )
        outputs.append((folder / "out.dump").read_text())
    assert outputs[0] == outputs[1]


def test_run_in_two_parts_ends_near_the_whole(tmp_path):
    whole = Scene(BALLS, model=MODEL).text(2000, 2000)
    parts = whole.replace("run 2000\n", "run 1000\nrun 1000\n")
    ends = []
    for name, text in (("whole", whole), ("parts", parts)):
        folder = tmp_path / name
        folder.mkdir()
        run_script(write(folder, text), root=folder)
        rows = (folder / "out.dump").read_text().splitlines()[-3:]
        ends.append(np.array([[float(word) for word in row.split()] for row in rows])[:, 2:5])
    # a new run works out forces with full-step velocities, as LIGGGHTS does: a difference of
    # order dt, which the contacts carry on
    assert 0.0 < np.abs(ends[0] - ends[1]).max() < 5e-5


def test_particle_that_leaves_is_named(tmp_path):
    scene = Scene((Ball((0.0, 0.0, 0.45), (0.0, 0.0, 20.0)),))
    with pytest.raises(SimulationError, match="particle 1: left the box") as caught:
        run(scene, tmp_path, 4000)
    assert caught.value.particle == 1


def test_particle_that_leaves_may_be_ignored(tmp_path):
    text = Scene((Ball((0.0, 0.0, 0.45), (0.0, 0.0, 20.0)),)).text(4000, 4000)
    text = text.replace("lost error", "lost ignore")
    summary = run_script(write(tmp_path, text), root=tmp_path)
    assert (summary.particles, summary.lost) == (0, 1)


def test_explosion_is_noticed(tmp_path):
    balls = (Ball((0.0, 0.0, 0.1)), Ball((1e-4, 0.0, 0.1)))
    with pytest.raises(SimulationError, match=r"time step|skin|finite"):
        run(Scene(balls, dt=2e-3), tmp_path, 200)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("tangential history", "tangential histroy", "did you mean 'history'"),
        ("primitive type 2 zplane", "primitive type 2 zplain", "did you mean 'zplane'"),
        ("wall/gran", "wall/grann", "did you mean 'wall/gran'"),
        ("thermo_style custom step", "thermo_style custom stepp", "did you mean 'step'"),
        ("dump d all custom", "dump d all costum", "did you mean 'custom'"),
        ("vx vy vz omegax", "vx vy vz omegaxx", "did you mean 'omegax'"),
        ("peratomtype 5000000.0", "peratomtype 5000.0", "youngsModulus >= 5e"),
        ("poissonsRatio peratomtype 0.3", "poissonsRatio peratomtype 0.7", "0 <= poissonsRatio"),
        ("newton off", "newton on", "newton off"),
        ("primitive type 2", "primitive type 3", "wall type 3 is not between"),
        ("neigh_modify delay 0", "neigh_modify dellay 0", "did you mean 'delay'"),
        ("run 10", "run ten", "whole number"),
    ],
)
def test_mistake_is_named_with_its_line(tmp_path, old, new, message):
    text = Scene(BALLS[:1]).text(10, 10)
    assert old in text
    changed = text.replace(old, new, 1)
    line = next(i for i, row in enumerate(changed.splitlines(), 1) if new in row)
    with pytest.raises(ScriptError, match=message) as caught:
        run_script(write(tmp_path, changed), root=tmp_path)
    if message[:3] not in ("you", "0 <", "new"):  # limits are checked when the run starts
        assert caught.value.line == line
    assert not (tmp_path / "out.dump").exists() or old == "run 10"


def test_script_may_not_leave_its_folder(tmp_path):
    text = Scene(BALLS[:1], more=("fix m all mesh/surface file ../a.stl type 1",)).text(1, 1)
    with pytest.raises(ScriptError, match="leads out of the folder"):
        run_script(write(tmp_path, text), root=tmp_path)


def test_command_line_names_the_mistake_without_traceback(tmp_path, monkeypatch, capsys):
    write(tmp_path, "atom_style granular\nbondary f f f\n")
    monkeypatch.chdir(tmp_path)
    assert main(["-in", "in.script", "-screen", "none"]) == 2
    shown = capsys.readouterr().err
    assert "in.script:2" in shown
    assert "boundary" in shown


def start(folder: Path) -> subprocess.Popen:
    """Start the script of a folder in a process of its own."""
    return subprocess.Popen(
        [sys.executable, "-m", "minidem", "-in", "in.script", "-screen", "none"],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stderr=subprocess.PIPE,
    )


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_interruption_leaves_whole_dumps_and_a_restart_file(tmp_path, rng, number):
    """Stopped at a random time; going on from the restart file is going on."""
    script = Scene(BALLS, model=MODEL).text(50_000_000, 1000)
    write(tmp_path, script)
    process = start(tmp_path)
    dump = tmp_path / "out.dump"
    patience = time.monotonic() + 120.0
    while time.monotonic() < patience and (not dump.exists() or dump.stat().st_size < 4000):
        time.sleep(0.1)
    time.sleep(rng.uniform(0.0, 0.5))
    process.send_signal(number)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 130
    lines = dump.read_text().splitlines()
    assert len(lines) % (9 + len(BALLS)) == 0
    (restart,) = tmp_path.glob("restart_forced_liggghts_*.data")
    assert f"read_restart {restart.name}" in said.decode()
    assert not list(tmp_path.glob("*.part"))
    step = int(restart.stem.split("_")[-1])
    assert step >= int(lines[-len(BALLS) - 8])
    rest = script[script.index("neighbor") :].replace("out.dump", "more.dump")
    rest = "\n".join(line for line in rest.splitlines() if not line.startswith(("set", "create")))
    head = "atom_style granular\nread_restart " + restart.name + "\n"
    write(tmp_path, head + rest.replace("run 50000000", f"run {1000 - step % 1000}") + "\n")
    summary = run_script(tmp_path / "in.script", root=tmp_path)
    assert summary.steps == step + 1000 - step % 1000
    assert (tmp_path / "more.dump").read_text().count("ITEM: TIMESTEP") >= 1


def test_signal_between_runs_stops_the_script(tmp_path):
    write(tmp_path, 'variable a loop 900000\nlabel b\nprint "${a}"\nnext a\njump SELF b\n')
    process = start(tmp_path)
    log = tmp_path / "log.liggghts"
    patience = time.monotonic() + 120.0
    while time.monotonic() < patience and (not log.exists() or log.stat().st_size < 4000):
        time.sleep(0.05)
    process.send_signal(signal.SIGTERM)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 130
    assert b"interrupted after step 0; dumps written so far are complete\n" in said


def test_mesh_plate_equals_the_plane(tmp_path):
    corners = "-0.1 -0.1 0", "0.1 -0.1 0", "0.1 0.1 0", "-0.1 0.1 0"
    facets = [(0, 1, 2), (0, 2, 3)]
    rows = ["solid plate"]
    for facet in facets:
        rows += ["facet normal 0 0 1", "outer loop"]
        rows += [f"vertex {corners[k]}" for k in facet]
        rows += ["endloop", "endfacet"]
    (tmp_path / "mesh").mkdir()
    (tmp_path / "plane").mkdir()
    (tmp_path / "mesh" / "plate.stl").write_text("\n".join([*rows, "endsolid plate", ""]))
    # the ball rolls over the edge between the two facets, which must not be felt
    ball = Ball((-0.02, 0.01, RADIUS - 1e-5), (0.5, 0.2, 0.0))
    plane = run(Scene((ball,), model=MODEL), tmp_path / "plane", 8000, 500)
    wall = f"fix w all wall/gran model {MODEL} mesh n_meshes 1 meshes plate"
    more = ("fix plate all mesh/surface file plate.stl type 2", wall)
    mesh = run(Scene((ball,), model=MODEL, floor=False, more=more), tmp_path / "mesh", 8000, 500)
    # distances to a facet round differently; a face contact is otherwise the plane's
    np.testing.assert_allclose(mesh.x, plane.x, atol=1e-13)
    np.testing.assert_allclose(mesh.w, plane.w, rtol=1e-9, atol=1e-9)


SMALL_BOX = """atom_style granular
boundary m m m
newton off
communicate single vel yes
units si
region reg block -0.01 0.01 -0.01 0.01 0 0.01 units box
create_box 1 reg
neighbor 0.004 bin
fix m1 all property/global youngsModulus peratomtype 5e6
fix m2 all property/global poissonsRatio peratomtype 0.3
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.5
fix m4 all property/global coefficientFriction peratomtypepair 1 0.5
pair_style gran model hertz tangential history
pair_coeff * *
timestep 1e-5
fix low all mesh/surface file low.stl type 1
fix high all mesh/surface file high.stl type 1
fix pts all particletemplate/sphere 15485863 atom_type 1 density constant 2500 radius constant 0.004
fix pdd all particledistribution/discrete 32452843 1 pts 1.0
region fill block -0.04 0.04 -0.04 0.04 0.01 0.04 units box
fix ins all insert/pack seed 49979687 distributiontemplate pdd insert_every once &
    maxattempt 500 overlapcheck yes region fill volumefraction_region 0.1
fix integr all nve/sphere
run 1
"""


def test_a_region_is_filled_in_the_box_that_the_meshes_make(tmp_path):
    """The box grows over the meshes before the region is measured, which lies beyond it before."""
    for name, z in (("low", 0.0), ("high", 0.05)):
        (tmp_path / f"{name}.stl").write_text(stl_text(plate(z)))
    wanted = 0.1 * 0.08 * 0.08 * 0.03 / (4.0 / 3.0 * np.pi * 0.004**3)
    assert int(wanted) == 71
    # what LIGGGHTS 3.8.0 inserts; the rest, 0.6 of a particle, is dealt by lot
    assert run_script(write(tmp_path, SMALL_BOX), root=tmp_path).particles == 71


def test_frozen_particle_stays_and_counts_as_wall(tmp_path):
    balls = (Ball((0.0, 0.0, 0.1)), Ball((0.0, 0.0, 0.1 + 2.02 * RADIUS), (0.0, 0.0, -0.5)))
    scene = Scene(
        balls, floor=False, gravity=(0.0, 0.0, 0.0), restitution=0.8,
        more=("group held id 1", "fix hold held freeze"),
    )  # fmt: skip
    track = run(scene, tmp_path, 2000)
    np.testing.assert_array_equal(track.x[-1, 0], [0.0, 0.0, 0.1])
    # the effective mass is that of the free ball, so that it rebounds with the given restitution
    assert track.v[-1, 1, 2] == pytest.approx(0.4, rel=5e-3)


def test_added_and_set_forces(tmp_path):
    push = 1e-3
    balls = (Ball((0.0, 0.0, 0.2)), Ball((0.1, 0.0, 0.2)))
    scene = Scene(
        balls, floor=False, gravity=(0.0, 0.0, 0.0),
        more=(
            f"variable push equal {push}", "group one id 1", "group two id 2",
            "fix a one addforce v_push 0 0", f"fix s two setforce NULL {push} 0",
        ),
    )  # fmt: skip
    track = run(scene, tmp_path, 1000)
    mass = track.mass[0]
    expected = push / mass * 1000 * 1e-5
    assert track.v[-1, 0, 0] == pytest.approx(expected, rel=1e-12)
    assert track.v[-1, 1, 1] == pytest.approx(expected, rel=1e-12)


def test_truncated_mesh_names_the_line_that_reads_it(tmp_path):
    (tmp_path / "a.stl").write_text("solid a\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n")
    text = Scene(BALLS[:1], more=("fix m all mesh/surface file a.stl type 1",)).text(1, 1)
    line = next(i for i, row in enumerate(text.splitlines(), 1) if "a.stl" in row)
    with pytest.raises(ScriptError, match=r"a\.stl: ends within a facet") as caught:
        run_script(write(tmp_path, text), root=tmp_path)
    assert caught.value.line == line
