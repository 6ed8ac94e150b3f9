"""Loops as machine code, compiled where they are first asked for."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

__all__ = ["compiled"]


@cache
def compiled(loop: Callable[..., None]) -> Callable[..., None]:
    """Return a loop over arrays as machine code; only now Numba is imported.

    Rounding may be joined to a multiplication, but no sum reordered: what counts on how numbers
    are rounded would not outlive that.
    """
    import numba

    options: Any = {"cache": True, "error_model": "numpy", "fastmath": {"contract"}}
    made: Callable[..., None] = numba.njit(**options)(loop)
    return made
