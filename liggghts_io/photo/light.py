"""Level the light of a photograph: 0 on the ground, 1 in the grains, whatever lights them.

The half level between ground and grains is where the picture is steepest, whatever part of it
grains cover. So the first threshold is a surface through the grey values of the steepest places;
then ground and grains are known roughly, and the surface of each is fitted to its own pixels.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

import cv2
import numpy as np
import numpy.typing as npt

FloatImage = npt.NDArray[np.float32]
FloatArray = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]
Polarity = Literal["dark", "bright"]

_SMOOTH: Final = 1.0  # px, before slopes are taken
_STEEP: Final = 0.35  # parts of the steepest slope at which an edge begins
_EDGE_POINTS: Final = 20_000
_POINTS: Final = 20_000
_FLAT: Final = 0.3  # part of the pixels of a side that lies away from edges
_ROUNDS: Final = 4  # of a robust fit
_TUKEY: Final = 4.0  # robust standard deviations beyond which a point counts nothing
_MAD: Final = 1.4826  # standard deviation of normal numbers over their median deviation
_LEAST_CONTRAST: Final = 12.0  # grey levels between ground and grains
_LEAST_CLEAR: Final = 3.0  # contrast over the noise of the ground
_FEW: Final = 30  # points that carry a fit


@dataclass(frozen=True)
class Levelled:
    """A photograph without its light.

    Attributes
    ----------
    image : (rows, columns) float32
        0 on the ground, 1 in typical grains; below 0 where something differs the other way.
    contrast : float
        Between ground and grains in the middle of the picture [grey levels].
    noise : float
        Standard deviation on the ground, parts of the contrast.
    """

    image: FloatImage
    contrast: float
    noise: float


def blurred(image: FloatImage, sigma: float) -> FloatImage:
    """Return a picture behind a Gaussian filter of this standard deviation [px]."""
    return np.asarray(cv2.GaussianBlur(image, (0, 0), sigma), dtype=np.float32)


def slope_of(smooth: FloatImage) -> FloatImage:
    """Return the steepness of a smooth picture [grey levels per pixel]."""
    across, down = (cv2.Sobel(smooth, cv2.CV_32F, *way, scale=0.125) for way in ((1, 0), (0, 1)))
    return np.asarray(cv2.magnitude(across, down), dtype=np.float32)


def levelled(
    grey: FloatImage, polarity: Polarity, half: FloatImage | None = None
) -> Levelled | None:
    """Level the light of a picture.

    Parameters
    ----------
    grey : (rows, columns) float32
        Grey levels.
    polarity : str
        Whether grains are "dark" or "bright".
    half : (rows, columns) float32, optional
        Grey levels between ground and grains to begin with; those of steep places if left out.

    Returns
    -------
    Levelled or None
        None where nothing stands out from the ground.
    """
    smooth = blurred(grey, _SMOOTH)
    slope = slope_of(smooth)
    half = _half_level(smooth, slope) if half is None else half
    if half is None:
        return None
    sign = 1.0 if polarity == "bright" else -1.0
    above = sign * (smooth - half)
    for _ in range(2):
        levels = _levels(smooth, slope, above, sign)
        if levels is None:
            return None
        ground, grains = levels
        above = sign * (smooth - 0.5 * (ground + grains))
    depth = grains - ground
    middle = sign * float(np.median(depth))
    if middle < _LEAST_CONTRAST or (sign * depth).min() < 0.1 * middle:
        return None
    rest = (grey - ground)[above < -0.25 * middle]
    noise = _MAD * float(np.median(np.abs(rest))) / middle if len(rest) else 0.0
    if noise * _LEAST_CLEAR > 1.0:
        return None
    return Levelled(np.asarray((grey - ground) / depth, dtype=np.float32), middle, noise)


def _half_level(smooth: FloatImage, slope: FloatImage) -> FloatImage | None:
    """Return the surface through the grey values of the steepest places."""
    edge = slope > _STEEP * float(np.quantile(slope[::2, ::2], 0.9995))
    y, x = np.nonzero(edge)
    if len(y) < _FEW:
        return None
    step = max(1, len(y) // _EDGE_POINTS)
    y, x = y[::step], x[::step]
    weight = slope[y, x].astype(np.float64) ** 2
    return surface(x, y, smooth[y, x].astype(np.float64), smooth.shape, 2, weight)


def _levels(
    smooth: FloatImage, slope: FloatImage, above: FloatImage, sign: float
) -> tuple[FloatImage, FloatImage] | None:
    """Return the surfaces of ground and grains, fitted to the flattest places of each."""
    sides = [_flattest(slope, side) for side in (above < 0.0, above > 0.0)]
    if min(len(rows) for rows, _ in sides) < _FEW:
        return None
    (y, x), (rows, columns) = sides
    ground = surface(x, y, smooth[y, x].astype(np.float64), smooth.shape, 4)
    seen, there = smooth[rows, columns].astype(np.float64), ground[rows, columns].astype(np.float64)
    depth = float(np.median(sign * (seen - there)))
    if depth <= 0.0:
        return None
    # One light falls on both: grains are darker where the ground is.
    share = _share(there, seen, depth)
    at = float(np.median(there))
    grains = np.median(seen - share * (there - at)) + share * (ground - at)
    return ground, np.asarray(grains, dtype=np.float32)


def _share(ground: FloatArray, grains: FloatArray, depth: float) -> float:
    """Return how much of the ground's uneven light grains show, from 0 to 4."""
    if np.ptp(ground) < 0.05 * depth:
        return 0.0
    middle = np.median(ground)
    x, y = ground - middle, grains - np.median(grains)
    weight = np.ones_like(x)
    share = 0.0
    for _ in range(_ROUNDS):
        share = float(np.sum(weight * x * y) / max(float(np.sum(weight * x * x)), 1e-12))
        weight = _tukey(y - share * x)
    return float(np.clip(share, 0.0, 4.0))


