"""Loops as machine code, compiled where they are first asked for."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

__all__ = ["compiled"]


@cache
def compiled(loop: Callable[..., None], *helpers: Callable[..., Any]) -> Callable[..., None]:
    """Return a loop over arrays as machine code; only now Numba is imported.

    Rounding may be joined to a multiplication, but no sum reordered: what counts on how numbers
    are rounded would not outlive that.

    Parameters
    ----------
    loop : callable
    *helpers : callable
        Functions that it calls, of the same module: what was compiled before is taken as it is
        while that file stays the same.
    """
    import numba
    from numba.extending import register_jitable

    options: Any = {"cache": True, "error_model": "numpy", "fastmath": {"contract"}}
    for helper in helpers:
        register_jitable(**options)(helper)
    made: Callable[..., None] = numba.njit(**options)(loop)
    return made
