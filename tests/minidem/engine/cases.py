"""Small scripts for both engines, one per rule of LIGGGHTS that is easily got wrong.

What LIGGGHTS 3.8.0 makes of them is stored in ``tests/data/minidem``; after a change of a case,
``python -m tests.minidem.engine.cases`` runs LIGGGHTS again and writes the files.
"""

from __future__ import annotations

import json
import math
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

import numpy as np

from tests.paths import DATA

STORED = DATA / "minidem" / "engine_cases.json"
STORED_MODELS = DATA / "minidem" / "model_cases.json"
STORED_WET = DATA / "minidem" / "wet_cases.json"
COLUMNS = "id type x y z vx vy vz fx fy fz omegax omegay omegaz tqx tqy tqz radius mass"
QUANTITIES = {
    "position": slice(2, 5),
    "velocity": slice(5, 8),
    "force": slice(8, 11),
    "spin": slice(11, 14),
    "torque": slice(14, 17),
    "radius": slice(17, 18),
    "mass": slice(18, 19),
}
MOST = 12
"""Particles of a frame that are stored, about."""

Triangle = tuple[tuple[float, float, float], ...]


@dataclass(frozen=True)
class Case:
    """A script with its meshes.

    Attributes
    ----------
    body : str
        Lines between the contact model and the integrator.
    steps : int
        Steps of the last run.
    thermo : str
        Thermo columns after the step.
    meshes : mapping
        File name to triangles.
    boundary, model, skin : str, str, float
        As in the script.
    runs : str
        Lines instead of a single run.
    files : mapping
        File name to text.
    integrator : str
        Line that moves the particles.
    rtol : float
        Of the largest value of a quantity. Both programs round differently where sums have
        another order, and contacts amplify that.
    """

    body: str
    steps: int = 2000
    thermo: str = "atoms ke"
    meshes: Mapping[str, Sequence[Triangle]] = field(default_factory=dict)
    boundary: str = "f f f"
    model: str = "hertz tangential history"
    skin: float = 0.002
    runs: str = ""
    rtol: float = 1e-10
    files: Mapping[str, str] = field(default_factory=dict)
    integrator: str = "fix integr all nve/sphere"

    def script(self) -> str:
        """Return the whole script."""
        every = max(1, self.steps // 2)
        pairs = {
            "coefficientRestitution": 0.5, "coefficientFriction": 0.4,
            "coefficientRollingFriction": 0.1, "cohesionEnergyDensity": 2e4,
            "coefficientRollingViscousDamping": 0.3,
        }  # fmt: skip
        lines = [
            "atom_style granular", "atom_modify map array sort 0 0", f"boundary {self.boundary}",
            "newton off", "communicate single vel yes", "units si",
            "region reg block -0.1 0.1 -0.1 0.1 -0.1 0.2 units box", "create_box 2 reg",
            f"neighbor {self.skin} bin", "neigh_modify delay 0",
            "fix m1 all property/global youngsModulus peratomtype 5e6 5e6",
            "fix m2 all property/global poissonsRatio peratomtype 0.3 0.3",
            *(
                f"fix p{k} all property/global {name} peratomtypepair 2 {v} {v} {v} {v}"
                for k, (name, v) in enumerate(pairs.items())
            ),
            f"pair_style gran model {self.model}", "pair_coeff * *", "timestep 1e-5",
            *(line.strip() for line in self.body.strip().splitlines()),
            self.integrator, f"thermo_style custom step {self.thermo}",
            f"thermo {every}", "thermo_modify lost ignore norm no format float %.16g",
            f"dump traj all custom {every} traj.dump {COLUMNS}",
            'dump_modify traj sort id format "%d %d ' + " ".join(["%.17g"] * 17) + '"',
            *(self.runs or f"run {self.steps}").strip().splitlines(),
        ]  # fmt: skip
        return "\n".join([*lines, ""])

    def write(self, folder: Path) -> Path:
        """Write script and meshes into a folder; return the script."""
        folder.mkdir(parents=True, exist_ok=True)
        for name, triangles in self.meshes.items():
            (folder / name).write_text(stl_text(triangles))
        for name, text in self.files.items():
            (folder / name).write_text(text)
        script = folder / "in.script"
        script.write_text(self.script())
        return script


@dataclass(frozen=True)
class Outcome:
    """What a run printed: rows of particles by step, thermo lines by step."""

    frames: dict[int, np.ndarray]
    thermo: dict[int, list[float]]


def stl_text(triangles: Sequence[Triangle]) -> str:
    """Return triangles as an ASCII STL file."""
    rows = ["solid m"]
    for triangle in triangles:
        rows += ["facet normal 0 0 1", "outer loop"]
        rows += ["vertex " + " ".join(f"{c:.17g}" for c in point) for point in triangle]
        rows += ["endloop", "endfacet"]
    return "\n".join([*rows, "endsolid m", ""])


def plate(z: float = 0.0, half: float = 0.05, cells: int = 1) -> list[Triangle]:
    """Return a horizontal square of triangles."""
    at = np.linspace(-half, half, cells + 1)
    found: list[Triangle] = []
    for x0, x1 in pairwise(at):
        for y0, y1 in pairwise(at):
            a, b, c, d = (x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)
            found += [(a, b, c), (a, c, d)]
    return found


def pipe(radius: float, length: float, sides: int) -> list[Triangle]:
    """Return a faceted cylinder along z."""
    angle = [2.0 * math.pi * k / sides for k in range(sides + 1)]
    ring = [(radius * math.cos(a), radius * math.sin(a)) for a in angle[:-1]]
    ring.append(ring[0])
    found: list[Triangle] = []
    for (x0, y0), (x1, y1) in pairwise(ring):
        a, b = (x0, y0, 0.0), (x1, y1, 0.0)
        c, d = (x1, y1, length), (x0, y0, length)
        found += [(a, b, c), (a, c, d)]
    return found


def read(folder: Path) -> Outcome:
    """Read what a run printed."""
    lines = (folder / "traj.dump").read_text().splitlines()
    frames: dict[int, np.ndarray] = {}
    at = 0
    while at < len(lines):
        count = int(lines[at + 3])
        rows = [[float(word) for word in row.split()] for row in lines[at + 9 : at + 9 + count]]
        frames[int(lines[at + 1])] = np.array(rows).reshape(count, 19)
        at += 9 + count
    thermo: dict[int, list[float]] = {}
    columns = 0
    for line in (folder / "log.liggghts").read_text(errors="replace").splitlines():
        words = line.split()
        if words[:1] == ["Step"]:
            columns = len(words)
        elif words[:1] == ["Loop"]:  # of the run; commands print below it
            columns = 0
        elif columns and len(words) == columns and words[0].isdigit():
            thermo[int(words[0])] = [float(word) for word in words[1:]]
    return Outcome(frames, thermo)


def run_liggghts(case: Case, folder: Path) -> Outcome:
    """Run a case with the installed program."""
    program = shutil.which("liggghts")
    if program is None:
        msg = "LIGGGHTS is not installed (Debian: apt-get install liggghts)"
        raise FileNotFoundError(msg)
    script = case.write(folder)
    subprocess.run([program, "-in", script.name], cwd=folder, check=True, capture_output=True)
    return read(folder)


def load(path: Path = STORED) -> dict[str, Outcome]:
    """Return the stored outcomes by name."""
    return outcomes(path.read_text())


def outcomes(text: str | bytes) -> dict[str, Outcome]:
    """Return the outcomes of a stored text by name."""
    stored = json.loads(text)
    return {
        name: Outcome(
            {int(step): np.array(rows).reshape(-1, 19) for step, rows in found["frames"].items()},
            {int(step): row for step, row in found["thermo"].items()},
        )
        for name, found in stored.items()
    }


def thinned(outcome: Outcome) -> dict[str, dict[str, list]]:
    """Return what is stored: some of many particles, and the thermo lines, which hold them all."""
    frames = {step: rows[:: 1 + len(rows) // MOST] for step, rows in outcome.frames.items()}
    return {
        "frames": {str(step): rows.tolist() for step, rows in frames.items()},
        "thermo": {str(step): row for step, row in outcome.thermo.items()},
    }


def store(cases: Mapping[str, Case], path: Path) -> None:
    """Run cases with LIGGGHTS and store what they print after the first frame."""
    found = {}
    for name, case in cases.items():
        with tempfile.TemporaryDirectory() as folder:
            outcome = run_liggghts(case, Path(folder))
        frames = dict(list(outcome.frames.items())[1:]) or outcome.frames
        found[name] = thinned(Outcome(frames, outcome.thermo))
        sys.stdout.write(f"{name}\n")
    text = json.dumps(found, indent=0).replace("\n", " ").replace('"frames"', '\n"frames"')
    path.write_text(text + "\n")


def main(words: Sequence[str]) -> None:
    """Run all cases with LIGGGHTS and store them, or those named only: ``models``, ``wet``."""
    from tests.minidem.engine.case_list import CASES
    from tests.minidem.laws.model_list import MODEL_CASES
    from tests.minidem.wet.wet_list import WET_CASES

    known = {
        "engine": (CASES, STORED), "models": (MODEL_CASES, STORED_MODELS),
        "wet": (WET_CASES, STORED_WET),
    }  # fmt: skip
    for word in words or known:
        store(*known[word])


if __name__ == "__main__":
    main(sys.argv[1:])
