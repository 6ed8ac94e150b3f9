"""Scripts nobody here wrote: the tutorials of Debian's liggghts-doc, on both engines.

The scripts run unmodified but for their length: the n-th ``run`` command gets the number of steps
below. LIGGGHTS sorts its particles in space now and then, which changes the order in which contact
forces are added; so the last digits differ, and after many collisions more than these. The lengths
are such that this has not grown yet.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
import pyvista

from minidem import run_script
from minidem.world.mesh.stl import numbered_triangles

DOC = Path("/usr/share/doc/liggghts/examples/LIGGGHTS/Tutorials_public")
# Eleven digits are in the files and in the table; collisions amplify rounding.
POSITION_M = 2e-8
THERMO = 2e-5


@dataclass(frozen=True)
class Tutorial:
    """A tutorial cut short."""

    script: str
    steps: tuple[int, ...]


TUTORIALS = [
    Tutorial("contactModels/in.newModels", (800, 1)),
    Tutorial("cohesion/in.cohesion", (1, 1600, 1)),
    Tutorial("cohesion/in.noCohesion", (1, 1600, 1)),
    Tutorial("hysteresis/in.noHysteresis", (1, 1600, 1)),
    Tutorial("hysteresis/in.hysteresis", (1, 1600, 1)),
    Tutorial("conveyor/in.conveyor", (1, 12000)),
    Tutorial("meshGran/in.meshGran", (3000, 1)),
    Tutorial("movingMeshGran/in.movingMeshGran", (1000, 1, 1, 200, 200)),
    Tutorial("insert_stream/in.insert_stream", (1, 3000)),
    Tutorial("packing/in.packing", (1, 2400, 200)),
    Tutorial("chute_wear/in.chute_wear", (1, 4000)),
]


def shortened(text: str, tutorial: Tutorial) -> str:
    """Return the script with the given numbers of steps."""
    steps = iter(tutorial.steps)
    return re.sub(r"^run\b.*", lambda line: f"run {next(steps)}", text, flags=re.MULTILINE)


def thermo(log: Path) -> dict[int, list[float]]:
    """Return the rows of the thermo tables by step."""
    rows: dict[int, list[float]] = {}
    columns = 0
    for line in log.read_text().splitlines():
        words = line.split()
        if words[:1] == ["Step"]:
            columns = len(words)
        elif columns and len(words) == columns and words[0].isdigit():
            rows[int(words[0])] = [float(word) for word in words]
    return rows


@pytest.mark.liggghts
@pytest.mark.slow
@pytest.mark.skipif(not DOC.is_dir(), reason="needs Debian's liggghts-doc")
@pytest.mark.parametrize("tutorial", TUTORIALS, ids=lambda t: t.script.split("/in.")[1])
def test_tutorial_agrees(tmp_path, tutorial):
    folder, script = tutorial.script.split("/")
    program = shutil.which("liggghts")
    assert program
    for engine in ("minidem", "liggghts"):
        shutil.copytree(DOC / folder, tmp_path / engine)
        for packed in (tmp_path / engine).rglob("*.gz"):
            subprocess.run(["gunzip", "-f", packed], check=True)
        (tmp_path / engine / "post").mkdir(exist_ok=True)
        path = tmp_path / engine / script
        path.write_text(shortened(path.read_text(errors="replace"), tutorial))
    run_script(tmp_path / "minidem" / script, root=tmp_path / "minidem")
    subprocess.run(
        [program, "-in", script], cwd=tmp_path / "liggghts", check=True, capture_output=True
    )
    mine, theirs = (
        thermo(tmp_path / "minidem/log.liggghts"),
        thermo(tmp_path / "liggghts/log.liggghts"),
    )
    assert list(mine) == list(theirs)
    assert max(mine) >= 800
    for step in mine:
        np.testing.assert_allclose(mine[step], theirs[step], rtol=THERMO, err_msg=f"step {step}")
    compare_dumps(tmp_path / "minidem" / "post", tmp_path / "liggghts" / "post")


def compare_dumps(mine: Path, theirs: Path) -> None:
    """Compare all files two runs dumped: names, particles by id, meshes."""
    names = dumped(theirs)
    assert names
    assert dumped(mine) == names
    for name in names:
        if name.endswith(".stl"):
            # Nodes of moving meshes are rounded to six digits.
            np.testing.assert_allclose(
                numbered_triangles(mine / name)[0],
                numbered_triangles(theirs / name)[0],
                rtol=1e-5,
                atol=1e-12,
            )
        elif "boundingBox" in name or "POINTS 0 " in (theirs / name).read_text():
            assert (mine / name).read_text() == (theirs / name).read_text(), name
        else:
            compare_values(mine / name, theirs / name)


def dumped(folder: Path) -> list[str]:
    """Return the names of the dumps in a folder; restart files differ by format."""
    return sorted(path.name for path in folder.iterdir() if path.suffix in (".vtk", ".stl"))


def compare_values(mine: Path, theirs: Path) -> None:
    """Compare two VTK files: values of triangles, or particles."""
    a, b = pyvista.read(mine), pyvista.read(theirs)
    if not b.cell_data:
        compare_particles(mine, theirs)
        return
    assert list(a.cell_data) == list(b.cell_data)
    for name, values in b.cell_data.items():
        np.testing.assert_allclose(
            a.cell_data[name], values, rtol=0, atol=THERMO * np.abs(values).max(), err_msg=name
        )


def compare_particles(mine: Path, theirs: Path) -> None:
    """Compare the particles of two VTK files by id."""
    a, b = pyvista.read(mine), pyvista.read(theirs)
    assert a.n_points == b.n_points, mine.name
    if a.n_points == 0:
        return
    i, j = np.argsort(a["id"]), np.argsort(b["id"])
    np.testing.assert_array_equal(a["id"][i], b["id"][j])
    np.testing.assert_array_equal(a["type"][i], b["type"][j])
    np.testing.assert_array_equal(a["radius"][i], b["radius"][j])
    np.testing.assert_allclose(a.points[i], b.points[j], rtol=0, atol=POSITION_M, err_msg=mine.name)
