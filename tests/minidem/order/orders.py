"""Scripts whose output shows in which order LIGGGHTS 3.8.0 holds its particles.

``python -m tests.minidem.order.orders`` runs LIGGGHTS and writes ``tests/data/minidem/order.json``.
"""

from __future__ import annotations

import json
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path

from tests.paths import DATA

STORED = DATA / "minidem" / "order.json"

_SETTINGS = """\
units si
atom_style granular
atom_modify map array {sort}
boundary {boundary}
newton off
communicate single vel yes
region b block 0 0.05 0 0.04 0 0.08 units box
create_box 2 b
neighbor {skin} bin
neigh_modify delay 0 {near}
fix m1 all property/global youngsModulus peratomtype 5e6 5e6
fix m2 all property/global poissonsRatio peratomtype 0.3 0.3
fix m3 all property/global coefficientRestitution peratomtypepair 2 0.5 0.5 0.5 0.5
fix m4 all property/global coefficientFriction peratomtypepair 2 0.5 0.5 0.5 0.5
pair_style gran model hertz tangential history
pair_coeff * *
timestep 1e-5
fix grav all gravity 9.81 vector 0 0 -1
fix zw all wall/gran model hertz tangential history primitive type 1 zplane 0.0
fix one all particletemplate/sphere 15485863 atom_type 1 density constant 2500 &
    radius constant 0.0025
fix two all particletemplate/sphere 15485867 atom_type 2 density constant 2500 &
    radius constant 0.0034
fix both all particledistribution/discrete 32452843 2 one 0.5 two 0.5
region in block 0.005 0.045 0.005 0.035 0.04 0.07 units box
fix ins all insert/rate/region seed 49979687 distributiontemplate both vel constant 0. 0. -0.9 &
    nparticles 150 particlerate 6000 insert_every 200 overlapcheck yes all_in yes region in
fix move all nve/sphere
dump d all custom 700 d_*.dump id type x y z
dump_modify d format "%d %d %.15g %.15g %.15g"
region cut block 0.02 0.03 INF INF INF INF units box
region low block INF INF INF INF INF 0.006 units box
"""


def _script(
    lines: str, sort: str = "", boundary: str = "f f f", near: str = "", skin: float = 0.001
) -> str:
    return _SETTINGS.format(sort=sort, boundary=boundary, near=near, skin=skin) + lines


_PLASTIC = """\
fix e1 all property/global coefficientAdhesionStiffness peratomtypepair 2 0.2 0.2 0.2 0.2
fix e2 all property/global UnloadingStiffness peratomtypepair 2 5 5 5 5
fix e3 all property/global adhesionExponent scalar 1.5
fix e4 all property/global overlapExponent scalar 1.5
fix e5 all property/global pullOffForce peratomtypepair 2 0 0 0 0
fix e6 all property/global surfaceEnergy peratomtypepair 2 0.5 0.5 0.5 0.5
pair_style gran"""


def _plastic(lines: str, settings: str = "", boundary: str = "f f f", sort: str = "") -> str:
    """Return a script whose contacts remember how far they were loaded."""
    script = _script(lines, sort=sort, boundary=boundary).replace("pair_style gran", _PLASTIC)
    script = script.replace("model hertz tangential history primitive", "model edinburgh primitive")
    return script.replace("model hertz", "model edinburgh").replace(
        "tangential history\npair_coeff", f"tangential history {settings}\npair_coeff"
    )


CASES: dict[str, str] = {
    # grains leave over the open sides, and the order of those that stay changes with each of them
    "as usual": _script("run 4900\n"),
    "bins of one's own": _script("run 2800\n", sort="sort 300 0.006"),
    "periodic": _script("run 2800\n", boundary="p p f"),
    "faces that move": _script("run 2800\n", boundary="m m fm"),
    "lists at fixed steps": _script("run 2800\n", near="every 7 check no"),
    "grains that are held": _script(
        "run 3500\ngroup low region low\nfix held low freeze\nrun 1400\n", near="one 200 page 20000"
    ),
    # bins follow skin and radii; those of two held grains do not count
    "a wide skin": _script("run 2800\n", skin=0.004),
    "a large grain that is held": _script(
        "create_atoms 2 single 0.025 0.02 0.01 units box\nset type 2 diameter 0.012 density 2500\n"
        "group large type 2\nfix held large freeze\nrun 2800\n"
    ),
    # other ids, under which contacts are sought
    "some go": _script("run 4200\ndelete_atoms region cut\nrun 1400\n"),
    "some go and ids stay": _script("run 4200\ndelete_atoms region cut compress no\nrun 1400\n"),
    "some go by chance": _script("run 4200\ndelete_atoms porosity low 0.3 12345787\nrun 1400\n"),
    "some go that are near": _script(
        "run 4200\ndelete_atoms overlap 0.0059 all all\nrun 1400\n",
        near="contact_distance_factor 1.2",
    ),
    "none goes and ids change": _script("run 4200\ndelete_atoms region none\nrun 1400\n").replace(
        "region cut block 0.02 0.03", "region none block 0.06 0.07"
    ),
    # contacts that begin anew where two change their order
    "plastic": _plastic("run 4900\n"),
    # first sorted where many touch, some through the faces
    "plastic, periodic": _plastic(
        "run 5700\n", "fixKc on", boundary="p p f", sort="sort 5400 0"
    ).replace("block 0 0.05 0 0.04", "block 0.005 0.045 0.005 0.035"),
    "plastic, of a fixed adhesion": _plastic("run 4900\n", "fixKc on"),
    # the last fill the places of those that go: they are asked then, and find their partners
    "plastic, some go and are not sorted": _plastic(
        "run 4200\ndelete_atoms region cut\nrun 1400\n", sort="sort 0 0"
    ),
    "plastic, some go": _plastic("run 4200\ndelete_atoms region cut\nrun 1400\n"),
    "plastic, some go and ids stay": _plastic(
        "run 4200\ndelete_atoms region cut compress no\nrun 1400\n"
    ),
}
"""By what is special about them."""

Snapshot = tuple[list[int], list[float]]


def snapshots(script: str, execute: Callable[[Path], None]) -> dict[str, Snapshot]:
    """Return ids in their order, and sums of squares of places along x, y and z, by snapshot."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "in.order").write_text(script)
        execute(folder / "in.order")
        dumps = sorted(folder.glob("d_*.dump"), key=lambda path: int(path.stem[2:]))
        return {path.stem[2:]: _read(path) for path in dumps}


def _read(path: Path) -> Snapshot:
    rows = [line.split() for line in path.read_text().splitlines()[9:]]
    ids = [int(row[0]) for row in rows]
    # each grain counts by its id, so that two that change places are told
    sums = [sum(int(row[0]) * float(row[c]) for row in rows) for c in (2, 3, 4)]
    return ids, sums


def liggghts(script: Path) -> None:
    """Run LIGGGHTS beside a script."""
    subprocess.run(
        ["liggghts", "-in", script.name], cwd=script.parent, check=True, capture_output=True
    )


if __name__ == "__main__":
    found = {name: snapshots(script, liggghts) for name, script in CASES.items()}
    STORED.write_text(json.dumps(found) + "\n")
