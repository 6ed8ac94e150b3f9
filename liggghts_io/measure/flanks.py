"""Straight flanks of a heap's outline: their angles, and how well the outline tells them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
import numpy.typing as npt

from liggghts_io.errors import CaseError

FloatArray = npt.NDArray[np.float64]

_LEAST_COLUMNS: Final = 5
_CREST: Final = 0.97  # of the height: from there upwards lies the crest
_ROUNDED: Final = 1.0 / np.sqrt(12.0)  # standard error of a height in whole pixels
_LEAST_SHARE: Final = 0.25  # of the height that a flank has to show where one is enough


@dataclass(frozen=True)
class FlankFit:
    """Which part of the outline is a flank.

    Attributes
    ----------
    low, high : float
        Fractions of the height between which the line is fitted.
    """

    low: float = 0.2
    high: float = 0.8


@dataclass(frozen=True)
class Repose:
    """Measured heap.

    Attributes
    ----------
    angle_deg, left_deg, right_deg : float
        Mean of both flanks, and each flank [deg]; NaN for a flank that is not in the picture.
    left_se_deg, right_se_deg : float
        Standard error of each from the scatter of the outline about the line [deg].
    height_m, base_m : float
        Height above the base line and width of the outline [m].
    outline : (n, 2) float64
        Upper outline: horizontal position and height above the base [m].
    lines : (k, 2, 2) float64
        End points of the fitted lines from left to right (flank, end, coordinate) [m].
    """

    angle_deg: float
    left_deg: float
    right_deg: float
    left_se_deg: float
    right_se_deg: float
    height_m: float
    base_m: float
    outline: FloatArray
    lines: FloatArray

    @property
    def se_deg(self) -> float:
        """Standard error of the mean from the fits of the flanks [deg]."""
        errors = np.array([self.left_se_deg, self.right_se_deg])
        known = errors[np.isfinite(errors)]
        return float(np.sqrt(np.sum(known**2)) / len(known))

    def shifted(self, by: float) -> Repose:
        """Return the same heap with all horizontal positions `by` metres further to the right."""
        move = np.array([by, 0.0])
        return replace(self, outline=self.outline + move, lines=self.lines + move)


def fit_flanks(outline: FloatArray, fit: FlankFit, *, one_is_enough: bool = False) -> Repose:
    """Fit both flanks of an outline (n, 2) and average their angles.

    Parameters
    ----------
    outline : (n, 2) float64
        Horizontal position and height above the base, from left to right.
    fit : FlankFit
    one_is_enough : bool
        Whether a heap is measured of which the picture shows one flank only.

    Raises
    ------
    CaseError
        If a flank has fewer than five columns between the two heights.
    """
    x, z = outline[:, 0], outline[:, 1]
    height = float(z.max())
    crest = float(x[z >= height * _CREST].mean())
    lines, angles, errors, missing = [], [], [], []
    for side, name in ((x <= crest, "left"), (x > crest, "right")):
        band = _flank(x[side], z[side], (fit.low * height, fit.high * height), crest)
        short = len(band) < _LEAST_COLUMNS
        if short or (one_is_enough and np.ptp(band[:, 1]) < _LEAST_SHARE * height):
            missing.append(f"{name} flank: {len(band)} columns between the fitted heights")
            angles.append(np.nan)
            errors.append(np.nan)
            continue
        line, angle = fit_line(band)
        lines.append(line)
        angles.append(angle)
        errors.append(angle_error(band, line))
    if len(missing) > (1 if one_is_enough else 0):
        msg = f"{missing[0]}; image too coarse"
        raise CaseError(msg)
    return Repose(
        angle_deg=float(np.nanmean(angles)),
        left_deg=angles[0],
        right_deg=angles[1],
        left_se_deg=errors[0],
        right_se_deg=errors[1],
        height_m=height,
        base_m=float(np.ptp(x)),
        outline=outline,
        lines=np.array(lines),
    )


def _flank(x: FloatArray, z: FloatArray, band: tuple[float, float], crest: float) -> FloatArray:
    """Outline between the last point above band[1] and the first below band[0] from the crest."""
    order = np.argsort(np.abs(x - crest))
    x, z = x[order], z[order]
    above = np.flatnonzero(z > band[1])
    start = int(above[-1]) + 1 if len(above) else 0
    below = np.flatnonzero(z[start:] < band[0])
    stop = start + int(below[0]) if len(below) else len(z)
    return np.column_stack([x[start:stop], z[start:stop]])


def fit_line(points: FloatArray) -> tuple[FloatArray, float]:
    """Return the total least squares line of points (n, 2): ends (2, 2) and angle to level [deg].

    Sums are rounded once, so that every machine finds the same digits: `cv2.fitLine` works in
    single precision, and its eighth digit is the processor's. A calibration that learns from such
    an angle asks for runs at other points, and piles go their own ways.
    """
    scale = float(np.ptp(points)) or 1.0
    x, z = (points / scale).T.tolist()
    count = len(x)
    x0, z0 = math.fsum(x) / count, math.fsum(z) / count
    xx = math.fsum((a - x0) ** 2 for a in x)
    zz = math.fsum((b - z0) ** 2 for b in z)
    xz = math.fsum((a - x0) * (b - z0) for a, b in zip(x, z, strict=True))
    turn = 0.5 * math.atan2(2.0 * xz, xx - zz)
    vx, vz = math.cos(turn), math.sin(turn)
    angle = math.degrees(math.atan2(abs(vz), abs(vx)))
    along = [(a - x0) * vx + (b - z0) * vz for a, b in zip(x, z, strict=True)]
    ends = [[(x0 + t * vx) * scale, (z0 + t * vz) * scale] for t in (min(along), max(along))]
    return np.array(ends), angle


def residuals(points: FloatArray, line: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return positions along a line and distances from it, both of length n."""
    way = (line[1] - line[0]) / max(float(np.linalg.norm(line[1] - line[0])), 1e-300)
    away = points - line[0]
    return away @ way, away @ np.array([-way[1], way[0]])


def angle_error(points: FloatArray, line: FloatArray) -> float:
    """Return the standard error of a fitted angle from the scatter about the line [deg].

    A grain that sticks out moves all columns that it covers, so neighbouring columns say the same:
    the variance is multiplied by the length of their correlation, counted in columns.

    Parameters
    ----------
    points : (n, 2) float64
        Column by column, in any order of the columns.
    line : (2, 2) float64
        End points of the fitted line.
    """
    along, rest = residuals(points, line)
    order = np.argsort(along)
    along, rest = along[order], rest[order]
    pixel = float(np.median(np.diff(np.sort(points[:, 0])))) or 1.0
    variance = float(np.mean(rest**2)) + (_ROUNDED * pixel) ** 2
    length = min(_correlation_length(rest), len(rest) / 3.0)
    lever = float(np.sum((along - along.mean()) ** 2))
    return float(np.degrees(np.sqrt(variance * length / max(lever, 1e-300))))


def _correlation_length(rest: FloatArray) -> float:
    """Return how many neighbouring residuals say the same as one, at least 1."""
    n = len(rest)
    spread = float(rest @ rest)
    if spread <= 0.0:
        return 1.0
    total = 1.0
    for lag in range(1, n // 2):
        alike = float(rest[:-lag] @ rest[lag:]) / spread
        if alike <= 0.0:
            break
        total += 2.0 * alike
    return total
