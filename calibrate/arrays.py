"""The array type of the calibration layer, and a sum that is asked for all the time."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

__all__ = ["Array", "log_sum"]

Array: TypeAlias = NDArray[Any]
"""Floats in double precision, or a mask or index where a docstring says so."""


def log_sum(power: Array) -> Array:
    """Return the logarithm of the sum of exponentials over the last axis of (n, m); overwrites it.

    A tenth of the work of SciPy's, which also takes signs, weights and infinities.
    """
    if power.shape[1] == 1:
        return np.asarray(power[:, 0])
    top = power.max(axis=1)
    power -= top[:, None]
    np.exp(power, out=power)
    return np.asarray(top + np.log(power.sum(axis=1)))
