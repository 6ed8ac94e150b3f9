"""Runs of cases in processes of their own, which a test can stop and kill."""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import time
from pathlib import Path

from tests.paths import ROOT

_PATIENCE_S = 60.0
_RUN = """
import pickle, sys
from pathlib import Path
from liggghts_io import run_case
result = run_case(Path(sys.argv[1]), tell=lambda line: print(line, file=sys.stderr, flush=True))
sys.stdout.buffer.write(pickle.dumps(result))
"""
_HOLD = """
import sys, time
from pathlib import Path
from liggghts_io.case.lock import locked
with locked(Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(600)
"""


def _start(code: str, directory: Path) -> subprocess.Popen[bytes]:
    return subprocess.Popen(
        [sys.executable, "-c", code, str(directory)], cwd=ROOT,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip


def start_run(directory: Path) -> subprocess.Popen[bytes]:
    """Run a case in a process of its own."""
    return _start(_RUN, directory)


def start_holder(directory: Path) -> subprocess.Popen[bytes]:
    """Hold the lock of a case in a process of its own; return when it is held."""
    process = _start(_HOLD, directory)
    assert process.stdout is not None
    assert process.stdout.readline() == b"held\n"
    return process


def result_of(process: subprocess.Popen[bytes]):
    """Return the result of a run and what it said."""
    out, said = process.communicate(timeout=_PATIENCE_S)
    assert process.returncode == 0, said.decode()
    return pickle.loads(out), said.decode()


def wait_for(condition, what: str):
    """Wait until a function returns something true, and return that."""
    end = time.monotonic() + _PATIENCE_S
    while time.monotonic() < end:
        found = condition()
        if found:
            return found
        time.sleep(0.002)
    raise AssertionError(what)


def kill(process: subprocess.Popen[bytes]) -> None:
    """Kill a process with SIGKILL, so that it can clean nothing."""
    process.send_signal(signal.SIGKILL)
    process.communicate(timeout=_PATIENCE_S)


def kill_in_the_middle(directory: Path, frames: int = 3) -> None:
    """Start a run and kill it when it has written some frames."""
    process = start_run(directory)
    wait_for(lambda: len(list(directory.glob("attempt-*/post/*"))) >= frames, "no frames")
    kill(process)


def alive(words: str) -> bool:
    """Return whether a process runs whose working directory is `words`."""
    for link in Path("/proc").glob("[0-9]*/cwd"):
        try:
            if str(link.readlink()).startswith(words) and link.parent.name != str(os.getpid()):
                return True
        except OSError:
            continue
    return False
