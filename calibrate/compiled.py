"""Loops as machine code, compiled where they are first asked for."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, Final

__all__ = ["compiled"]

_OPTIONS: Final[dict[str, Any]] = {"error_model": "numpy", "fastmath": {"contract"}}


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

    for helper in helpers:
        _callable_from_loops(helper)
    made: Callable[..., None] = numba.njit(cache=True, **_OPTIONS)(loop)
    return made


@cache
def _callable_from_loops(helper: Callable[..., Any]) -> None:
    """Let loops call a function; once, however many of them do."""
    from numba.extending import register_jitable

    register_jitable(**_OPTIONS)(helper)
