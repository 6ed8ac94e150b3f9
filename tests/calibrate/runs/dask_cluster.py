"""A Dask cluster of real processes, and runs that are counted where they happen."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from liggghts_io import CaseResult, CaseSpec, case_id, load_result, stored_result, write_case
from liggghts_io.case.lock import locked
from liggghts_io.case.results import store_result
from tests.paths import ROOT

STARTS, SLOW_S = "starts.txt", 0.3


def execute(spec: CaseSpec, root: Path) -> CaseResult:
    """Run a case as `liggghts_io.execute` does, on an engine that takes a moment and counts."""
    identity = case_id(spec)
    with locked(root / identity):
        if (root / identity / "result.json").exists():
            return load_result(root / identity)
        with (root / STARTS).open("a", encoding="utf-8") as file:
            file.write(f"{spec.seed} {os.getpid()}\n")
        write_case_here(spec, root / identity)
        time.sleep(SLOW_S)
        numbers = {"angle_deg": 30.0 + spec.seed / 100.0}
        return store_result(CaseResult(identity, root / identity, "ok", "", numbers, SLOW_S))


def write_case_here(spec: CaseSpec, directory: Path) -> None:
    """Write the record of a case whose lock is held, by way of another directory."""
    other = write_case(spec, directory.with_name(f".{directory.name}"))
    for name in ("case.json", "in.script"):
        (other / name).rename(directory / name)


def stored(spec: CaseSpec, root: Path) -> CaseResult | None:
    """Return the stored result of a case, or None."""
    return stored_result(root, case_id(spec))


def starts(root: Path) -> list[tuple[int, int]]:
    """Return seed and process of every start of the engine, in order."""
    file = root / STARTS
    lines = file.read_text().splitlines() if file.exists() else []
    return [(int(line.split()[0]), int(line.split()[1])) for line in lines]


def wait_until(true: Callable[[], bool], limit_s: float = 60.0) -> None:
    """Wait for something to happen."""
    deadline = time.monotonic() + limit_s
    while not true():
        assert time.monotonic() < deadline, "it did not happen in time"
        time.sleep(0.02)


def free_port() -> int:
    """Return a port that nobody uses just now."""
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return int(one.getsockname()[1])


class Cluster:
    """A scheduler and its workers, each a process as a user would start it.

    Parameters
    ----------
    port : int
    """

    def __init__(self, port: int) -> None:
        self.port = port
        self.name = f"dask://127.0.0.1:{port}"
        self.processes: list[subprocess.Popen[bytes]] = []

    def __enter__(self) -> Cluster:
        """Return the cluster; all its processes are killed at the end of the block."""
        return self

    def __exit__(self, *_: object) -> None:
        """Kill every process that was started."""
        for process in self.processes:
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()

    def start(self, workers: int) -> None:
        """Start a scheduler and its workers."""
        scheduler = self._start(
            "scheduler", "--host", "127.0.0.1", "--port", str(self.port), "--no-dashboard"
        )
        self.processes = [scheduler, *self.processes]
        for _ in range(workers):
            self.add_worker()

    def add_worker(self) -> None:
        """Start a worker of one thread."""
        address = f"127.0.0.1:{self.port}"
        words = ("--nthreads", "1", "--no-dashboard", "--memory-limit", "0")
        self.processes.append(self._start("worker", address, *words))

    @property
    def scheduler(self) -> subprocess.Popen[bytes]:
        """The process of the scheduler that was started last."""
        return self.processes[0]

    def _start(self, what: str, *words: str) -> subprocess.Popen[bytes]:
        return subprocess.Popen(
            [sys.executable, "-m", f"distributed.cli.dask_{what}", *words],
            env={**os.environ, "PYTHONPATH": str(ROOT)},
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
        )  # fmt: skip
