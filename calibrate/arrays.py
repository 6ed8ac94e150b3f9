"""The array type of the calibration layer."""

from __future__ import annotations

from typing import Any, TypeAlias

from numpy.typing import NDArray

__all__ = ["Array"]

Array: TypeAlias = NDArray[Any]
"""Floats in double precision, or a mask or index where a docstring says so."""
