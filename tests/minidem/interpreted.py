"""minidem with interpreted kernels, in a process of its own.

A model of pairs that no other test needs takes half a minute to compile; as plain Python the same
lines run at once, and some grains for some thousand steps take seconds. What the compiler makes of
every model and setting, `tests/twins` compares in a few models that have them all.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from tests.paths import ROOT

ENVIRONMENT = {"NUMBA_DISABLE_JIT": "1", "PYTHONPATH": str(ROOT)}


def run_interpreted(script: Path, *, threads: int = 1) -> None:
    """Run a script in its folder; interpreted, one thread does the work of all."""
    subprocess.run(
        [sys.executable, "-m", "minidem", "-in", script.name, "-threads", str(threads)],
        cwd=script.parent, env=os.environ | ENVIRONMENT, stdout=subprocess.DEVNULL, check=True,
    )  # fmt: skip
