"""The one place where the kernels say how they become machine code.

A kernel is plain Python on scalars and arrays. Numba compiles it, `minidem.kernels.machine.build`;
the machine code stays on disk and later processes load it without Numba,
`minidem.kernels.machine.native`, because importing Numba costs as much as a thousand steps of a
small script. The folder is named after a digest of all kernel sources, so that a change in one
kernel also renews those that call it.

Set ``NUMBA_DISABLE_JIT=1`` to run the same lines interpreted, ``NUMBA_BOUNDSCHECK=1`` to have
Numba check every index.
"""

from __future__ import annotations

import hashlib
import importlib.util
import os
import tempfile
import time
import warnings
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "COMPILED",
    "FREE",
    "OPTIONS",
    "cache_folder",
    "claim",
    "columns",
    "fetch",
    "give_way",
    "indices",
    "inlined",
    "inner",
    "kernel",
    "look",
    "matrix",
    "publish",
    "vector",
]

F = TypeVar("F", bound=Callable[..., Any])

OPTIONS: dict[Callable[..., Any], dict[str, bool]] = {}
"""Functions that other kernels call, with their options for ``numba.njit``."""

_NUMBA = importlib.util.find_spec("numba")
_KERNELS = Path(__file__).resolve().parents[1]
_CHECKED = os.environ.get("NUMBA_BOUNDSCHECK", "0") not in ("", "0")

COMPILED = _NUMBA is not None and os.environ.get("NUMBA_DISABLE_JIT", "0") in ("", "0")
"""True if kernels are machine code in this process."""

FREE = COMPILED and not _CHECKED
"""True if kernels run without the lock of the Python interpreter, so that threads can share."""

if _NUMBA is None:  # pragma: no cover - exercised on machines without numba only
    warnings.warn("numba is not installed: minidem runs about 100 times slower", stacklevel=1)


def _digest() -> str:
    """Return a digest of all kernel sources, of the compiler and of the processor."""
    import llvmlite
    import llvmlite.binding as llvm

    found = hashlib.sha256()
    for path in sorted(_KERNELS.rglob("*.py")):
        found.update(path.relative_to(_KERNELS).as_posix().encode())
        found.update(path.read_bytes())
    if _NUMBA is not None and _NUMBA.origin is not None:
        found.update(Path(_NUMBA.origin).with_name("_version.py").read_bytes())
    found.update(llvmlite.__version__.encode())
    found.update(f"{llvm.get_host_cpu_name()} {llvm.get_host_cpu_features().flatten()}".encode())
    return found.hexdigest()[:12]


@cache
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


def vector(count: int) -> NDArray[np.float64]:
    """Return working space for `count` numbers; in machine code it lies on the stack."""
    return np.full(count, np.nan)


def matrix(rows: int, columns: int) -> NDArray[np.float64]:
    """Return working space of `rows` by `columns` numbers, as `vector` does."""
    return np.full((rows, columns), np.nan)


def indices(count: int) -> NDArray[np.uint64]:
    """Return working space for `count` indices, as `vector` does."""
    return np.full(count, 2**63, np.uint64)


def claim(words: NDArray[np.int64], at: int, old: int, new: int) -> bool:
    """Replace a word if it is `old`, in one act that no other thread can split."""
    if words[at] != old:
        return False
    words[at] = new
    return True


def publish(words: NDArray[np.int64], at: int, value: int) -> None:
    """Write a word so that threads that see it also see what was written before."""
    words[at] = value


def look(words: NDArray[np.int64], at: int) -> Any:
    """Read a word that another thread writes with `publish`."""
    return words[at]


def columns(table: NDArray[np.float64], count: int) -> Any:
    """Return a table of which it is known here that its rows have `count` numbers."""
    del count
    return table


def fetch(table: NDArray[np.float64], row: int) -> None:
    """Ask the processor for a row of a table that will soon be needed."""


def give_way() -> None:
    """Let other threads of the machine run."""
    time.sleep(0)


def kernel(function: F) -> F:
    """Compile a kernel on its first call and keep the machine code on disk."""
    if not COMPILED:
        return function
    OPTIONS[function] = {"no_cpython_wrapper": not _CHECKED}
    if _CHECKED:
        return _checked(function)
    from minidem.kernels.machine.native import Native

    made: Any = Native(function)
    return made


def inner(function: F) -> F:
    """Compile a function that only other kernels call; without a way in from Python."""
    return _called(function, cache=True, no_cpython_wrapper=True)


def inlined(function: F) -> F:
    """Compile a small function into each of its callers; constant arguments then vanish."""
    return _called(function, cache=False, no_cpython_wrapper=True, forceinline=True)


def _called(function: F, **options: bool) -> F:
    if not COMPILED:
        return function
    OPTIONS[function] = options
    return _checked(function) if _CHECKED else function


def _checked(function: F) -> F:
    """Compile with Numba alone, which then raises IndexError where an index is out of bounds."""
    from minidem.kernels.machine.build import dispatcher

    made: F = dispatcher(function)
    return made


if COMPILED and _CHECKED:
    from minidem.kernels.machine.intrinsics import REPLACED

    globals().update(REPLACED)