def _flattest(slope: FloatImage, side: Mask) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Return rows and columns of the flattest pixels of one side, where no blur reaches."""
    step = max(1, int(np.sqrt(side.sum() * _FLAT / _POINTS)))
    y, x = (one * step for one in np.nonzero(side[::step, ::step]))
    if not len(y):
        return y, x
    there = slope[y, x]
    keep = there <= np.quantile(there, _FLAT)
    return y[keep], x[keep]


def _tukey(rest: FloatArray) -> FloatArray:
    """Return weights that fall to zero for what lies far from the rest."""
    scale = _MAD * float(np.median(np.abs(rest))) + 1e-6
    return np.asarray(np.clip(1.0 - (rest / (_TUKEY * scale)) ** 2, 0.0, None) ** 2)


def surface(
    x: npt.NDArray[np.int64],
    y: npt.NDArray[np.int64],
    z: FloatArray,
    shape: tuple[int, ...],
    order: int,
    weight: FloatArray | None = None,
) -> FloatImage:
    """Return a polynomial surface through points, robust against those that lie apart.

    Parameters
    ----------
    x, y : (n,) int
        Columns and rows.
    z : (n,) float64
        Values there.
    shape : (rows, columns)
        Of the surface.
    order : int
        Highest power.
    weight : (n,) float64, optional
    """
    rows, columns = shape
    scale = 0.5 * max(rows, columns)
    powers = [(i, j) for i in range(order + 1) for j in range(order + 1 - i)]
    # A weak pull towards flat keeps a surface sober where no point holds it.
    pull = np.array([0.0 if i + j == 0 else 1e-4 * 10.0 ** (i + j - 1) for i, j in powers])

    def terms(px: FloatArray, py: FloatArray) -> FloatArray:
        u, v = (px - 0.5 * columns) / scale, (py - 0.5 * rows) / scale
        return np.stack([u**i * v**j for i, j in powers], axis=-1)

    matrix = terms(x.astype(np.float64), y.astype(np.float64))
    given = np.ones_like(z) if weight is None else weight / weight.mean()
    robust = np.ones_like(z)
    found = np.zeros(len(powers))
    for _ in range(_ROUNDS):
        w = given * robust
        normal = (matrix * w[:, None]).T @ matrix
        found = np.linalg.solve(
            normal + np.diag(pull) * np.trace(normal) + 1e-9 * np.eye(len(powers)),
            (matrix * w[:, None]).T @ z,
        )
        robust = _tukey(z - matrix @ found)
    coarse = max(1, min(rows, columns) // 64)
    cy, cx = np.arange(0, rows + coarse, coarse), np.arange(0, columns + coarse, coarse)
    grid = terms(*np.meshgrid(cx.astype(np.float64), cy.astype(np.float64))) @ found
    wide = cv2.resize(
        grid.astype(np.float32),
        (len(cx) * coarse, len(cy) * coarse),
        interpolation=cv2.INTER_LINEAR,
    )
    start = coarse // 2  # of a resized grid: its points lie in the middle of their squares
    return np.asarray(wide[start : start + rows, start : start + columns])
