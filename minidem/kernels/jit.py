"""The one place where the kernels meet Numba.

A kernel is plain Python on scalars and arrays. Numba compiles it and keeps the machine code on
disk; the folder is named after a digest of all kernel sources, so that a change in one kernel
also renews those that call it (Numba alone would only look at the file of the caller).
"""

from __future__ import annotations

import hashlib
import os
import tempfile
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

__all__ = ["COMPILED", "cache_folder", "inlined", "inner", "kernel"]

F = TypeVar("F", bound=Callable[..., Any])

numba: Any
try:
    import numba
except ImportError:  # pragma: no cover - exercised on machines without numba only
    numba = None
    warnings.warn("numba is not installed: minidem runs about 100 times slower", stacklevel=1)

COMPILED = numba is not None and not numba.config.DISABLE_JIT
"""True if kernels are machine code in this process."""


def _digest() -> str:
    """Return a digest of all kernel sources and of the Numba version."""
    found = hashlib.sha256()
    for path in sorted(Path(__file__).parent.glob("*.py")):
        found.update(path.name.encode())
        found.update(path.read_bytes())
    found.update(getattr(numba, "__version__", "none").encode())
    return found.hexdigest()[:12]


def cache_folder() -> Path:
    """Return the folder of compiled kernels: the user's cache, else a private temporary folder.

    Machine code is loaded from it, so it must not be a place where another user can write.
    """
    base = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    owner = os.getuid() if hasattr(os, "getuid") else 0
    for root in (Path(base) / "bulkcal", Path(tempfile.gettempdir()) / f"bulkcal-{owner}"):
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
    return Path(tempfile.mkdtemp(prefix="bulkcal-kernels-"))


_FOLDER = str(cache_folder()) if COMPILED else ""


def kernel(function: F) -> F:
    """Compile a kernel on its first call and keep the machine code on disk."""
    return _decorate(function, cache=True)


def inner(function: F) -> F:
    """Compile a function that only other kernels call; without a way in from Python."""
    return _decorate(function, cache=True, no_cpython_wrapper=True)


def inlined(function: F) -> F:
    """Compile a small function into each of its callers; constant arguments then vanish."""
    return _decorate(function, cache=False, forceinline=True, no_cpython_wrapper=True)


def _decorate(function: F, *, cache: bool, **options: bool) -> F:
    """Apply ``numba.njit``; our own cache folder holds only while Numba looks for one."""
    if numba is None:
        return function
    before = numba.config.CACHE_DIR
    if not before:
        numba.config.CACHE_DIR = _FOLDER
    try:
        made: F = numba.njit(cache=cache, error_model="numpy", no_cfunc_wrapper=True, **options)(
            function
        )
    finally:
        numba.config.CACHE_DIR = before
    return made
