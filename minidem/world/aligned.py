"""Tables whose first row begins where a line of the processor's caches does."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import DTypeLike, NDArray

__all__ = ["aligned_zeros"]

LINE: Final = 64
"""Bytes of a line; a particle's row has as many, and is then read in one piece."""


def aligned_zeros(shape: tuple[int, ...], kind: DTypeLike = np.float64) -> NDArray[Any]:
    """Return zeros in memory that begins a line of the caches.

    Parameters
    ----------
    shape : tuple of int
    kind : dtype
        Its size must divide 64.
    """
    size = np.dtype(kind).itemsize
    count = int(np.prod(shape))
    whole = np.zeros(count + LINE // size, kind)
    first = -whole.ctypes.data % LINE // size
    return whole[first : first + count].reshape(shape)
