"""How long `bulkcal status` takes: python benchmarks/listing.py --cases 100000.

Writes finished cases as a campaign leaves them (record, script, result; a failed one in ten), and
reads them with and without the index.
"""

from __future__ import annotations

import argparse
import random
import tempfile
import time
from pathlib import Path

from calibrate.runs.listing import INDEX
from calibrate.runs.status import Status, status_of
from liggghts_io import CaseResult, Failure
from liggghts_io.case.results import store_result

RECORD = '{"case_id": "%s", "inputs": {}}\n'
SCRIPT = 'print "bulkcal: case %s complete at step $(step)"\n' * 100
FAILED_ONE_IN = 10


def write_cases(root: Path, count: int, draw: random.Random) -> None:
    """Write finished cases of which only the files that matter here are real."""
    for _ in range(count):
        identity = f"{draw.getrandbits(256):064x}"
        path = root / identity
        path.mkdir()
        (path / "case.json").write_text(RECORD % identity)
        (path / "in.script").write_text(SCRIPT % ((identity[:16],) * 100))
        (path / "lock").touch()
        numbers, failed = {"angle_deg": draw.uniform(20.0, 40.0)}, draw.random() < 1 / FAILED_ONE_IN
        step = draw.randrange(100000)
        store_result(
            CaseResult(identity, path, "failed", f"step {step}: particle 3 is lost", {}, 6.0,
                       Failure.PHYSICS, "last words\n" * 20)
            if failed else CaseResult(identity, path, "ok", "", numbers, 6.0)
        )  # fmt: skip


def timed(what: str, root: Path) -> Status:
    """Read the status once and print a row."""
    began, used = time.perf_counter(), time.process_time()
    found = status_of(root)
    spent = time.perf_counter() - began
    print(f"| {what} | {spent:.1f} s | {time.process_time() - used:.1f} s |", flush=True)
    return found


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cases", type=int, default=100_000)
    parser.add_argument("--changed", type=int, default=100, help="results that change in between")
    chosen = parser.parse_args()
    draw = random.Random(1)
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        write_cases(root, chosen.cases, draw)
        print("| what | wall | CPU |\n|---|---|---|", flush=True)
        status = timed("first time, no index", root)
        timed("again", root)
        write_cases(root, chosen.changed, draw)
        timed(f"{chosen.changed} more runs later", root)
        size = (root / INDEX).stat().st_size
        (root / INDEX).write_bytes((root / INDEX).read_bytes()[: size // 2])
        timed("index cut in half", root)
        print(f"\n{status.done} done, {status.failures} failed; index of {size / 1e6:.0f} MB")


if __name__ == "__main__":
    main()
