"""Formatting of columns of numbers."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from minidem.output.text.fast import WORTHWHILE, number_lines, precision_of

__all__ = ["Column", "format_rows"]

Column = NDArray[np.float64] | NDArray[np.int64]
"""Values of one column, shape (N,)."""

_CHUNK: Final = 2048
"""Rows formatted at once; more would only take memory."""


def format_rows(columns: Sequence[NDArray[Any]], formats: Sequence[str]) -> str:
    r"""Format columns as lines, each value followed by a blank.

    Parameters
    ----------
    columns : sequence of (N,) ndarray
        Integer or float values.
    formats : sequence of str
        One Python format per column.

    Returns
    -------
    str
        N lines.

    Examples
    --------
    >>> format_rows([np.array([1, 2]), np.array([0.5, 1e-7])], ["%d", "%g"])
    '1 0.5 \n2 1e-07 \n'
    """
    if not columns or len(columns[0]) == 0:
        return ""
    precision = precision_of(formats)
    if precision is not None and len(columns) * len(columns[0]) >= WORTHWHILE:
        table = np.stack([np.asarray(column, dtype=np.float64) for column in columns], axis=1)
        return number_lines(table.ravel(), precision, len(columns))
    row = "".join(f"{one} " for one in formats) + "\n"
    lists = [column.tolist() for column in columns]
    count = len(lists[0])
    big = row * min(_CHUNK, count)
    parts = []
    for start in range(0, count, _CHUNK):
        rows = zip(*(values[start : start + _CHUNK] for values in lists), strict=True)
        flat = tuple(chain.from_iterable(rows))
        if start + _CHUNK > count:
            big = row * (count - start)
        parts.append(big % flat)
    return "".join(parts)
