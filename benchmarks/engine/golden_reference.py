"""Reference trajectories of LIGGGHTS: python benchmarks/engine/golden_reference.py FOLDER ...

Each folder holds ``in.case`` and the files that it reads. LIGGGHTS 3.8.0 runs it in a scratch
folder; ``ref.csv`` gets at most a dozen of the dumped steps.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import tempfile
from pathlib import Path

DUMP = "traj.dump"
MOST = 12
HEADER_LINES = 9


def frames(text: str) -> dict[int, list[str]]:
    """Return the rows of a dump by step."""
    lines = text.splitlines()
    found: dict[int, list[str]] = {}
    at = 0
    while at < len(lines):
        count = int(lines[at + 3])
        found[int(lines[at + 1])] = lines[at + HEADER_LINES :][:count]
        at += HEADER_LINES + count
    return found


def make(case: Path) -> None:
    """Write the reference of a case."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch) / "case"
        shutil.copytree(case, folder)
        done = subprocess.run(
            ["stdbuf", "-oL", "liggghts", "-in", "in.case"], cwd=folder, check=False,
            capture_output=True, text=True,
        )  # fmt: skip
        if done.returncode or "ERROR" in done.stdout:
            raise SystemExit(done.stdout[-2000:] + done.stderr[-500:])
        text = (folder / DUMP).read_text()
    found = frames(text)
    columns = text.splitlines()[HEADER_LINES - 1].split()[2:]
    steps = sorted(found)
    kept = [steps[round(k * (len(steps) - 1) / (MOST - 1))] for k in range(MOST)]
    lines = [",".join(["step", *columns])]
    lines += [
        ",".join([str(step), *row.split()]) for step in dict.fromkeys(kept) for row in found[step]
    ]
    (case / "ref.csv").write_text("\n".join(lines) + "\n")
    print(case, len(lines) - 1, "rows")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, nargs="+")
    for one in parser.parse_args().folder:
        make(one)
