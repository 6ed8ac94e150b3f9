"""The restart part of the insert_stream tutorial on both engines.

LIGGGHTS does not continue exactly after ``read_restart``: it frees particles of a stream one step
early where the rounded time that is left falls below a whole number of steps, and it seeds the
random generator of the insertion face anew. minidem continues as if there had been no restart. With
these two habits of LIGGGHTS imitated here, both engines agree on, also after the next insertion.
"""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from minidem import run_script
from minidem.fixes.insert import Insert
from minidem.insertion.seeds import MESH_SEED
from minidem.insertion.stream import Stream
from tests.minidem.engine.cases import COLUMNS, read

DOC = Path("/usr/share/doc/liggghts/examples/LIGGGHTS/Tutorials_public/insert_stream")
DUMP = (
    f"dump traj all custom 2000 traj.dump {COLUMNS}\n"
    'dump_modify traj sort id format "%d %d ' + " ".join(["%.17g"] * 17) + '"\n'
)
INSERTION = 70000  # step of the first insertion after the restart
G, DT = 9.81, 1e-5


def prepared(folder: Path) -> None:
    """Copy the tutorial; the second part gets a dump with all digits and fewer steps."""
    shutil.copytree(DOC, folder)
    (folder / "post").mkdir(exist_ok=True)
    for script in folder.glob("in.*"):
        lines = [line for line in script.read_text().splitlines() if not line.startswith("dump")]
        text = "\n".join([*lines, ""])
        if script.name.endswith("timestep"):
            text = text.replace("run             50000", DUMP + "run 24000")
        script.write_text(text)


def imitate_restart_of_liggghts(monkeypatch) -> None:
    """Free particles early and seed the face anew, as LIGGGHTS does after read_restart."""
    apply_state, read = Stream.apply_state, Insert.read

    def reseeded(self, state):
        apply_state(self, state)
        self._mesh_random.reset(MESH_SEED)

    def shortened(world, head, words):
        found = read(world, head, words)
        now, state = world.step, world.state
        for row, flight in zip(state.row[: state.n], state.flight[: state.n], strict=True):
            if flight[4] > now:
                speed = np.linalg.norm(flight[5:8])
                pace = np.linalg.norm(row[:3] - flight[:3]) / (speed * (now - flight[3]))
                flight[4] = now + int(pace / world.dt * (flight[4] - now))
        return found

    monkeypatch.setattr(Stream, "apply_state", reseeded)
    monkeypatch.setattr(Insert, "read", shortened)


@pytest.mark.liggghts
@pytest.mark.slow
@pytest.mark.skipif(not DOC.is_dir(), reason="needs Debian's liggghts-doc")
def test_restart_part_agrees(tmp_path, monkeypatch):
    program = shutil.which("liggghts")
    assert program
    for name in ("minidem", "liggghts"):
        prepared(tmp_path / name)
    mine = tmp_path / "minidem"
    for script in ("in.insert_stream", "in.insert_stream_reset_timestep"):
        run_script(mine / script, root=mine)
        subprocess.run(
            [program, "-in", script], cwd=tmp_path / "liggghts", check=True, capture_output=True
        )
    theirs = read(tmp_path / "liggghts")
    exact = read(mine)
    early = [step for step in theirs.frames if step < INSERTION]
    assert len(early) > 5
    for step in early:
        found, wanted = exact.frames[step], theirs.frames[step]
        np.testing.assert_array_equal(found[:, :2], wanted[:, :2])
        # one step of free fall earlier, and the way it has made since the restart at step 50000
        passed = (step - 50000) * DT
        assert np.abs(found[:, 5:8] - wanted[:, 5:8]).max() < 1.1 * G * DT
        assert np.abs(found[:, 2:5] - wanted[:, 2:5]).max() < 1.1 * G * DT * passed + 3e-5
    (mine / "traj.dump").unlink()
    imitate_restart_of_liggghts(monkeypatch)
    run_script(mine / "in.insert_stream_reset_timestep", root=mine)
    imitated = read(mine)
    assert max(theirs.frames) > INSERTION
    for step, wanted in theirs.frames.items():
        found = imitated.frames[step]
        np.testing.assert_array_equal(found[:, :2], wanted[:, :2])
        # collisions of some thousand steps amplify the rounding
        np.testing.assert_allclose(found[:, 2:5], wanted[:, 2:5], rtol=0, atol=1e-6)
