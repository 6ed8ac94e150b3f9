"""Cost per particle and step, and memory per particle, from 1000 to 500 000 particles.

    python benchmarks/engine/engine_scaling.py [--sizes 1000 10000 100000 500000] [--threads 1]

A bed of 1000 grains, 20 layers deep and periodic to the sides, is settled and then repeated side
by side, so that every size has the same structure. Lists are made anew every 50 steps, as often as
in a pile that flows. Times are CPU seconds of the fastest stretch; memory is the largest
resident size of the process, start and file reading included. The bandwidth of the machine is that
of a copy of 400 MB in the same run, and says how far the steps of the largest bed are from it.
"""

from __future__ import annotations

import argparse
import itertools
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from benchmarks.engine.size.beds import COUNT, HEAD, PHYSICS, arrays_of, repeat, settle
from benchmarks.engine.size.machine import described

STRETCH = 4_000_000  # particle-steps between two looks at the clock, as the engine breathes
CHILD = """
import json, sys, time
from pathlib import Path
from minidem import run_script
seen = []
root = Path(sys.argv[1])
done = run_script(root / "in.run", root=root, threads=int(sys.argv[2]),
                  progress=lambda step, last: seen.append((step, time.process_time(), time.time())))
status = Path("/proc/self/status").read_text()  # getrusage would count the parent's memory
peak = int(status.split("VmHWM:")[1].split()[0]) * 1024
print(json.dumps({"seen": seen, "peak": peak, "particles": done.particles}))
"""


def measure(folder: Path, size: int, threads: int) -> tuple[int, float, float]:
    """Return particles, ns per particle and step, and bytes per particle."""
    work = folder / f"n{size}"
    work.mkdir()
    particles = repeat(folder / "bed.npz", work / "bed.npz", size)
    stretch = max(100, STRETCH // particles)
    physics = PHYSICS.replace("LISTS", "every 50 check no")
    text = HEAD + "read_restart bed.npz\n" + physics + f"run 50\nrun {3 * stretch}\n"
    (work / "in.run").write_text(text)
    child = [sys.executable, "-c", CHILD, str(work), str(threads)]
    found = json.loads(subprocess.run(child, capture_output=True, text=True, check=True).stdout)
    # wall time says what threads are worth, CPU time what one thread costs on a busy machine
    clock = 1 if threads == 1 else 2
    looks = found["seen"][1:]
    cost = min((b[clock] - a[clock]) / (b[0] - a[0]) for a, b in itertools.pairwise(looks))
    return particles, cost / particles * 1e9, found["peak"] / particles


def traffic(bed: Path) -> float:
    """Return the bytes per particle that a step at least reads and writes beyond the caches.

    Both passes over the particles (move; contacts) load position, spin and force and store what
    they change; the pass over the pairs loads neighbour and flag of every entry and loads and
    stores its history.
    """
    arrays = arrays_of(bed)
    entries = len(arrays["pairs_other"]) / COUNT
    history = arrays["pairs_hist"].itemsize * arrays["pairs_hist"].shape[1]
    row, spin, force, held = 64, 32, 64, 24
    move = 2 * (row + spin + force) + held
    contacts = row + spin + 2 * force
    return float(move + contacts + entries * (4 + 1 + 2 * history))


def copy_bandwidth() -> float:
    """Return what a copy moves, read and written, in bytes per second: the best of five."""
    source = np.ones(50_000_000)
    target = np.zeros_like(source)
    best = np.inf
    for _ in range(5):
        started = time.perf_counter()
        np.copyto(target, source)
        best = min(best, time.perf_counter() - started)
    return float(2 * source.nbytes / best)


def main() -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sizes", type=int, nargs="*", default=[1000, 10_000, 100_000, 500_000])
    parser.add_argument("--threads", type=int, default=1)
    args = parser.parse_args()
    print(described() + "\n")
    print("| particles | ns per particle and step | of the value at 10k | bytes per particle |")
    print("|---|---|---|---|")
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        settle(folder)
        rows = [measure(folder, size, args.threads) for size in args.sizes]
        least = traffic(folder / "bed.npz")
    base = next((cost for n, cost, _ in rows if n == 10_000), rows[0][1])
    for n, cost, size in rows:
        print(f"| {n} | {cost:.1f} | {cost / base:.2f} | {size:.0f} |")
    copy, largest = copy_bandwidth(), rows[-1]
    print(
        f"\nA step moves at least {least:.0f} bytes per particle; a copy moves {copy / 1e9:.1f} "
        "GB/s, "
        f"so that it could take {least / copy * 1e9:.0f} ns: "
        f"{least / copy * 1e9 / largest[1]:.0%} of what it takes with {largest[0]} particles."
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
