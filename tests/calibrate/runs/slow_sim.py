"""The stand-in with the accidents of real runs: slow cases, failures, dying processes.

The seed says what happens: see `execute`. Lives in a module of its own so that worker processes
can import it.
"""

from __future__ import annotations

import errno
import os
import signal
import time
from pathlib import Path

from liggghts_io import CaseError, CaseResult, CaseSpec, Failure
from tests.calibrate import stand_in

FAILS, STUMBLES, ALWAYS_DIES, DIES_ONCE, IMPOSSIBLE, DISK_FULL = 901, 902, 903, 904, 905, 906
SLOW_S = 0.15


def execute(spec: CaseSpec, root: Path) -> CaseResult:
    """Run the stand-in slowly, or have the accident that the seed stands for."""
    name = stand_in.case_id(spec)
    if spec.seed == FAILS:
        reason = "step 12: particle 3 is lost"
        return CaseResult(name, root / name, "failed", reason, {}, 0.1, Failure.PHYSICS, "the log")
    if spec.seed == STUMBLES:
        msg = "an index that nobody foresaw"
        raise IndexError(msg)
    if spec.seed == DISK_FULL:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    if spec.seed == IMPOSSIBLE:
        msg = "parameters: mu_pp = -1 outside 0 to 1000"
        raise CaseError(msg)
    if spec.seed in (ALWAYS_DIES, DIES_ONCE):
        mark = root / f"died_{spec.seed}"
        if spec.seed == ALWAYS_DIES or not mark.exists():
            mark.touch()
            os.kill(os.getpid(), signal.SIGKILL)
    if not (root / name / "result.json").exists():
        time.sleep(SLOW_S)
        with (root / "ran.txt").open("a", encoding="utf-8") as file:
            file.write(f"{spec.seed}\n")
    return stand_in.execute(spec, root)
