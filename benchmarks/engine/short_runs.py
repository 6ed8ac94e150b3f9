"""What a short run costs beyond its steps: runs of 300 steps with two grains, one after another.

    python benchmarks/engine/short_runs.py [--runs 95]

Once in one process by `minidem.run_script`, and once as a process each. Physics is the time that
the log gives for the steps; the rest is what must be small.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import median

from benchmarks.engine.size.machine import described
from minidem import run_script
from minidem.ship import SCRIPT

TWO = (
    SCRIPT[: SCRIPT.index("fix plate")]
    + """create_atoms 1 single 0 0 0.0011
create_atoms 1 single 0.0003 0 0.0032
set type 1 density 2500 diameter 0.002
fix integr all nve/sphere
thermo 100
run 300
"""
)
"""Grains on a floor; the physics is that of the script with which machine code is made."""


def _physics(folder: Path) -> float:
    """Return the seconds of the steps, from the log."""
    text = (folder / "log.liggghts").read_text()
    return float(re.findall(r"^Loop time of (\S+)", text, re.MULTILINE)[0])


def inside(folder: Path, runs: int) -> list[tuple[float, float]]:
    """Return CPU time and physics of every run of this process, s."""
    found = []
    for _ in range(runs):
        began = time.process_time()
        run_script(folder / "in.two", root=folder)
        found.append((time.process_time() - began, _physics(folder)))
    return found


def processes(folder: Path, runs: int) -> list[tuple[float, float]]:
    """Return CPU time and physics of runs that are a process each, s."""
    found = []
    command = [sys.executable, "-m", "minidem", "-in", "in.two"]
    # byte code is stored, as it is after an ordinary installation
    env = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    for _ in range(runs):
        before = os.times()
        subprocess.run(command, cwd=folder, stdout=subprocess.DEVNULL, check=True, env=env)
        after = os.times()
        spent = after.children_user + after.children_system
        spent -= before.children_user + before.children_system
        found.append((spent, _physics(folder)))
    return found


def main() -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=95)
    args = parser.parse_args()
    print(described() + "\n")
    print("| runs of 300 steps, two grains | least, CPU | median, CPU | of it steps |")
    print("|---|---|---|---|")
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        (folder / "in.two").write_text(TWO)
        for name, kind in (("in one process", inside), ("a process each", processes)):
            kind(folder, 1)  # loads, and compiles what is not there
            found = kind(folder, args.runs)
            spent = [cpu * 1e3 for cpu, _ in found]
            steps = median(physics * 1e3 for _, physics in found)
            print(
                f"| {args.runs} {name} | {min(spent):.1f} ms | {median(spent):.1f} ms "
                f"| {steps:.1f} ms |",
                flush=True,
            )
    return 0


if __name__ == "__main__":
    sys.exit(main())
