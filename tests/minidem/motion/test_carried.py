"""Particles that the script carries: restart files, output, threads."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from minidem import DemError, run_script
from tests.minidem.engine import cases as engine_cases
from tests.minidem.engine.case_list import WEIGHT
from tests.minidem.motion.carried_cases import CASES

LAST = 2000


@pytest.mark.parametrize("name", ["move rotate", "move wiggle", "move variable"])
def test_a_restart_file_goes_on_bit_for_bit(tmp_path, name):
    case = CASES[name]
    script = case.write(tmp_path).read_text()
    half = script.replace(f"run {LAST}", f"run {LAST // 2}\nwrite_restart half.restart")
    (tmp_path / "first.script").write_text(half)
    run_script(tmp_path / "first.script", root=tmp_path)
    box, rest = script.split("create_box 2 reg\n")
    later = box.replace("region reg", "#") + "read_restart half.restart\n" + "\n".join(
        line for line in rest.splitlines() if not line.startswith(("create_atoms", "set ", "group"))
    )  # fmt: skip
    (tmp_path / "second.script").write_text(later.replace(f"run {LAST}", f"run {LAST // 2}"))
    run_script(tmp_path / "second.script", root=tmp_path)
    again = engine_cases.read(tmp_path).frames[LAST]
    # new lists at the beginning of a run are made in both, and histories depend on them
    two = half.replace("write_restart half.restart", f"run {LAST // 2}")
    (tmp_path / "whole.script").write_text(two)
    run_script(tmp_path / "whole.script", root=tmp_path)
    whole = engine_cases.read(tmp_path).frames[LAST]
    np.testing.assert_array_equal(again, whole)


def test_where_the_motion_began_is_output(tmp_path):
    script = CASES["move linear"].write(tmp_path).read_text()
    script = script.replace(
        "dump traj", "dump o all custom 1000 o_*.txt id f_mv[1] f_mv[3]\ndump traj"
    )
    (tmp_path / "in.script").write_text(script)
    run_script(tmp_path / "in.script", root=tmp_path)
    rows = np.loadtxt(tmp_path / "o_1000.txt", skiprows=9)
    rows = rows[np.argsort(rows[:, 0])]
    np.testing.assert_allclose(rows[:, 1], [0.0, 0.0, 0.0, 0.02])
    np.testing.assert_allclose(rows[:, 2], [0.00499, 0.0, 0.0, 0.0039])


def test_a_motion_behind_an_integrator_of_its_particles_is_refused(tmp_path):
    lines = CASES["move nowhere and nve/sphere"].write(tmp_path).read_text().splitlines()
    motion = next(line for line in lines if line.startswith("fix mv"))
    lines.remove(motion)
    lines.insert(lines.index("fix integr all nve/sphere") + 1, motion)
    (tmp_path / "in.script").write_text("\n".join(lines))
    with pytest.raises(DemError, match="would move twice a step"):
        run_script(tmp_path / "in.script", root=tmp_path)


def test_a_box_that_changes_goes_on_where_nothing_is_set_up(tmp_path):
    # LIGGGHTS lets it jump to the beginning of the run before.
    whole = replace(CASES["deform vel and erate"], runs="run 100\nrun 100\n", steps=100)
    script = whole.write(tmp_path / "whole")
    run_script(script, root=script.parent)
    other = replace(whole, runs="run 100\nrun 100 pre no\n").write(tmp_path / "other")
    run_script(other, root=other.parent)
    log = (other.parent / "log.liggghts").read_text()
    assert "fix def (deform) begins with every run" in log
    wanted = engine_cases.read(script.parent).frames
    for step, frame in engine_cases.read(other.parent).frames.items():
        np.testing.assert_array_equal(frame, wanted[step])


def test_grains_that_join_a_group_too_late_are_told(tmp_path):
    script = CASES["spring/self of particles that join"].write(tmp_path)
    run_script(script, root=tmp_path)
    log = (tmp_path / "log.liggghts").read_text()
    assert "particle 2, one of 1, came into the group behind it" in log


def test_grains_that_jump_with_the_step_are_told(tmp_path):
    script = CASES["move wiggle and reset_timestep"].write(tmp_path)
    run_script(script, root=tmp_path)
    log = (tmp_path / "log.liggghts").read_text()
    assert "fix mv (move) goes on counting from step 0; as in LIGGGHTS its particles jump" in log


WEIGHT_LATER = """fix lift all buoyancy level 0.05 dim z density 500
variable w equal 3+step
fix g all gravity v_w vector 0 0 -1
"""


def test_buoyancy_before_a_gravity_that_varies_is_refused(tmp_path):
    body = CASES["spring/self of particles that join"].body.replace(WEIGHT, "")
    script = replace(CASES["run_time"], body=body + WEIGHT_LATER, runs="run 1\n").write(tmp_path)
    with pytest.raises(DemError, match="give fix gravity before fix buoyancy"):
        run_script(script, root=tmp_path)


def test_no_drift_that_is_taken_away_changes_nothing(tmp_path):
    plain = replace(CASES["move linear"], runs="run 50\n", steps=50)
    one = plain.write(tmp_path / "one")
    run_script(one, root=one.parent)
    idle = replace(plain, body=plain.body + "fix idle all momentum 3 linear 0 0 0\n")
    two = idle.write(tmp_path / "two")
    run_script(two, root=two.parent)
    found, wanted = (engine_cases.read(path.parent).frames for path in (two, one))
    np.testing.assert_array_equal(found[50], wanted[50])
