"""Scripts that no one would write: python benchmarks/fuzz.py --cases 100000.

Every case is a valid script with some changes, or lines of random words; the words are those of
minidem's own tables. Beside it lie files that are cut, flipped or claim contents they do not have.
Printed is each case that does not end in time with exit code 0 or 2, without a traceback, within
2 GB and within its folder. ``--show SEED --out FOLDER`` writes one case down. Exit code 1 when
there is any fault. Kernels are interpreted, so that no contact model has to be compiled.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

os.environ.setdefault("NUMBA_DISABLE_JIT", "1")
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from tests.minidem.fuzz.arena import judge, judged, lay_out
from tests.minidem.fuzz.writer import sample


def main() -> int:
    """Run the cases and print what was found."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0, help="of the first case; the next is one up")
    parser.add_argument("--minutes", type=float, default=float("inf"), help="stop after so long")
    parser.add_argument("--show", type=int, metavar="SEED", help="write one case down")
    parser.add_argument("--out", type=Path, default=Path("fuzzed"), help="folder for --show")
    chosen, started = parser.parse_args(), time.monotonic()
    if chosen.show is not None:
        case = sample(chosen.show)
        print(judge(chosen.out, case) or "no fault", case.arguments)
        lay_out(chosen.out, case)
        return 0
    kinds: Counter[str] = Counter()
    count = 0
    with tempfile.TemporaryDirectory(prefix="fuzz") as folder:
        for seed, fault in judged(range(chosen.seed, chosen.seed + chosen.cases), Path(folder)):
            count += 1
            if fault:
                kinds[fault] += 1
                print(f"FAULT, case {seed}: {fault}", flush=True)
            if (time.monotonic() - started) / 60.0 > chosen.minutes:
                break
    minutes = (time.monotonic() - started) / 60.0
    print(f"{count} cases, {kinds.total()} faults of {len(kinds)} kinds, {minutes:.0f} min")
    return int(bool(kinds))


if __name__ == "__main__":
    sys.exit(main())
