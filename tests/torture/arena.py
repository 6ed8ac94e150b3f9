"""Where campaigns are tormented: start them, find their processes, see what they left."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
import uuid
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tests.paths import ROOT
from tests.torture.program import STARTS

MARK = "TORTURE_ARENA"
LIMIT_S = 600.0
"""No campaign here takes that long, not on a busy machine that has kernels to compile either."""
GONE_S = 20.0
"""So long a process may live on after its campaign was killed."""

Table = list[dict[str, Any]]


@dataclass(frozen=True)
class Ended:
    """How a campaign ended.

    Attributes
    ----------
    code : int
        Exit code, negative for a signal.
    table : list of dict or None
        Rows of runs, None when it did not get that far.
    said : str
        What it wrote to stderr.
    """

    code: int
    table: Table | None
    said: str


@dataclass
class Arena:
    """A directory of runs and the campaigns in it.

    Attributes
    ----------
    out : Path
        Directory of the result.
    side : Path
        Directory for what campaigns say and for the log of engine starts.
    engine : str
    cases, workers : int
    mark : str
        Found in the environment of every process of this arena.
    """

    out: Path
    side: Path
    engine: str
    cases: int
    workers: int = 2
    mark: str = field(default_factory=lambda: uuid.uuid4().hex)

    @property
    def runs(self) -> Path:
        """Directory of the case directories."""
        return self.out / "runs"

    @property
    def _log(self) -> Path:
        return self.side / f"{self.mark}.starts"

    def words(self) -> list[str]:
        """Return the command line of a campaign."""
        numbers = [str(self.cases), str(self.workers)]
        program = [sys.executable, "-m", "tests.torture.program"]
        return [*program, str(self.out), self.engine, *numbers]

    def table_of(self, shown: str) -> Table:
        """Return what a campaign found that came to its end and showed this."""
        return list(json.loads(shown.splitlines()[-1]))

    def starts(self) -> int:
        """Return how often an engine was started so far."""
        return len(self._log.read_text().splitlines()) if self._log.exists() else 0

    def finished(self) -> dict[Path, tuple[bytes, int]]:
        """Return the stored results with their time of writing."""
        return {
            path: (path.read_bytes(), path.stat().st_mtime_ns)
            for path in self.runs.glob("*/result.json")
        }

    def busy(self) -> bool:
        """Return whether more is left to do than the runs that may be ending just now."""
        return len(self.finished()) < self.cases - self.workers

    def start(self) -> Running:
        """Start a campaign and return at once."""
        name = uuid.uuid4().hex
        files = [self.side / f"{name}.{end}" for end in ("out", "err")]
        with files[0].open("wb") as out, files[1].open("wb") as err:
            process = subprocess.Popen(
                self.words(),
                stdout=out, stderr=err, stdin=subprocess.DEVNULL, cwd=ROOT, start_new_session=True,
                env={**os.environ, STARTS: str(self._log), MARK: self.mark},
            )  # fmt: skip
        return Running(process, files[0], files[1], self.table_of)

    def finish(self) -> Ended:
        """Let a campaign run undisturbed to its end."""
        return self.start().ended()

    def processes(self, kind: str = "") -> list[int]:
        """Return the living processes of all campaigns here: worker, engine, campaign or any."""
        found = []
        for entry in Path("/proc").iterdir():
            if entry.name.isdigit():
                with suppress(OSError):
                    marked = f"{MARK}={self.mark}".encode() in (entry / "environ").read_bytes()
                    if marked and kind in ("", kind_of((entry / "cmdline").read_bytes())):
                        found.append(int(entry.name))
        return found

    def wait(self, condition: Callable[[], bool], limit_s: float) -> bool:
        """Wait until a condition holds; False when it does not in time."""
        deadline = time.monotonic() + limit_s
        while not condition():
            if time.monotonic() > deadline:
                return False
            time.sleep(0.02)
        return True

    def orphans(self) -> list[int]:
        """Return processes that live on although no campaign is there, after some patience."""
        self.wait(lambda: not self.processes(), GONE_S)
        return self.processes()


@dataclass(frozen=True)
class Running:
    """A campaign under way.

    Attributes
    ----------
    process : Popen
    out, err : Path
        What it writes.
    table_of : callable
        Reads the table of runs from what it showed.
    """

    process: subprocess.Popen[bytes]
    out: Path
    err: Path
    table_of: Callable[[str], Table]

    def send(self, number: signal.Signals) -> bool:
        """Send a signal; False when the campaign has ended already."""
        lives = self.process.poll() is None
        if lives:
            self.process.send_signal(number)
        return lives

    def ended(self) -> Ended:
        """Wait for the end."""
        try:
            code = self.process.wait(LIMIT_S)
        except subprocess.TimeoutExpired:
            self.process.kill()
            code = self.process.wait()
            self.err.write_text(self.err.read_text() + "\ntorture: the campaign hung")
        table = self.table_of(self.out.read_text(encoding="utf-8")) if code == 0 else None
        said = self.err.read_text(encoding="utf-8", errors="replace")
        self.out.unlink()
        self.err.unlink()
        return Ended(code, table, said)


def hear_ctrl_c() -> None:
    """Let campaigns hear Ctrl-C also where this process does not.

    A shell lets what it starts in the background ignore it, and children inherit that.
    """
    signal.signal(signal.SIGINT, signal.default_int_handler)


def kind_of(command: bytes) -> str:
    """Return what a process of a campaign is, by its command line."""
    words = command.split(b"\0")
    if Path(words[0].decode()).name.startswith("liggghts"):
        return "engine"
    if b"spawn_main" in command:
        return "worker"
    other = b"resource_tracker" in command or b"-h" in words
    return "other" if other else "campaign"
