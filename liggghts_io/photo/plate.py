"""The line on which a heap stands in a photograph: the plate, seen from its edge."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from liggghts_io.errors import CaseError
from liggghts_io.photo.light import FloatArray, Mask

BORDER: Final = "the picture's border"
"""Source of a plate of which nothing is seen: the picture is taken to be level."""

FEET: Final = "the feet of the heap"
"""Source of a plate of which only the places are seen where both flanks end."""

_STEEPEST: Final = 0.15  # of a plate in a tilted camera: 8.5 degrees
_TRIES: Final = 400  # lines through two points
_NEAR: Final = 1.5  # px from the line
_NEAR_PART: Final = 0.003  # of the picture's width, for a plate that is rough
_LEAST_SHARE: Final = 0.12  # of the columns that lie on the plate beside a heap
_LEAST_BOTTOM: Final = 0.4  # of the columns of a heap whose lower edge is straight
_BELOW: Final = 0.03  # of the points may lie below the line
_CREST: Final = 0.03  # of the columns around the crest belong to no flank
_FOOT: Final = (0.3, 0.97)  # of the way from the crest out, between which a flank may end
_BROKEN: Final = 0.3  # by which a bent line lies nearer to a flank and what follows it
_FLATTER: Final = 0.4  # slope beyond a foot, over that of the flank
_LAST: Final = 0.98  # of a straight flank: its foot, before the edge's blur
_PLACES: Final = 80  # where a bend is looked for
_FEWEST: Final = 12  # columns of a flank
_FLANK: Final = 0.07  # least slope of a flank
_OFF_FOOT: Final = 0.15  # of the heap's height, between a foot and the plate under it


class Plate(NamedTuple):
    """A line in a photograph.

    Attributes
    ----------
    x, y : float
        A point of it: column and row [px].
    slope : float
        Rows per column; above 0 where the line falls to the right.
    source : str
        What it was found from.
    """

    x: float
    y: float
    slope: float
    source: str

    @property
    def tilt_deg(self) -> float:
        """Angle to the picture's rows, positive where the line falls to the right [deg]."""
        return float(np.degrees(np.arctan(self.slope)))

    def row(self, x: FloatArray) -> FloatArray:
        """Return the rows of the line in some columns."""
        return np.asarray(self.y + self.slope * (x - self.x))


def plate_of(mask: Mask) -> Plate:
    """Return the plate under a region: its level parts, its lower edge, or the picture's border.

    Parameters
    ----------
    mask : (rows, columns) bool
        The heap, and the plate where it looks the same.

    Raises
    ------
    CaseError
        If it stands on nothing straight.
    """
    rows, columns = mask.shape
    found = np.flatnonzero(mask.any(axis=0))
    x = found.astype(np.float64) + 0.5
    near = _NEAR + _NEAR_PART * columns
    top = np.argmax(mask[:, found], axis=0).astype(np.float64)
    beside = _line(x, top, near, _LEAST_SHARE, lowest=True)
    if beside is not None and _is_low(beside, x, top):
        return beside._replace(source="the plate beside the heap")
    below = _below(x, rows - np.argmax(mask[::-1, found], axis=0).astype(np.float64), rows, near)
    feet = _feet(x, top, columns)
    if feet is not None and (below is None or _is_off(below, feet, top)):
        (x1, y1), (x2, y2) = feet
        return Plate(x1, y1, (y2 - y1) / (x2 - x1), FEET)
    if below is None:
        msg = "what stands out does not stand on a straight plate"
        raise CaseError(msg)
    return below


def _below(x: FloatArray, bottom: FloatArray, rows: int, near: float) -> Plate | None:
    """Return the straight lower edge of a region, or the picture's border where that cuts it."""
    inside = bottom < rows
    if inside.mean() >= _LEAST_BOTTOM:
        under = _line(x[inside], bottom[inside], near, _LEAST_BOTTOM, lowest=False)
        if under is not None:
            return under._replace(source="the lower edge of the heap")
    if inside.mean() > 1.0 - _LEAST_SHARE:
        return None
    return Plate(float(x.mean()), float(rows), 0.0, BORDER)


