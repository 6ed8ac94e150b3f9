"""The tests of this folder once more with kernels in plain Python: the compiler changes nothing."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.paths import ROOT

FOLDER = Path(__file__).parent
FILES = ("test_contact.py", "test_walls.py", "test_step.py")


@pytest.mark.long
@pytest.mark.skipif(
    os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0"), reason="kernels are interpreted"
)
def test_all_combinations_interpreted():
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider",
         *(str(FOLDER / name) for name in FILES)],
        cwd=ROOT, env={**os.environ, "NUMBA_DISABLE_JIT": "1"}, capture_output=True, text=True,
        check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout[-6000:]
