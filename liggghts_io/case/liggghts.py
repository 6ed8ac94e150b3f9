"""Run LIGGGHTS as a child process: follow its steps, and find out why it ended."""

from __future__ import annotations

import ctypes
import functools
import os
import re
import selectors
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import IO, Final

from liggghts_io.case.failure import EngineStopped, Failure, out_of_time
from liggghts_io.case.mark import thermo_step
from liggghts_io.errors import CaseError

ASSUMED: Final = "LIGGGHTS-PUBLIC 3.8.0"
"""Version in the id of a case where LIGGGHTS is not installed."""
LIGGGHTS: Final = "liggghts"
SCREEN: Final = "screen.txt"

_LIMIT_S: Final = 6 * 3600.0
_LOOK_S: Final = 0.2  # how often to look at the disk and the clock
_LEAST_FREE: Final = 16384  # bytes; with less, a page may already have been lost
_ASK_S: Final = 60.0
_ASK_TIMES: Final = 3
_SIGNAL_BASE: Final = 128  # exit code of a shell whose command was killed, minus the signal
_PR_SET_PDEATHSIG: Final = 1  # from <linux/prctl.h>
_READ: Final = 65536
_NO_MEMORY: Final = re.compile(r"Failed to (re)?allocate \d+ bytes")


def find_liggghts() -> str | None:
    """Return the LIGGGHTS program, from BULKCAL_LIGGGHTS or the search path."""
    return os.environ.get("BULKCAL_LIGGGHTS") or shutil.which("liggghts")


@functools.cache
def liggghts_version(program: str | None) -> str:
    """Return the version that a LIGGGHTS program says it has, asked once per process.

    Where there is none the version is the one this package is tested with, so that a case can be
    described there; `run` compares it with the program it finds.
    """
    if program is None:
        return ASSUMED
    found = re.search(r"Version ([^,)]+)", _help_of(program))
    if found is None:
        msg = f"{program}: 'liggghts -h' names no version; mend BULKCAL_LIGGGHTS"
        raise CaseError(msg)
    return found[1].strip()


def _help_of(program: str) -> str:
    """Return what ``liggghts -h`` shows; asked again when it was killed, as short of memory."""
    for _ in range(_ASK_TIMES):
        try:
            done = subprocess.run(
                [program, "-h", "-log", "none"], stdin=subprocess.DEVNULL, capture_output=True,
                timeout=_ASK_S, check=False,
            )  # fmt: skip
        except (OSError, subprocess.TimeoutExpired) as err:
            msg = f"{program}: cannot be run ({err}); install LIGGGHTS or mend BULKCAL_LIGGGHTS"
            raise CaseError(msg) from err
        if done.returncode >= 0:
            break
    return done.stdout.decode("utf-8", errors="replace")


def run_liggghts(
    folder: Path,
    script: str,
    total: int | None,
    progress: Callable[[int, int], None] | None = None,
    limit_s: float | None = None,
) -> None:
    """Run a script with LIGGGHTS in a folder; what it shows goes to `screen.txt` there.

    Parameters
    ----------
    folder : Path
    script : str
        File name in the folder.
    total : int, optional
        Most steps that the script asks for; None where it does not tell, and no progress is shown.
    progress : callable, optional
        Called with the step of every line of the thermo table, and the steps in all.
    limit_s : float, optional
        Wall-clock time after which it is killed, with all that it started [s]; default six hours.

    Raises
    ------
    EngineStopped
        If LIGGGHTS ended with an error, was killed, ran out of time or of disk.
    CaseError
        If it is not installed.
    """
    program = find_liggghts()
    if program is None:
        msg = "liggghts not found: install it (Debian package liggghts) or set BULKCAL_LIGGGHTS"
        raise CaseError(msg)
    # Line-buffered output, or the message of an error on one process is lost; never
    # '-screen none', which crashes 3.8.0 when a mesh is read.
    line_buffered = ["stdbuf", "-oL"] if shutil.which("stdbuf") else []
    errors: list[str] = []

    def see(line: str) -> None:
        if "ERROR" in line:
            errors.append(line.strip())
        step = thermo_step(line)
        if step is not None and progress is not None and total is not None:
            progress(min(step, total), total)

    with (
        (folder / SCREEN).open("wb") as screen,
        subprocess.Popen(
            [*line_buffered, program, "-in", script], cwd=folder, stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, preexec_fn=_die_with_parent(),
            process_group=0,  # of its own, so that what a wrapper such as mpirun starts ends too
        ) as child,
    ):  # fmt: skip
        try:
            _follow(child, folder, screen, see, limit_s or _LIMIT_S)
            code = child.wait()
        except BaseException:
            with suppress(ProcessLookupError):
                os.killpg(child.pid, signal.SIGKILL)
            raise
    _judge(code, errors)


def _die_with_parent() -> Callable[[], None] | None:
    """Return what a child does first so that it ends with this process, where Linux offers it."""
    if not sys.platform.startswith("linux"):
        return None
    prctl, parent = ctypes.CDLL(None).prctl, os.getpid()

    def ask() -> None:
        prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
        if os.getppid() != parent:  # it died before the request
            os._exit(1)

    return ask


def _follow(
    child: subprocess.Popen[bytes],
    folder: Path,
    screen: IO[bytes],
    see: Callable[[str], None],
    limit_s: float,
) -> None:
    """Copy what a child shows to a file and line by line to `see` until it ends."""
    pipe = child.stdout
    if pipe is None:  # not with stdout=PIPE
        return
    deadline, rest = time.monotonic() + limit_s, b""
    with selectors.DefaultSelector() as ready:
        ready.register(pipe, selectors.EVENT_READ)
        while True:
            if ready.select(_LOOK_S):
                got = os.read(pipe.fileno(), _READ)
                if not got:
                    _check_disk(folder)
                    return
                screen.write(got)
                *lines, rest = (rest + got).split(b"\n")
                for line in lines:
                    see(line.decode("utf-8", errors="replace"))
            _check_disk(folder)
            if time.monotonic() > deadline:
                raise out_of_time(LIGGGHTS, limit_s)


def _check_disk(folder: Path) -> None:
    """Stop a run that writes to a full disk, which LIGGGHTS does not notice."""
    if shutil.disk_usage(folder).free < _LEAST_FREE:
        raise EngineStopped(Failure.DISK, "the disk is full; LIGGGHTS would lose what it writes")


def _judge(code: int, errors: list[str]) -> None:
    """Raise `EngineStopped` if the exit code or the screen tells of a failure."""
    number = -code if code < 0 else code - _SIGNAL_BASE
    if number in {one.value for one in signal.Signals}:
        name = signal.Signals(number).name
        reason = f"liggghts was killed by {name} (by hand, or because memory ran out)"
        raise EngineStopped(Failure.KILLED, reason)
    if errors and _NO_MEMORY.search(errors[0]):
        raise EngineStopped(Failure.KILLED, f"liggghts: memory ran out: {errors[0]}")
    if errors or code != 0:
        what = errors[0] if errors else f"exit code {code}"
        raise EngineStopped(Failure.PHYSICS, f"liggghts: {what}")
