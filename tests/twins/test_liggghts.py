"""The twin itself against LIGGGHTS 3.8.0: the same scenes, without minidem's extensions."""

from __future__ import annotations

import subprocess
import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given

from tests.twins.compare import TOLERANCE, differences
from tests.twins.scene import Scene, stl_text
from tests.twins.slow.step import Outcome, Twin
from tests.twins.strategies import examples, scenes

pytestmark = pytest.mark.liggghts

COLUMNS = "id x y z vx vy vz omegax omegay omegaz fx fy fz tqx tqy tqz ix iy iz"
FORMS = " ".join(["%d", *["%.17g"] * 15, *["%d"] * 3])


def run_liggghts(scene: Scene) -> Outcome:
    """Return what LIGGGHTS makes of a scene; it does not tell histories and searches."""
    last = sum(scene.runs)
    output = (
        f"dump out all custom {max(last, 1)} out.dump {COLUMNS}",
        f'dump_modify out sort id first yes format "{FORMS}"',
    )
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for k, mesh in enumerate(scene.meshes):
            (folder / f"mesh{k}.stl").write_text(stl_text(mesh))
        (folder / "in.script").write_text(scene.script(output))
        done = subprocess.run(
            ["liggghts", "-in", "in.script"], cwd=folder, capture_output=True, check=False
        )
        assert done.returncode == 0, done.stdout.decode(errors="replace")[-2000:]
        rows = (folder / "out.dump").read_text().splitlines()[-len(scene.spheres) :]
    table = np.array([[float(word) for word in row.split()] for row in rows])
    x = table[:, 1:4] + table[:, 16:19] * 2.0 * np.array(scene.size)
    return Outcome(x, *(table[:, 3 * k + 1 : 3 * k + 4] for k in range(1, 5)), {}, {}, {})


@examples(25)
@given(scenes(extended=False, runs=((1,), (2,), (20,), (7, 13))))
def test_liggghts_and_the_twin_agree(scene: Scene):
    twin = Twin(scene)
    slow = twin.run()
    assume(not twin.undecided)
    found = run_liggghts(scene)
    slow.pairs, slow.primitives, slow.triangles, slow.builds = {}, {}, {}, 0
    apart = differences(scene, found, slow)
    worst = {name: value for name, value in apart.items() if not value <= TOLERANCE}
    assert not worst, f"{worst}\n{scene.script()}"
