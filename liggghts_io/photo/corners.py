"""Corners that a program has filled with one colour, as it turned a picture.

Who levels a photograph on a screen turns the whole of it, and gets four triangles of black or white
that no camera saw. What lies beside them is mirrored into them: the light goes on as it is there.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from liggghts_io.photo.light import FloatArray, FloatImage, Mask

__all__ = ["without_corners"]

_EVEN: Final = 6  # grey levels: of a corner, behind JPEG
_RINGING: Final = 24  # grey levels: of it near its side, where JPEG rings
_RINGS: Final = 10.0  # px beside the side
_STRAIGHT: Final = 1.5  # px off a straight side, beyond that
_MOST_OFF: Final = 0.03  # of a corner: pixels that differ, and lines that are too short
_TRIED: Final = 60  # of its lines, between each two of which a side is tried
_LEAST_AREA: Final = 2e-4  # of the picture, each corner
_LEAST_LINES: Final = 6
_OTHER: Final = 0.4  # of what lies behind a side differs from the corner
_BESIDE: Final = 4.0  # px behind the side, where nothing of the corner is mixed in
_SEAM: Final = 3.0  # px beside it, where both mix
_ALIKE: Final = 1.0  # deg: sides of corners are parallel or at right angles
_LEAST_SIDE: Final = 32  # px of a picture that is looked at
_ENOUGH: Final = 1e6  # pixels: of a larger picture every second one is looked at, or fewer

Colour = npt.NDArray[np.uint8]


class _Side(NamedTuple):
    """The straight side of a corner: x cos + y sin = offset; the picture lies where it is more."""

    cos: float
    sin: float
    offset: float

    @property
    def turn(self) -> float:
        """Angle to the border of the picture [deg], whichever border."""
        return float(np.degrees(np.arctan2(self.sin, self.cos)) % 90.0)


def without_corners(colour: Colour) -> tuple[Colour, Mask]:
    """Return a picture whose filled corners show what lies beside them, and where they are.

    Parameters
    ----------
    colour : (rows, columns, 3) uint8

    Returns
    -------
    (rows, columns, 3) uint8
        The picture itself where it has no such corners.
    (rows, columns) bool
        What no camera saw.

    Notes
    -----
    A picture that was turned has at least two such corners, and their sides are parallel or at
    right angles: a dark corner of a table is none.
    """
    rows, columns = colour.shape[:2]
    missing = np.zeros((rows, columns), dtype=bool)
    step = math.ceil(math.sqrt(rows * columns / _ENOUGH))
    found = _turned_together(_sides(colour[::step, ::step]))
    sides = [one._replace(offset=one.offset * step + _SEAM * step) for one in found]
    if not sides:
        return colour, missing
    for side in sides:
        missing |= _depth(side, *_grid(rows, columns)) > 0.0
    y, x = (at.astype(np.float32) for at in np.nonzero(missing))
    for side in 2 * sides:  # the mirror of one corner may lie in another one
        depth = np.maximum(_depth(side, x, y), 0.0)
        x = np.clip(x + 2.0 * depth * side.cos, 0, columns - 1)
        y = np.clip(y + 2.0 * depth * side.sin, 0, rows - 1)
    filled = colour.copy()
    filled[missing] = colour[np.rint(y).astype(np.int64), np.rint(x).astype(np.int64)]
    return filled, missing


def _grid(rows: int, columns: int) -> tuple[FloatImage, FloatImage]:
    """Return columns (1, columns) and rows (rows, 1) of all pixels."""
    x, y = np.arange(columns, dtype=np.float32), np.arange(rows, dtype=np.float32)
    return x[None, :], y[:, None]


def _depth(side: _Side, x: FloatImage, y: FloatImage) -> FloatImage:
    """Return how far pixels lie in a corner [px], below zero those that do not."""
    depth = np.float32(side.offset) - (x * np.float32(side.cos) + y * np.float32(side.sin))
    return np.asarray(depth, dtype=np.float32)


def _turned_together(sides: list[_Side]) -> list[_Side]:
    """Return the sides that one turn of the picture has made, none if there is but one."""
    best: list[_Side] = []
    for one in sides:
        apart = [abs((other.turn - one.turn + 45.0) % 90.0 - 45.0) for other in sides]
        alike = [side for side, away in zip(sides, apart, strict=True) if away <= _ALIKE]
        best = max(best, alike, key=len)
    return best if len(best) > 1 else []


def _sides(colour: Colour) -> list[_Side]:
    """Return the side of each corner that is filled with one colour."""
    rows, columns = colour.shape[:2]
    if min(rows, columns) < _LEAST_SIDE:
        return []
    found = []
    for up in (1, -1):
        for left in (1, -1):
            side = _side(colour[::up, ::left])
            if side is not None:
                cos, sin, offset = side
                # From pixels counted from this corner to those counted from the first one.
                offset -= (left < 0) * cos * (columns - 1) + (up < 0) * sin * (rows - 1)
                found.append(_Side(left * cos, up * sin, offset))
    return found


def _side(colour: Colour) -> _Side | None:
    """Return the side of the first corner of a picture, if that is filled with one colour."""
    ground = colour[0, 0].astype(np.int16)
    if np.abs(colour[:3, :3] - ground).max() > _EVEN:
        return None
    off = np.abs(colour - ground).max(axis=2)
    side = _slanted(off > _RINGING)
    if side is None:
        across = _slanted(off.T > _RINGING)
        side = across and _Side(across.sin, across.cos, across.offset)
    if side is None:
        return None
    deep = off[_depth(side, *_grid(*off.shape)) > _RINGS]
    even = not deep.size or float((deep > _EVEN).mean()) < _MOST_OFF
    return side if even and _is_beside_other(off > _RINGING, side) else None


def _slanted(other: Mask) -> _Side | None:
    """Return the straight side of a first corner that is larger down than across, if it has one.

    Parameters
    ----------
    other : (rows, columns) bool
        What differs from the corner's colour.
    """
    rows, columns = other.shape
    across = np.where(other.any(axis=1), other.argmax(axis=1), columns)
    end = int(np.argmax(across == 0)) if (across == 0).any() else rows
    y = np.arange(end)
    # Two corners may meet at the border, where the turned picture touches it.
    y = y[across[:end] < columns]
    if len(y) < _LEAST_LINES:
        return None
    x = across[y].astype(np.float64)
    slope, first = _lower(y.astype(np.float64), x)
    length = float(np.hypot(1.0, slope))
    # A line that is longer ends at something that looks like the corner; one of it is not shorter.
    short = (first + slope * y - x) / length > _STRAIGHT
    area = 0.5 * first**2 / max(-slope, 1e-12)
    if short.mean() > _MOST_OFF or slope >= 0.0 or area < _LEAST_AREA * rows * columns:
        return None
    return _Side(1.0 / length, -slope / length, first / length)


def _lower(y: FloatArray, x: FloatArray) -> tuple[float, float]:
    """Return slope and beginning of the line that most points lie on."""
    tried = np.unique(np.linspace(0, len(y) - 1, _TRIED).astype(int))
    i, j = (tried[k] for k in np.triu_indices(len(tried), 1))
    slopes = (x[j] - x[i]) / (y[j] - y[i])
    near = _STRAIGHT * np.hypot(1.0, slopes)[:, None]
    away = np.abs(x[tried] - (x[i, None] + slopes[:, None] * (y[tried] - y[i, None])))
    best = int(np.argmax((away <= near).sum(axis=1)))
    on = np.abs(x - (x[i[best]] + slopes[best] * (y - y[i[best]]))) <= near[best]
    slope, first = np.polyfit(y[on], x[on], 1)
    return float(slope), float(first)


def _is_beside_other(other: Mask, side: _Side) -> bool:
    """Whether what lies behind a side differs from the corner, all along."""
    rows, columns = other.shape
    ends = np.array([[side.offset / side.cos, 0.0], [0.0, side.offset / side.sin]])
    part = np.linspace(0.02, 0.98, 200)[:, None]
    x, y = (ends[0] * (1.0 - part) + ends[1] * part + _BESIDE * np.array([side.cos, side.sin])).T
    inside = (x >= 0) & (x < columns) & (y >= 0) & (y < rows)
    seen = other[y[inside].astype(int), x[inside].astype(int)]
    return bool(seen.size) and float(seen.mean()) > _OTHER