def _is_off(line: Plate, feet: FloatArray, top: FloatArray) -> bool:
    """Whether both feet of a heap lie far above a line."""
    height = float(line.row(feet[:, 0]).mean() - top.min())
    return bool((line.row(feet[:, 0]) - feet[:, 1] > _OFF_FOOT * height).all())


def _feet(x: FloatArray, top: FloatArray, columns: int) -> FloatArray | None:
    """Return where both flanks end (2, 2), column and row; None where the picture cuts one."""
    crest = float(x[np.argmin(top)])
    free = _CREST * float(np.ptp(x))
    ends = []
    for side in (-1.0, 1.0):
        out = side * (x - crest)
        away = np.flatnonzero(out > free)
        if len(away) < _FEWEST:
            return None
        order = away[np.argsort(out[away])]
        foot = _bend(out[order], top[order])
        if foot is None:
            if not 1.0 < x[order[-1]] < columns - 1.0:
                return None
            last = order[int(_LAST * len(order))]
            foot = float(out[last]), float(top[last])
        ends.append((crest + side * foot[0], foot[1]))
    feet = np.array(ends)
    slope = (feet[1, 1] - feet[0, 1]) / (feet[1, 0] - feet[0, 0])
    return feet if abs(slope) < _STEEPEST else None


def _bend(out: FloatArray, down: FloatArray) -> tuple[float, float] | None:
    """Return where a flank ends, as distance from the crest and row; None where it is straight.

    Two lines are fitted to the outline, one behind the other, for every place of the bend.
    """
    whole = _misfit(out, down)
    places = np.unique((np.linspace(*_FOOT, _PLACES) * len(out)).astype(int))
    places = places[(places > 2) & (places < len(out) - 2)]
    rest = [_misfit(out[:k], down[:k]) + _misfit(out[k:], down[k:]) for k in places]
    k = int(places[int(np.argmin(rest))])
    if min(rest) > _BROKEN * whole or whole < len(out) * _NEAR**2:
        return None
    flank, after = (np.polyfit(out[part], down[part], 1) for part in (np.s_[:k], np.s_[k:]))
    if flank[0] < _FLANK or after[0] > _FLATTER * flank[0]:
        return None
    return float(out[k]), float(np.polyval(flank, out[k]))


def _misfit(x: FloatArray, y: FloatArray) -> float:
    """Return the sum of squared distances from the straight line through points."""
    x, y = x - x.mean(), y - y.mean()
    return float(y @ y - (x @ y) ** 2 / max(float(x @ x), 1e-12))


def _is_low(line: Plate, x: FloatArray, top: FloatArray) -> bool:
    """Whether hardly anything of an outline lies below a line."""
    near = _NEAR + 2.0 * _NEAR_PART * float(np.ptp(x))
    return bool(np.mean(top - line.row(x) > near) <= _BELOW)


def _line(x: FloatArray, y: FloatArray, near: float, least: float, *, lowest: bool) -> Plate | None:
    """Return the nearly level line that most points lie near to, None where too few do.

    Parameters
    ----------
    x, y : (n,) float64
        Columns and rows.
    near : float
        What counts as near [px].
    least : float
        Part of the points that must be near.
    lowest : bool
        Whether a line with many points below it is none.
    """
    rng = np.random.default_rng(0)  # the same picture has the same answer
    first, second = rng.integers(len(x), size=(2, _TRIES))
    across = x[second] - x[first]
    apart = np.abs(across) > 0.1 * np.ptp(x)
    if not apart.any():
        return None
    first, slope = first[apart], (y[second] - y[first])[apart] / across[apart]
    level = np.abs(slope) < _STEEPEST
    first, slope = first[level], slope[level]
    if not len(slope):
        return None
    away = y[None, :] - (y[first, None] + slope[:, None] * (x[None, :] - x[first, None]))
    count = (np.abs(away) <= near).sum(axis=1).astype(np.float64)
    if lowest:
        count[(away > 2.0 * near).mean(axis=1) > _BELOW] = 0.0
    best = int(np.argmax(count))
    on = np.abs(away[best]) <= near
    if count[best] < max(least * len(x), 5.0):
        return None
    for _ in range(3):
        slope_, at = np.polyfit(x[on] - x.mean(), y[on], 1)
        on = np.abs(y - (at + slope_ * (x - x.mean()))) <= near
    return Plate(float(x.mean()), float(at), float(slope_), "")
