"""Run the script of a case with the bundled engine or with LIGGGHTS."""

from __future__ import annotations

import functools
import os
import shutil
import subprocess
from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Final, TypeAlias

from liggghts_io.errors import CaseError

ENGINES: Final = ("minidem", "liggghts")
Progress: TypeAlias = Callable[[int, int], None]

_LIGGGHTS_TIMEOUT_S: Final = 6 * 3600.0
_LIGGGHTS_VERSION: Final = "LIGGGHTS-PUBLIC 3.8.0"


class EngineFailure(RuntimeError):  # noqa: N818 - it is a result of a run, not a fault of ours
    """The engine started and stopped with a reason: data, not a fault of the caller."""


def engine_version(engine: str) -> str:
    """Return what identifies the engine in a case id.

    LIGGGHTS is named, not asked: a case can be described where it is not installed.
    """
    if engine == "liggghts":
        return _LIGGGHTS_VERSION
    return f"minidem {_minidem_version()}"


@functools.cache
def _minidem_version() -> str:
    """Version of the distribution that brings the engine; "0" where it is not installed."""
    try:
        return version("bulkcal")
    except PackageNotFoundError:
        return "0"


def find_liggghts() -> str | None:
    """Return the LIGGGHTS program, from BULKCAL_LIGGGHTS or the search path."""
    return os.environ.get("BULKCAL_LIGGGHTS") or shutil.which("liggghts")


def run_engine(directory: Path, script: str, engine: str, progress: Progress | None = None) -> None:
    """Run a script in its directory.

    Raises
    ------
    EngineFailure
        If the engine stopped with an error; the message is the reason.
    CaseError
        If the engine is not there.
    """
    if engine == "liggghts":
        _run_liggghts(directory, script)
    else:
        _run_minidem(directory, script, progress)


def _run_minidem(directory: Path, script: str, progress: Progress | None) -> None:
    from minidem import DemError, run_script

    try:
        run_script(directory / script, root=directory, log="log.liggghts", progress=progress)
    except DemError as err:
        raise EngineFailure(str(err)) from err


def _run_liggghts(directory: Path, script: str, timeout_s: float = _LIGGGHTS_TIMEOUT_S) -> None:
    program = find_liggghts()
    if program is None:
        msg = "liggghts not found: install it (Debian package liggghts) or set BULKCAL_LIGGGHTS"
        raise CaseError(msg)
    # Line-buffered output, or the message of an error on one process is lost; never
    # '-screen none', which crashes 3.8.0 when a mesh is read.
    line_buffered = ["stdbuf", "-oL"] if shutil.which("stdbuf") else []
    screen = directory / "screen.txt"
    with screen.open("w", encoding="utf-8") as out:
        try:
            done = subprocess.run(
                [*line_buffered, program, "-in", script],
                cwd=directory,
                stdin=subprocess.DEVNULL,
                stdout=out,
                stderr=subprocess.STDOUT,
                timeout=timeout_s,
                check=False,
            )
        except subprocess.TimeoutExpired as err:
            msg = f"liggghts stopped after {timeout_s:g} s"
            raise EngineFailure(msg) from err
    text = screen.read_text(encoding="utf-8", errors="replace")
    errors = [line.strip() for line in text.splitlines() if "ERROR" in line]
    if done.returncode != 0 or errors:
        reason = errors[0] if errors else f"exit code {done.returncode}"
        msg = f"liggghts: {reason} (see {screen.name})"
        raise EngineFailure(msg)
