"""Rows of a table within a part of it."""

from __future__ import annotations

import math

from liggghts_io.errors import CaseError
from liggghts_io.measure.series import FloatArray


def rows_in(values: FloatArray, part: tuple[float, float], file: str) -> FloatArray:
    """Return the values in a part of the rows, at least one.

    Raises
    ------
    CaseError
        If there is no row.
    """
    if len(values) == 0:
        msg = f"{file}: no row; the run wrote nothing there"
        raise CaseError(msg)
    low = min(math.floor(part[0] * len(values)), len(values) - 1)
    return values[low : max(math.ceil(part[1] * len(values)), low + 1)]


def last_of(values: FloatArray, file: str) -> float:
    """Return the last value.

    Raises
    ------
    CaseError
        If there is none.
    """
    return float(rows_in(values, (0.0, 1.0), file)[-1])
