"""Whether kernels are machine code in this process, with which options, and where it is kept."""

from __future__ import annotations

import hashlib
import importlib.util
import json
import os
import platform
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import Any

from minidem.kernels.machine.processor import has, identity

__all__ = [
    "CHECKED",
    "COMPILED",
    "FREE",
    "LASTING",
    "MADE_FOR",
    "OPTIONS",
    "SHIPPED",
    "cache_folder",
    "compiler",
    "in_turn",
    "shipped_folder",
    "sources",
    "system",
]

OPTIONS: dict[Callable[..., Any], dict[str, bool]] = {}
"""Functions that other kernels call, with their options for ``numba.njit``."""

LASTING: set[type] = set()
"""Classes of tables that are made once and used often, in turn with others of their class."""

_NUMBA = importlib.util.find_spec("numba")
_KERNELS = Path(__file__).resolve().parents[1]

SHIPPED = _KERNELS / "shipped"
"""Machine code that came with the package,"""
MADE_FOR = "made_for.json"
"""and for what it was made: digest of the sources, system, features of the processor."""

CHECKED = os.environ.get("NUMBA_BOUNDSCHECK", "0") not in ("", "0")
"""True if Numba checks every index."""

COMPILED = _NUMBA is not None and os.environ.get("NUMBA_DISABLE_JIT", "0") in ("", "0")
"""True if kernels are machine code in this process."""

FREE = COMPILED and not CHECKED
"""True if kernels run without the lock of the Python interpreter, so that threads can share."""

if _NUMBA is None:  # pragma: no cover - exercised on machines without numba only
    warnings.warn("numba is not installed: minidem runs about 100 times slower", stacklevel=1)


@cache
def sources() -> str:
    """Return a digest of all kernel sources."""
    found = hashlib.sha256()
    for path in sorted(_KERNELS.rglob("*.py")):
        found.update(path.relative_to(_KERNELS).as_posix().encode())
        found.update(path.read_bytes())
    return found.hexdigest()


@cache
def compiler() -> str:
    """Return a digest of the compiler."""
    found = hashlib.sha256()
    for package in (_NUMBA, importlib.util.find_spec("llvmlite")):
        if package is not None and package.origin is not None:
            # not by import, which takes its time
            found.update(Path(package.origin).with_name("_version.py").read_bytes())
    return found.hexdigest()


def _digest() -> str:
    """Return a digest of all kernel sources, of the compiler and of the processor."""
    parts = (sources(), compiler(), identity())
    return hashlib.sha256(" ".join(parts).encode()).hexdigest()[:12]


@cache
def shipped_folder() -> Path | None:
    """Return the folder of machine code that came with the package, if it suits this machine.

    Who names another processor than this machine's gets code that is made for it.
    """
    if os.environ.get("NUMBA_CPU_NAME"):
        return None
    try:
        made_for = json.loads((SHIPPED / MADE_FOR).read_text(encoding="utf-8"))
        same = (made_for["sources"], made_for["system"]) == (sources(), system())
        wanted = set(made_for["features"])
    except (OSError, ValueError, KeyError, TypeError):
        return None
    return SHIPPED if same and has(wanted) else None


def system() -> str:
    """Return operating system and kind of processor."""
    return f"{sys.platform} {platform.machine()}"


@cache
def cache_folder() -> Path:
    """Return the folder of compiled kernels: the user's cache, else a private temporary folder.

    Machine code is loaded from it, so it must not be a place where another user can write.
    """
    base = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    owner = os.getuid() if hasattr(os, "getuid") else 0
    for root in _roots(Path(base), owner):
        folder = root / f"kernels-{_digest()}"
        try:
            root.mkdir(parents=True, exist_ok=True, mode=0o700)
            folder.mkdir(exist_ok=True, mode=0o700)
            found = folder.stat()
        except OSError:
            continue
        ours = not hasattr(os, "getuid") or (
            found.st_uid == root.stat().st_uid == owner and not found.st_mode & 0o022
        )
        if ours and os.access(folder, os.W_OK):
            return folder
    import tempfile

    return Path(tempfile.mkdtemp(prefix="bulkcal-kernels-"))


def _roots(base: Path, owner: int) -> Iterator[Path]:
    """Yield the folders to try, the user's cache first."""
    yield base / "bulkcal"
    import tempfile

    yield Path(tempfile.gettempdir()) / f"bulkcal-{owner}"


@contextmanager
def in_turn(path: Path) -> Iterator[None]:
    """Let one process after the other make a file, so that those who wait find it made.

    Where the system or the disk has no locks, all make it at once, which costs time only.
    """
    if sys.platform == "win32":
        yield
        return
    import fcntl

    handle = -1
    with suppress(OSError):
        handle = os.open(f"{path}.lock", os.O_RDWR | os.O_CREAT, 0o600)
        fcntl.flock(handle, fcntl.LOCK_EX)
    try:
        yield
    finally:
        if handle >= 0:
            os.close(handle)  # which frees the lock, as the end of the process does
