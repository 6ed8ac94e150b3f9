"""A million grains for a thousand steps, with progress, and a restart that goes on bit for bit.

    python benchmarks/engine/size/million.py [--size 1000000] [--steps 1000] [--every 250]

The bed of `benchmarks.engine.size.beds`, side by side. The script writes a restart file every so
many steps and has two ``run`` commands; another process goes on from the file of the first one's
last step, and at the end all arrays of both are compared byte for byte. (Against one ``run`` over
all steps they differ by rounding, since a ``run`` makes its lists anew.) Prints particles, time,
the largest resident size of each process, and whether the two ends are the same.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

from benchmarks.engine.size.beds import HEAD, PHYSICS, arrays_of, repeat, settle
from benchmarks.engine.size.machine import described

MOST_GB = 8.0
CHILD = """
import json, sys, time
from pathlib import Path
from minidem import run_script
script = Path(sys.argv[1])
began = time.perf_counter()
def tell(step, last):
    print(f"  step {step} of {last} after {time.perf_counter() - began:.0f} s", file=sys.stderr)
done = run_script(script, root=script.parent, log=script.name + ".log", progress=tell)
status = Path("/proc/self/status").read_text()
print(json.dumps({"cpu": time.process_time(), "wall": time.perf_counter() - began,
                  "peak": int(status.split("VmHWM:")[1].split()[0]) * 1024}))
"""


def run(script: Path) -> dict[str, float]:
    """Run a script in a process of its own; return its times, s, and largest size, bytes."""
    child = [sys.executable, "-c", CHILD, str(script)]
    out = subprocess.run(child, stdout=subprocess.PIPE, text=True, check=True).stdout
    found: dict[str, float] = json.loads(out)
    return found


def differing(one: Path, other: Path) -> list[str]:
    """Return the names of the arrays that are not the same to the last bit."""
    mine, theirs = arrays_of(one), arrays_of(other)
    names = sorted(mine.keys() | theirs.keys())
    return [n for n in names if mine[n].tobytes() != theirs[n].tobytes()]


def main() -> int:
    """Run, go on, compare."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", type=int, default=1_000_000)
    parser.add_argument("--steps", type=int, default=1000)
    parser.add_argument("--every", type=int, default=250)
    args = parser.parse_args()
    print(described(), flush=True)
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        particles = repeat(settle(folder), folder / "start.npz", args.size)
        physics = PHYSICS.replace("LISTS", "every 50 check no")
        middle = args.steps - args.every
        (folder / "in.whole").write_text(
            f"{HEAD}read_restart start.npz\n{physics}restart {args.every} at.*.npz\n"
            f"run {middle}\nrun {args.every}\nwrite_restart whole.npz\n"
        )
        step = json.loads(arrays_of(folder / "start.npz")["meta"].tobytes())["step"]
        whole = run(folder / "in.whole")
        (folder / "in.rest").write_text(
            f"{HEAD}read_restart at.{step + middle}.npz\n{physics}run {args.every}\n"
            "write_restart rest.npz\n"
        )
        rest = run(folder / "in.rest")
        other = differing(folder / "whole.npz", folder / "rest.npz")
        size = (folder / "whole.npz").stat().st_size / 1e9
    work = particles * args.steps
    peak = max(whole["peak"], rest["peak"]) / 1e9
    print(
        f"{particles} particles, {args.steps} steps: {whole['cpu']:.0f} s CPU, "
        f"{whole['wall']:.0f} s wall, {whole['cpu'] / work * 1e9:.0f} ns per particle and step "
        f"with start and files; largest size {whole['peak'] / 1e9:.2f} GB, going on "
        f"{rest['peak'] / 1e9:.2f} GB (at most {MOST_GB:.0f}); a restart file {size:.2f} GB"
    )
    print(f"going on for {args.every} steps: " + (f"differs in {other}" if other else "same bits"))
    return int(bool(other) or peak > MOST_GB)


if __name__ == "__main__":
    sys.exit(main())
