"""About this installation: versions of what computes, and the file that goes with a report."""

from __future__ import annotations

import os
import platform
import subprocess
import sys
import tempfile
import traceback
from collections.abc import Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Final

from liggghts_io.case.runner import engine_version, find_liggghts

__all__ = ["versions", "write_bug_report"]

_PATIENCE_S: Final = 5.0


def versions() -> list[str]:
    """Return one line each for bulkcal, its engines and Python."""
    return [
        f"bulkcal {_version()}",
        f"engine {engine_version('minidem')}",
        f"engine {_liggghts()}",
        f"Python {platform.python_version()}, {platform.system()} {platform.machine()}, "
        f"{os.cpu_count()} cores",
    ]


def _version() -> str:
    try:
        return version("bulkcal")
    except PackageNotFoundError:
        return "(not installed as a package)"


def _liggghts() -> str:
    """Return what LIGGGHTS says of itself, or how to get it."""
    program = find_liggghts()
    if program is None:
        return "liggghts: not found (Debian package liggghts, or set BULKCAL_LIGGGHTS)"
    try:
        done = subprocess.run(
            [program, "-h"], stdin=subprocess.DEVNULL, capture_output=True, text=True,
            errors="replace", timeout=_PATIENCE_S, check=False,
        )  # fmt: skip
    except (OSError, subprocess.SubprocessError) as err:
        return f"liggghts: {program} does not start ({err})"
    first = next((line for line in done.stdout.splitlines() if line.strip()), "no version line")
    words = first.partition("Version ")[2].partition(",")[0] or first
    return f"{words} ({program})"


def write_bug_report(err: BaseException, words: Sequence[str]) -> Path | None:
    """Write the traceback of a fault of ours where the user can send it from.

    Parameters
    ----------
    err : BaseException
    words : sequence of str
        The command line.

    Returns
    -------
    Path or None
        A new file in the folder for temporary files; None where none can be written.
    """
    text = "\n".join(
        [
            f"command: bulkcal {' '.join(words)}",
            *versions(),
            f"executable: {sys.executable}",
            "",
            *traceback.format_exception(err),
        ]
    )
    try:
        with tempfile.NamedTemporaryFile(
            "w", prefix="bulkcal-", suffix=".txt", delete=False, encoding="utf-8",
            errors="backslashreplace",
        ) as file:  # fmt: skip
            file.write(text)
    except OSError:
        return None
    return Path(file.name)
