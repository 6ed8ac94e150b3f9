"""About this installation: versions of what computes, and the file that goes with a report."""

from __future__ import annotations

import os
import platform
import sys
import tempfile
import traceback
from collections.abc import Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Final

from liggghts_io import CaseError
from liggghts_io.case.liggghts import find_liggghts, liggghts_version
from liggghts_io.case.sources import engine_code

__all__ = ["engine_in_words", "versions", "write_bug_report"]

_DIGITS: Final = 12  # of a digest, enough to tell versions apart


def versions() -> list[str]:
    """Return one line each for bulkcal, its engines and Python."""
    return [
        f"bulkcal {_version()}",
        f"engine {engine_in_words('minidem')}",
        f"engine {engine_in_words('liggghts')}",
        f"Python {platform.python_version()}, {platform.system()} {platform.machine()}, "
        f"{os.cpu_count()} cores",
    ]


def engine_in_words(engine: str) -> str:
    """Return name and version of an engine, or how to get it; two codes have two names."""
    if engine != "liggghts":
        name, digest = engine_code(engine).split()
        return f"{name} {_version()} (code {digest[:_DIGITS]})"
    program = find_liggghts()
    if program is None:
        return "liggghts: not found (Debian package liggghts, or set BULKCAL_LIGGGHTS)"
    try:
        return f"{liggghts_version(program)} ({program})"
    except CaseError as err:
        return f"liggghts: {err}"


def _version() -> str:
    try:
        return version("bulkcal")
    except PackageNotFoundError:
        return "(not installed as a package)"


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
