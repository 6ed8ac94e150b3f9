"""Scales on which observables are modelled and compared: the only place of these transforms.

On its scale an observable's scatter is closest to normal. The study's `scale` names it; where
the study says nothing the unit does: times are positive and vary by factors (logarithm), masses are
sums of counted grains (square root, which also bears an empty box), anything else stays as it is.
Stages and diagnosis use the same scale.
"""

from __future__ import annotations

from typing import Final, Literal, TypeAlias

import numpy as np

from calibrate.arrays import Array

__all__ = ["Scale", "backward", "forward", "scale_of", "slope"]

Scale: TypeAlias = Literal["linear", "log", "sqrt"]

_BY_UNIT: Final[dict[str, Scale]] = {"s": "log", "g": "sqrt"}
_ROOT_FROM: Final = 1e-2
"""Value below which the slope of a root is that at this value: a hundredth of a gram, some grains.

Nearer to zero the slope grows without bound and says nothing about a counting error.
"""


def scale_of(unit: str) -> Scale:
    """Return the usual scale of an observable by its unit.

    Examples
    --------
    >>> scale_of("s"), scale_of("g"), scale_of("deg")
    ('log', 'sqrt', 'linear')
    """
    return _BY_UNIT.get(unit, "linear")


def forward(scale: Scale, y: Array) -> Array:
    """Return values on a scale; a value that has no place on it gives nan."""
    y = np.asarray(y, dtype=np.float64)
    if scale == "linear":
        return y
    safe = np.where(y > 0.0, y, np.nan if scale == "log" else np.where(y < 0.0, np.nan, 0.0))
    return np.asarray(np.log(safe) if scale == "log" else np.sqrt(safe))


def backward(scale: Scale, z: Array) -> Array:
    """Undo `forward`; a negative root counts as an empty box."""
    z = np.asarray(z, dtype=np.float64)
    if scale == "log":
        return np.asarray(np.exp(z))
    return np.asarray(np.clip(z, 0.0, None) ** 2 if scale == "sqrt" else z)


def slope(scale: Scale, y: float) -> float:
    """Return d forward / d y, which carries a standard error to the scale.

    Parameters
    ----------
    scale : {"linear", "log", "sqrt"}
    y : float
        Positive for ``log``; for ``sqrt`` values below 0.01 count as 0.01.
    """
    if scale == "log":
        return 1.0 / y
    return 0.5 / float(np.sqrt(max(y, _ROOT_FROM))) if scale == "sqrt" else 1.0
