"""A curve at fixed levels."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


def at_levels(x: FloatArray, y: FloatArray, levels: FloatArray) -> FloatArray:
    """Return `y` where `x` first reaches each level, linear between rows.

    Parameters
    ----------
    x, y : (n,) float64
        A curve in the order in which it was recorded; `x` may stand still and fall in between.
    levels : (L,) float64

    Returns
    -------
    (L,) float64
        nan at levels below the first `x` and above the largest.

    Examples
    --------
    >>> at_levels(np.array([0.0, 10.0]), np.array([1.0, 2.0]), np.array([5.0, 20.0]))
    array([1.5, nan])
    """
    found = np.full(len(levels), np.nan)
    if len(x) == 0:
        return found
    highest = np.maximum.accumulate(x)
    for k, level in enumerate(levels):
        after = int(np.searchsorted(highest, level, side="left"))
        if after == len(x) or level < x[0]:
            continue
        found[k] = (
            y[0] if after == 0 else np.interp(level, x[[after - 1, after]], y[[after - 1, after]])
        )
    return found
