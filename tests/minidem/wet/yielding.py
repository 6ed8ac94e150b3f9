"""What LIGGGHTS 3.8.0 keeps of contacts with ``thornton_ning``, over the lives of some contacts.

``tests/data/minidem/yielding.csv`` has a row per contact and step, with both ids;
``python -m tests.minidem.wet.yielding`` writes it anew.
"""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

from tests.minidem.engine.case_list import WEIGHT, ball
from tests.minidem.engine.cases import Case
from tests.minidem.wet.wet_list import WET_CASES
from tests.paths import DATA

STORED = DATA / "minidem" / "yielding.csv"
COLUMNS = 19  # ids and a flag, history of the normal force and of sliding, overlap
EVERY, STEPS = 25, 3000


PRESSED = (  # two that are far from the others, one of them moved to and fro
    ball(6, "0.05 -0.05 0.1") + ball(7, "0.05 -0.05 0.10985")
    + "set atom 7 type 2\ngroup moved id 7\ngroup held id 6\ngroup free subtract all moved held\n"
)  # fmt: skip
TO_AND_FRO = "fix integr free nve/sphere\nfix mv moved move wiggle 0 0 -0.000146 0.008"


def case() -> Case:
    """Return the script: some meet, yield and part; one is held again while it overlaps."""
    words = " ".join(f"c_c[{k}]" for k in range(1, COLUMNS + 1))
    lines = (
        "compute c all pair/gran/local id history delta\n"
        f"dump l all local {EVERY} l.dump {words}\n"
        f'dump_modify l format "{" ".join(["%.17g"] * COLUMNS)}"\n'
    )
    met = WET_CASES["thornton_ning"]
    body = met.body.replace(WEIGHT, PRESSED + WEIGHT)
    runs = f"{lines}run {STEPS}"
    return replace(met, body=body, integrator=TO_AND_FRO, runs=runs)


def history(folder: Path) -> np.ndarray:
    """Return step and columns of each contact in a dump, (n, 20), sorted by step and ids."""
    lines, at, found = (folder / "l.dump").read_text().splitlines(), 0, []
    while at < len(lines):
        step, count = lines[at + 1], int(lines[at + 3])
        found += [[step, *row.split()] for row in lines[at + 9 : at + 9 + count]]
        at += 9 + count
    rows = np.array(found, float)
    return rows[np.lexsort((rows[:, 2], rows[:, 1], rows[:, 0]))]


def of_liggghts(folder: Path) -> np.ndarray:
    """Return what LIGGGHTS tells."""
    script = case().write(folder)
    program = shutil.which("liggghts")
    if program is None:
        msg = "LIGGGHTS is not installed (Debian: apt-get install liggghts)"
        raise FileNotFoundError(msg)
    command = [program, "-in", script.name]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    return history(folder)


def main() -> None:
    """Write the stored numbers anew."""
    with tempfile.TemporaryDirectory() as folder:
        np.savetxt(STORED, of_liggghts(Path(folder)), fmt="%.17g", delimiter=",")


if __name__ == "__main__":
    main()
