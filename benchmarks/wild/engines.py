"""One engine, one script, some seconds: what it printed and how it ended."""

from __future__ import annotations

import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

MINIDEM: Final = (sys.executable, "-u", "-m", "minidem")
_SCREEN: Final = "screen-of-the-engine.txt"
_MOST_BYTES: Final = 100_000_000
"""Size of one file that a script may write."""
_MOST_MEMORY: Final = 12_000_000_000
_POLL_S: Final = 0.2
_SHOWN: Final = 160
_PATIENCE: Final = 30
"""Wall-clock time that a process may take over processor time."""
_CRASHES: Final = tuple(-s for s in (signal.SIGSEGV, signal.SIGBUS, signal.SIGFPE, signal.SIGILL))
_FEW: Final = 100
"""Steps after which an error no longer means that an engine does not take the script."""
_NOTES: Final = ("INFO", "WARNING", "ERROR", "thermo", "fix", "print", "#", '"')
"""Beginnings of lines that name the step and are no head of a table: notes, and a script's echo."""
_COMPILES: Final = "minidem: compiling for this processor"
_TIMES: Final = slice(11, 13)
"""Where user and system time stand in /proc/PID/stat after the name of the program."""


@dataclass
class Outcome:
    """How an engine ended.

    Attributes
    ----------
    code : int or None
        Exit code, None where its time was over.
    message : str
        Its error, '' for none.
    tables : list of list of dict
        Thermo output: for each run its lines, by column.
    """

    code: int | None
    message: str
    tables: list[list[dict[str, float]]] = field(default_factory=list)

    @property
    def steps(self) -> int:
        """Return how many steps lie between first and last line of a table, at most."""
        spans = [int(table[-1]["Step"] - table[0]["Step"]) for table in self.tables if table]
        return max(spans, default=0)

    @property
    def verdict(self) -> str:
        """Return runs, refuses, slow or fails."""
        if self.code in _CRASHES:
            return "fails"
        if self.steps >= (_FEW if self.message else 1) or (self.code == 0 and not self.message):
            return "runs"
        if self.code is None:
            return "runs" if any(self.tables) else "slow"
        if "a fault of minidem" in self.message:
            return "fails"
        return "refuses"


def thermo(text: str) -> list[list[dict[str, float]]]:
    """Return the tables of thermo output on a screen, wherever in its lines the step stands."""
    tables: list[list[dict[str, float]]] = []
    columns: list[str] = []
    for line in text.splitlines():
        words = line.split()
        if "Step" in words and not words[0].startswith(_NOTES):
            columns = words
            tables.append([])
        elif columns and len(words) == len(columns):
            try:
                tables[-1].append(dict(zip(columns, map(float, words), strict=True)))
            except ValueError:
                columns = []
        elif line.startswith("Loop time"):
            columns = []
    return tables


def _limits() -> None:
    resource.setrlimit(resource.RLIMIT_FSIZE, (_MOST_BYTES, _MOST_BYTES))
    resource.setrlimit(resource.RLIMIT_AS, (_MOST_MEMORY, _MOST_MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def _error(text: str) -> str:
    """Return the first error that an engine printed."""
    for line in text.splitlines():
        if line.startswith(("ERROR", "minidem: ")) and not line.startswith(_COMPILES):
            return line[:_SHOWN].strip()
    return ""


def run(
    command: Sequence[str], script: str, folder: Path, seconds: float,
    enough: Callable[[str], bool] | None = None,
) -> Outcome:  # fmt: skip
    """Run a script; stop it after some seconds, or when its screen is enough.

    Parameters
    ----------
    command : sequence of str
        The engine, without its arguments.
    script : str
        Script relative to the folder.
    folder : Path
        Where the engine is started.
    seconds : float
        Processor time that it may take, s; the machine may be busy with other things.
    enough : callable, optional
        Asked of the screen so far whether to stop.
    """
    screen = folder / _SCREEN
    with screen.open("wb") as file:
        process = subprocess.Popen(
            [*command, "-in", script], cwd=folder, stdout=file, stderr=subprocess.STDOUT,
            stdin=subprocess.DEVNULL, start_new_session=True, preexec_fn=_limits,
        )  # fmt: skip
        end = time.monotonic() + _PATIENCE * seconds
        code = process.poll()
        while code is None and time.monotonic() < end and _used(process.pid) < seconds:
            time.sleep(_POLL_S)
            code = process.poll()
            if code is None and enough and enough(_read(screen)):
                break
        if code is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
    text = _read(screen)
    message = _error(text)
    if code and not message:
        message = f"ended with code {code}: {text.strip().splitlines()[-1:]}"[:_SHOWN]
    return Outcome(code, message, thermo(text))


def _used(pid: int) -> float:
    """Return the processor time that a process has taken, s."""
    try:
        text = Path(f"/proc/{pid}/stat").read_text(encoding="ascii", errors="replace")
    except OSError:
        return 0.0
    return sum(map(int, text.rpartition(")")[2].split()[_TIMES])) / os.sysconf("SC_CLK_TCK")


def _read(screen: Path) -> str:
    return screen.read_text(encoding="utf-8", errors="replace")
