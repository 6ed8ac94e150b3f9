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

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from minidem.kernels.machine.cache import CHECKED, COMPILED, OPTIONS

__all__ = ["inlined", "inner", "kernel"]

F = TypeVar("F", bound=Callable[..., Any])


def kernel(function: F) -> F:
    """Compile a kernel on its first call and keep the machine code on disk."""
    if not COMPILED:
        return function
    OPTIONS[function] = {"no_cpython_wrapper": not CHECKED}
    if CHECKED:
        return _checked(function)
    from minidem.kernels.machine.native import Native  # its libraries serve machine code only

    made: Any = Native(function, _build)
    return made


def _build(function: Callable[..., Any], codes: tuple[Any, ...], target: Path) -> None:
    """Compile a kernel; only now Numba is imported."""
    from minidem.kernels.machine.build import build

    build(function, codes, target)


def inner(function: F) -> F:
    """Compile a function that only other kernels call; without a way in from Python."""
    return _called(function, cache=True, no_cpython_wrapper=True)


def inlined(function: F) -> F:
    """Compile a small function into each of its callers; constant arguments then vanish."""
    return _called(function, cache=True, no_cpython_wrapper=True, forceinline=True)


def _called(function: F, **options: bool) -> F:
    if not COMPILED:
        return function
    OPTIONS[function] = options
    return _checked(function) if CHECKED else function


def _checked(function: F) -> F:
    """Compile with Numba alone, which then raises IndexError where an index is out of bounds."""
    from minidem.kernels.machine.build import dispatcher

    made: F = dispatcher(function)
    return made
