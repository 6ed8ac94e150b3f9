"""Bars that a program has put beside a picture, as around a film of another shape."""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

__all__ = ["without_bars"]

_EVEN: Final = 6  # grey levels: of a bar, behind JPEG
_MOST_OFF: Final = 0.01  # of the pixels of a line of a bar, beyond that
_LEAST: Final = 0.02  # of the side, each bar
_ALIKE: Final = 0.2  # of the thicker bar, its difference from the other one
_OTHER: Final = 0.4  # of the pixels behind a bar that differ from it; fewer are a plain background
_SEAM: Final = 3  # px between a bar and the picture, where both mix
_LEAST_SIDE: Final = 32  # px of the picture itself, at least


def without_bars(colour: npt.NDArray[np.uint8]) -> tuple[slice, slice]:
    """Return the rows and columns of what stands between bars of one colour.

    Bars come in pairs, above and below, left and right, as thick as each other, and what is behind
    them differs from them all along: an even background above a heap is no bar.

    Parameters
    ----------
    colour : (rows, columns, 3) uint8

    Returns
    -------
    slice, slice
        Rows and columns; all of them where there are no bars.
    """
    rows = _between(colour)
    columns = _between(colour[rows].transpose(1, 0, 2))
    return rows, columns


def _between(lines: npt.NDArray[np.uint8]) -> slice:
    """Return the lines between two bars, all without them."""
    count = len(lines)
    first, last = _thickness(lines), _thickness(lines[::-1])
    thick, thin = max(first, last), min(first, last)
    apart = np.abs(lines[0].mean(axis=0) - lines[-1].mean(axis=0)).max()
    pair = thin >= _LEAST * count and thick - thin <= _ALIKE * thick and apart <= _EVEN
    if not pair or count - first - last < _LEAST_SIDE:
        return slice(0, count)
    return slice(first + _SEAM, count - last - _SEAM)


def _thickness(lines: npt.NDArray[np.uint8]) -> int:
    """Return how many lines from the first on are a bar, 0 if none."""
    ground = np.median(lines[0], axis=0)
    count = 0
    for line in lines:
        if _off(line, ground) > _MOST_OFF:
            break
        count += 1
    behind = min(count + _SEAM, len(lines) - 1)
    return count if _off(lines[behind], ground) > _OTHER else 0


def _off(line: npt.NDArray[np.uint8], ground: npt.NDArray[np.float64]) -> float:
    """Return the part of the pixels of a line that differ from a colour."""
    return float((np.abs(line - ground).max(axis=1) > _EVEN).mean())
