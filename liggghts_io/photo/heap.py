"""A heap on a photograph: found, levelled with its plate and measured as a simulated one.

What is found is drawn as a silhouette, black on white with the plate as lower border, as grains of
a simulation are; from there on both go the same way (`liggghts_io.measure.silhouette`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np
import numpy.typing as npt

from liggghts_io.errors import CaseError
from liggghts_io.measure.flanks import FlankFit, FloatArray, Repose
from liggghts_io.measure.silhouette import angle_of_repose
from liggghts_io.photo.bars import without_bars
from liggghts_io.photo.colour import channels_of
from liggghts_io.photo.corners import without_corners
from liggghts_io.photo.edges import is_wall, steepness
from liggghts_io.photo.heap_checks import check_heap
from liggghts_io.photo.light import FloatImage, Mask
from liggghts_io.photo.plate import FEET, Plate, plate_of
from liggghts_io.photo.regions.levels import Candidate, candidates, relit
from liggghts_io.photo.regions.patterned import patterned_candidates
from liggghts_io.photo.regions.unlike import unlike_candidates

Line = tuple[tuple[float, float], tuple[float, float]]

_ORDERS: Final = (1, 3)  # of the background's light: even, else a lamp's
_WORK_SIDE: Final = 1800  # px: larger photographs are shrunk, smaller heaps magnified
_HEIGHT: Final = 400.0  # px of the silhouette's heap, where the photograph is smaller
_MOST_ZOOM: Final = 4.0
_MARGIN: Final = 0.15  # of the heap's height, free around the silhouette
_LEAST_HEIGHT: Final = 16.0  # px of the photograph
_FLAT: Final = f"nothing rises {_LEAST_HEIGHT:.0f} px above what it stands on"
_STEEPEST: Final = 0.36  # of a level line in a tilted camera: 20 degrees
_SHARP: Final = 5.0  # heap's height over the width of its edge
_LEAST_OF_OTHER: Final = 0.05  # steepness of a flank's edge over that of the other one
_STRAIGHT: Final = 0.05  # deg: standard error of a flank that is straight to the eye
_PART: Final = 0.8  # of its score counts a part of what stands out: cut off it lies less surely
_LATER: Final = 0.5  # the same of what stands out by more than its level of light
_CLEAR: Final = 15.0  # score of a heap beside which no other one is looked for
_ALONE: Final = 0.1  # of its score counts one flank: half of a heap may stand out, too
_EQUAL: Final = 2.0  # deg: flanks that differ by more are told from such that do not


@dataclass(frozen=True)
class Heap:
    """A heap found on a photograph.

    Attributes
    ----------
    repose : Repose
        Angles; lengths in pixels of the photograph.
    plate : Plate
        The line that the angles refer to.
    outline : (n, 2) float64
        Upper outline: column and row in the photograph [px].
    lines : (k, 2, 2) float64
        Fitted flanks: flank, end, column and row [px].
    """

    repose: Repose
    plate: Plate
    outline: FloatArray
    lines: FloatArray


def measure_heap(
    colour: npt.NDArray[np.uint8], level: Line | None = None, fit: FlankFit | None = None
) -> Heap:
    """Measure the angle of repose on a photograph of a heap, seen from the side.

    Parameters
    ----------
    colour : (rows, columns, 3) uint8
        Red, green, blue.
    level : ((x, y), (x, y)), optional
        Two points of anything that is level [px]; the plate itself when not given.
    fit : FlankFit, optional

    Returns
    -------
    Heap

    Raises
    ------
    CaseError
        If the picture shows no heap.
    """
    if level is not None:
        _check_level(level, colour.shape)
    rows, columns = without_bars(colour)
    corner = np.array([columns.start, rows.start], np.float64)
    if corner.any():
        between = colour[rows, columns]
        return _moved(_found(between, level and _shifted(level, -corner), fit), corner)
    return _found(colour, level, fit)


def _shifted(line: Line, by: FloatArray) -> Line:
    (x1, y1), (x2, y2) = line
    x, y = by.tolist()
    return (x1 + x, y1 + y), (x2 + x, y2 + y)


def _moved(heap: Heap, by: FloatArray) -> Heap:
    """Return a heap found on a part of a photograph as one of the whole."""
    x, y = by.tolist()
    plate = heap.plate._replace(x=heap.plate.x + x, y=heap.plate.y + y)
    return Heap(heap.repose, plate, heap.outline + by, heap.lines + by)


def _found(colour: npt.NDArray[np.uint8], level: Line | None, fit: FlankFit | None) -> Heap:
    """Measure the heap of a picture without bars."""
    colour, _ = without_corners(colour)
    shrink = max(1.0, max(colour.shape[:2]) / _WORK_SIDE)
    size = (round(colour.shape[1] / shrink), round(colour.shape[0] / shrink))
    small = cv2.resize(colour, size, interpolation=cv2.INTER_AREA) if shrink > 1.0 else colour
    reasons: list[str] = []
    found: list[tuple[float, Heap]] = []
    for share, grey, one in _searched(np.asarray(small), found):
        try:
            heap = _measured(one, shrink, level, fit or FlankFit())
        except CaseError as err:
            reasons.append(str(err))
            continue
        clear = share * _score(grey, heap, shrink)
        found.append((clear if one.whole else _PART * clear, heap))
    if not found:
        telling = [one for one in reasons if one != _FLAT] or reasons
        what = telling[0] if telling else "nothing stands out but what hangs from the upper border"
        msg = (
            f"no heap in the picture ({what}); take it from the side, the camera level with the "
            "plate, before an even background, with room above and beside the heap"
        )
        raise CaseError(msg)
    return max(found, key=lambda one: one[0])[1]


def _searched(
    colour: npt.NDArray[np.uint8], found: list[tuple[float, Heap]]
) -> Iterator[tuple[float, FloatImage, Candidate]]:
    """Yield what may be a heap until one `found` is clear: share of its score, channel, region."""
    even, lamp = _ORDERS
    colours = channels_of(colour)
    yield from ((1.0, grey, one) for grey in colours for one in candidates(grey, even))
    if any(score > _CLEAR for score, _ in found):
        return
    yield from ((_LATER, one.smooth, one) for one in unlike_candidates(colour))
    if any(score > _CLEAR for score, _ in found):
        return
    yield from ((_LATER, grey, one) for grey in colours for one in candidates(grey, lamp))
    if not found:
        yield from ((_LATER, one.smooth, one) for one in patterned_candidates(colour))


def _check_level(level: Line, shape: tuple[int, ...]) -> None:
    """Refuse a level line that is not in the picture, or stands upright."""
    (x1, y1), (x2, y2) = level
    rows, columns = shape[:2]
    said = f"the level line from {x1:g},{y1:g} to {x2:g},{y2:g}"
    if not (0 <= min(x1, x2) <= max(x1, x2) <= columns and 0 <= min(y1, y2) <= max(y1, y2) <= rows):
        msg = f"{said} is not in the picture of {columns} x {rows} pixels; read the points off it"
        raise CaseError(msg)
    if abs(y2 - y1) > _STEEPEST * abs(x2 - x1):
        msg = f"{said} is too steep; name two points of a level line, left and right"
        raise CaseError(msg)


def _score(grey: FloatImage, heap: Heap, shrink: float) -> float:
    """Return how clearly a heap stands in the picture: long, steep and straight edges, both alike.

    A shadow along one flank has a soft edge, hides the straight one and is flatter than it.
    """
    length = float(np.linalg.norm(heap.lines[:, 1] - heap.lines[:, 0], axis=1).sum())
    steep = min(steepness(grey, line[None] / shrink) for line in heap.lines)
    clear = steep * float(np.sqrt(length)) / (1.0 + heap.repose.se_deg / _STRAIGHT)
    unequal = abs(heap.repose.left_deg - heap.repose.right_deg)
    return clear / (1.0 + (unequal / _EQUAL) ** 2) if np.isfinite(unequal) else _ALONE * clear


def _measured(one: Candidate, shrink: float, level: Line | None, fit: FlankFit) -> Heap:
    """Measure one region, or say why it is no heap."""
    light, mask = one.light, one.mask
    top = np.argmax(mask, axis=0).astype(np.float64)
    plate = plate_of(mask) if level is None else _levelled(level, shrink, mask, top)
    x = np.arange(mask.shape[1], dtype=np.float64) + 0.5
    height = float((plate.row(x) - top)[mask.any(axis=0)].max())
    if height * shrink < _LEAST_HEIGHT:
        raise CaseError(_FLAT)
    y = np.arange(mask.shape[0])[:, None] + 0.5
    better = None if one.levelled else relit(one.smooth, mask, y < plate.row(x)[None, :])
    light = light if better is None else better
    zoom = float(np.clip(_HEIGHT / height, 1.0, _MOST_ZOOM))
    image, back = _silhouette(light, mask, plate, height, zoom)
    # A part of what stands out may be half of it.
    try:
        repose = angle_of_repose(
            image, 1.0 / zoom, dark_heap=True, fit=fit, one_is_enough=one.whole
        )
    except CaseError as err:
        msg = "what stands out has no flanks as a heap has"
        raise CaseError(msg) from err
    if len(repose.lines) == 1 and plate.source == FEET:
        msg = "what stands out has feet on both sides, but one flank only"
        raise CaseError(msg)
    check_heap(repose, mask, image)
    rows = image.shape[0]

    def in_photo(points: FloatArray) -> FloatArray:
        pixels = np.stack([points[..., 0] * zoom, rows - points[..., 1] * zoom], axis=-1)
        return np.asarray((pixels @ back[:, :2].T + back[:, 2]) * shrink)

    lines = in_photo(repose.lines)
    steep = [steepness(light, line[None] / shrink) for line in lines]
    weak = min(steep) < max(_SHARP * one.contrast / height, _LEAST_OF_OTHER * max(steep))
    wall = ~mask & (y < plate.row(x)[None, :])
    if weak or is_wall(one.smooth, lines / shrink, wall):
        msg = "what stands out has no clear edge"
        raise CaseError(msg)
    in_px = Repose(
        **{
            **vars(repose),
            "height_m": repose.height_m * shrink,
            "base_m": repose.base_m * shrink,
            "outline": repose.outline * shrink,
            "lines": repose.lines * shrink,
        }
    )
    whole = plate._replace(x=plate.x * shrink, y=plate.y * shrink)
    return Heap(in_px, whole, in_photo(repose.outline), lines)


def _levelled(level: Line, shrink: float, mask: Mask, top: FloatArray) -> Plate:
    """Return a line as level as a given one, and under the crest as high as the plate.

    Where no plate is found the given line is taken for it.
    """
    (x1, y1), (x2, y2) = level
    slope = (y2 - y1) / (x2 - x1)
    try:
        plate = plate_of(mask)
    except CaseError:
        return Plate(x1 / shrink, y1 / shrink, slope, "--level")
    x = np.arange(mask.shape[1], dtype=np.float64) + 0.5
    above = np.where(mask.any(axis=0), plate.row(x) - top, -np.inf)
    crest = float(x[np.argmax(above)])
    return Plate(crest, float(plate.row(np.array(crest))), slope, "--level")


def _silhouette(
    light: FloatImage, mask: Mask, plate: Plate, height: float, zoom: float
) -> tuple[npt.NDArray[np.uint8], FloatArray]:
    """Draw a region black on white, level, its plate as the lower border.

    Returns
    -------
    (rows, columns) uint8
    (2, 3) float64
        What turns columns and rows of it into those of the photograph.
    """
    bits, square = mask.astype(np.uint8), np.ones((5, 5), np.uint8)
    soft = np.where(cv2.dilate(bits, square) > 0, np.clip(light, 0.0, 1.0), 0.0)
    soft = np.where(cv2.erode(bits, square) > 0, 1.0, soft)
    rows, columns = mask.shape
    turn = np.arctan(plate.slope)
    c, s = np.cos(turn), np.sin(turn)
    corners = np.array([[0.0, 0.0], [columns, 0.0], [0.0, rows], [columns, rows]])
    along = (corners - [plate.x, plate.y]) @ np.array([c, s])
    margin = _MARGIN * height
    width = round(zoom * (np.ptp(along) + 2.0 * margin))
    tall = round(zoom * (height + margin))
    start = along.min() - margin
    # Forward: along the plate to the right, down from the top to the plate.
    there = zoom * np.array([[c, s, -start], [-s, c, 0.0]])
    there[:, 2] -= zoom * np.array([[c, s], [-s, c]]) @ [plate.x, plate.y]
    there[1, 2] += tall
    pixel = there.copy()  # cv2 counts from the middle of the first pixel, we from its corner
    pixel[:, 2] += 0.5 * there[:, :2].sum(axis=1) - 0.5
    black = cv2.warpAffine(soft.astype(np.float32), pixel, (width, tall), flags=cv2.INTER_LINEAR)
    image = np.round(255.0 * (1.0 - np.clip(black, 0.0, 1.0))).astype(np.uint8)
    return image, np.asarray(cv2.invertAffineTransform(there))
