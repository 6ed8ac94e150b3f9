"""Scales on which a surrogate works, with the error of a measured value on that scale."""

from __future__ import annotations

import numpy as np

from calibrate.arrays import Array

__all__ = ["backward", "forward", "slope"]


def forward(kind: str, y: Array) -> Array:
    """Return `y` on the scale `kind` (``none``, ``log``, ``sqrt``); impossible values give nan."""
    y = np.asarray(y, float)
    if kind == "none":
        return y
    safe = np.where(y > 0.0, y, np.nan if kind == "log" else np.where(y < 0.0, np.nan, 0.0))
    return np.asarray(np.log(safe) if kind == "log" else np.sqrt(safe))


def backward(kind: str, z: Array) -> Array:
    """Undo `forward`; a negative root counts as an empty box."""
    z = np.asarray(z, float)
    if kind == "log":
        return np.asarray(np.exp(z))
    return np.asarray(np.clip(z, 0.0, None) ** 2 if kind == "sqrt" else z)


def slope(kind: str, y: float) -> float:
    """Return d forward / d y at a positive `y`; it carries a standard error to the scale."""
    if kind == "log":
        return 1.0 / y
    return 0.5 / float(np.sqrt(y)) if kind == "sqrt" else 1.0
