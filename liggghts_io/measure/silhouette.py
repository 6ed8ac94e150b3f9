"""Angle of repose from a silhouette: one routine for photographs and simulated heaps.

A photograph is first turned into a silhouette that is level with its plate (`photo.heap`). The
image is grey, rows from top to bottom, square pixels, camera level with the plate. Steps:
level the illumination, threshold (Otsu), take the largest contour, read the upper outline column by
column, fit a straight line to each flank between two fractions of the height, average left and
right.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np
import numpy.typing as npt

from liggghts_io.errors import CaseError
from liggghts_io.measure.flanks import FlankFit, FloatArray, Repose, fit_flanks

GreyImage = npt.NDArray[np.uint8]

_MOST_PIXELS: Final = 2e8  # the heap of the paper's scale has 4e6
_LEAST_CONTRAST: Final = 12.0  # grey levels between heap and background


@dataclass(frozen=True)
class Silhouette:
    """Grains as a back-lit photograph shows them.

    Attributes
    ----------
    image : (rows, columns) uint8
        Black on white; the plate is the lower border.
    left_m : float
        Horizontal position of the left border [m].
    metres_per_pixel : float
    """

    image: GreyImage
    left_m: float
    metres_per_pixel: float


def angle_of_repose(
    image: GreyImage,
    metres_per_pixel: float = 1.0,
    *,
    dark_heap: bool | None = None,
    fit: FlankFit | None = None,
    one_is_enough: bool = False,
) -> Repose:
    """Measure the angle of repose on a grey image of a heap.

    Parameters
    ----------
    image : (rows, columns) uint8
        Heap on its plate, seen from the side; nothing below the plate in the picture, or the
        plate's edge as the lower border of the heap.
    metres_per_pixel : float
        Scale [m]; the angle does not depend on it.
    dark_heap : bool, optional
        Whether the heap is darker than the background; found out when not given.
    fit : FlankFit, optional
    one_is_enough : bool
        Whether a heap is measured of which the picture shows one flank only.

    Returns
    -------
    Repose

    Raises
    ------
    CaseError
        If the image shows no heap: too little contrast, an outline that leaves the image at the
        top, or a flank too short to fit.
    """
    mask = heap_mask(image, dark_heap=dark_heap)
    outline = upper_outline(mask) * metres_per_pixel
    return fit_flanks(outline, fit or FlankFit(), one_is_enough=one_is_enough)


def heap_mask(image: GreyImage, *, dark_heap: bool | None = None) -> GreyImage:
    """Return the filled largest contour: 255 in the heap, 0 elsewhere, shape of the image."""
    if image.ndim != 2 or image.dtype != np.uint8 or min(image.shape) < 16:
        msg = f"an image must be grey, 8 bit and at least 16 x 16, got {image.shape} {image.dtype}"
        raise CaseError(msg)
    smooth = cv2.medianBlur(image, 3).astype(np.float64)
    level = smooth - _background(smooth)
    if dark_heap is None:  # the heap is what differs most from the background
        dark_heap = bool(-np.percentile(level, 0.5) > np.percentile(level, 99.5))
    level = -level if dark_heap else level
    spread = float(np.percentile(level, 99.5))
    if spread < _LEAST_CONTRAST:
        msg = f"no heap in the image: contrast {spread:.0f} of 255 grey levels; light it better"
        raise CaseError(msg)
    grey = np.clip(level / spread * 255.0, 0, 255).astype(np.uint8)
    _, binary = cv2.threshold(grey, 0, 255, cv2.THRESH_BINARY + cv2.THRESH_OTSU)
    contours, _ = cv2.findContours(binary, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    mask = np.zeros_like(image)
    cv2.drawContours(mask, [max(contours, key=cv2.contourArea)], -1, 255, cv2.FILLED)
    if mask[0].any():
        msg = "the heap touches the upper border of the image; leave room above it"
        raise CaseError(msg)
    return mask


def _background(grey: FloatArray) -> FloatArray:
    """Plane of illumination fitted to the upper border, where no heap is."""
    rows, columns = grey.shape
    depth = max(2, rows // 12)
    y, x = np.mgrid[0:depth, 0:columns]
    side = max(2, columns // 40)
    upper = rows // 2
    ys, xs = np.mgrid[depth:upper, 0:columns]
    keep = (xs < side) | (xs >= columns - side)
    x_all = np.concatenate([x.ravel(), xs[keep]])
    y_all = np.concatenate([y.ravel(), ys[keep]])
    matrix = np.column_stack([np.ones_like(x_all), x_all, y_all]).astype(np.float64)
    plane, *_ = np.linalg.lstsq(matrix, grey[y_all, x_all], rcond=None)
    y, x = np.mgrid[0:rows, 0:columns]
    return np.asarray(plane[0] + plane[1] * x + plane[2] * y, dtype=np.float64)


def upper_outline(mask: GreyImage) -> FloatArray:
    """Return the outline's upper edge, shape (n, 2): column and height above the lowest row."""
    columns = np.flatnonzero(mask.any(axis=0))
    top = np.argmax(mask[:, columns] > 0, axis=0)
    base = int(np.flatnonzero(mask.any(axis=1))[-1]) + 1
    return np.column_stack([columns + 0.5, base - top]).astype(np.float64)


def draw_silhouette(
    x: FloatArray, z: FloatArray, radius: FloatArray, metres_per_pixel: float
) -> Silhouette:
    """Draw discs as a back-lit photograph would show the grains: black on white.

    Parameters
    ----------
    x, z, radius : (n,) float64
        Horizontal position, height above the plate and radius [m]; grains below the plate are
        left out.
    metres_per_pixel : float
        [m]

    Returns
    -------
    Silhouette

    Raises
    ------
    CaseError
        If no grain lies above the plate, or one lies so far away that no picture holds it.
    """
    keep = z > 0.0
    if not keep.any():
        msg = "no grain lies above the plate; the heap cannot be measured"
        raise CaseError(msg)
    x, z, radius = x[keep], z[keep], radius[keep]
    margin = 4.0 * float(radius.max())
    left, right = float(x.min()) - margin, float(x.max()) + margin
    height, width = (float(z.max()) + margin) / metres_per_pixel, (right - left) / metres_per_pixel
    if not height * width <= _MOST_PIXELS:
        msg = (
            f"the grains spread over {right - left:.3g} m x {float(z.max()):.3g} m, too far for a "
            "picture of a heap; the run is broken, or not one of a heap"
        )
        raise CaseError(msg)
    rows, columns = int(np.ceil(height)), int(np.ceil(width))
    image = np.full((rows, columns), 255, dtype=np.uint8)
    shift = 4  # cv2 takes fixed-point coordinates with this many binary digits
    unit = (1 << shift) / metres_per_pixel
    for centre_x, centre_z, r in zip(x, z, radius, strict=True):
        centre = (round((centre_x - left) * unit), round(rows * (1 << shift) - centre_z * unit))
        cv2.circle(image, centre, round(r * unit), 0, cv2.FILLED, cv2.LINE_8, shift)
    return Silhouette(image, left, metres_per_pixel)
