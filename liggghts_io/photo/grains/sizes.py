"""Sizes and circularity of grains on a photograph from above: section 2.1 of Grobbel et al. 2019.

The light is levelled, grains are separated from the ground at the half level and from each other by
a watershed, and their outlines are followed to parts of a pixel.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final, NamedTuple

import cv2
import numpy as np
import numpy.typing as npt

from liggghts_io.errors import CaseError
from liggghts_io.photo.colour import grey_of, without_specks
from liggghts_io.photo.corners import without_corners
from liggghts_io.photo.grains.ground import elsewhere, overlooked
from liggghts_io.photo.grains.neighbours import without_neighbours
from liggghts_io.photo.grains.oblong import oblong, rejoined
from liggghts_io.photo.grains.outlines import Outlines, outlines_of, sharpened
from liggghts_io.photo.grains.result import GrainSizes
from liggghts_io.photo.grains.separate import Blobs, parted, separated, typical_diameter
from liggghts_io.photo.grains.shadows import without_shadows
from liggghts_io.photo.grains.shapes import CLUMP, CUT, Words, judged, shapes_of
from liggghts_io.photo.grains.sheets import sheets
from liggghts_io.photo.grains.strips import without_strips
from liggghts_io.photo.light import (
    FloatArray,
    FloatImage,
    Levelled,
    Mask,
    Polarity,
    blurred,
    levelled,
)

POLARITIES: Final = ("dark", "bright")

_WANTED: Final = (36.0, 80.0)  # px across a grain, where its outline is followed
_AIM: Final = 48.0  # px across a grain in a picture that is zoomed
_MOST_ZOOM: Final = 8.0
_MOST_WORK: Final = 30e6  # pixels of the zoomed picture
_SMOOTH: Final = 1.0  # px of the zoomed picture
_LEAST_DIAMETER: Final = 4.0  # px of the photograph
_OTHER_SIDE: Final = 2.0  # a tracer may differ from the ground by a part of what grains do
_LARGE: Final = 3e6  # pixels, from which a photograph is looked at smaller first
_CLEAR_SCORE: Final = 0.5  # from which there is no doubt about the polarity
_ALONE: Final = 2.0  # things of which half is believed
_ALIKE: Final = 0.4  # by which the diameter of a tracer may differ from the usual one
_CROWDED: Final = 0.25  # of what is around a tracer may be anything but ground
_CLUMPED: Final = 3.0  # areas of all grains: area of clumps where grains are the exception
_LEAST_SCORE: Final = 0.2  # part of what stands out that may be grains
_LEAST_OBLONG: Final = 0.4  # the same of grains of rice


class _View(NamedTuple):
    """A photograph levelled for one polarity, with its usual diameter [px].

    How it fits is the part of what stands out that is round, or else as smooth as rice.
    """

    polarity: Polarity
    light: Levelled
    diameter: float
    score: float
    oblong: float

    @property
    def is_long(self) -> bool:
        """Whether its grains are as long as rice: hardly any of them is round."""
        return self.score < _LEAST_SCORE


def measure_sizes(
    colour: npt.NDArray[np.uint8], metres_per_pixel: float, polarity: Polarity | None = None
) -> GrainSizes:
    """Measure the grains of a photograph.

    Parameters
    ----------
    colour : (rows, columns, 3) uint8
        Red, green, blue.
    metres_per_pixel : float
        Scale [m].
    polarity : str, optional
        Whether grains are "dark" or "bright"; found out when not given.

    Returns
    -------
    GrainSizes

    Raises
    ------
    CaseError
        If the picture shows no grains, or they are too small in it.
    """
    colour, missing = without_corners(colour)
    grey = without_strips(without_specks(grey_of(colour)))
    view = _best_view(grey, POLARITIES if polarity is None else (polarity,))
    zoomed, diameter = _zoomed(view)
    zoom = np.array(zoomed.shape[::-1]) / np.array(grey.shape[::-1])
    blobs = separated(parted(zoomed, diameter, view.light.noise * zoom.mean()), diameter)
    blobs = rejoined(blobs) if view.is_long else blobs
    outlines = without_neighbours(zoomed, outlines_of(zoomed, blobs))
    apart = elsewhere(zoomed, outlines, diameter)
    outlines = sharpened(outlines)
    reasons = judged(outlines, shapes_of(outlines), blobs, apart, float(zoom[0]), long=view.is_long)
    shaded = outlines
    outlines = without_shadows(zoomed, shaded, reasons == "")
    points = (outlines.points() + 0.5) / zoom - 0.5
    hidden = _hidden(points, missing)
    reasons[hidden.any(axis=1)] = CUT
    nowhere = np.asarray(hidden.all(axis=1))
    found = _result(outlines, points, reasons, nowhere, view, zoom, metres_per_pixel)
    missed = overlooked(colour, points, found.pixels_across)
    return replace(found, shadows=outlines is not shaded, others=max(found.others, missed))


def _hidden(points: FloatArray, missing: Mask) -> Mask:
    """Return which points of outlines (n, k, 2) no camera saw, (n, k)."""
    x, y = np.rint(np.moveaxis(points, -1, 0)).astype(np.int64)
    rows, columns = missing.shape
    return np.asarray(missing[np.clip(y, 0, rows - 1), np.clip(x, 0, columns - 1)])


def _best_view(grey: FloatImage, polarities: tuple[Polarity, ...]) -> _View:
    """Return the photograph levelled so that what stands out looks most like grains.

    A large photograph is looked at smaller first; where its grains are large that is enough.
    """
    shrink = np.sqrt(grey.size / _LARGE)
    if shrink > 1.0:
        size = (round(grey.shape[1] / shrink), round(grey.shape[0] / shrink))
        quick = _views(np.asarray(cv2.resize(grey, size, interpolation=cv2.INTER_AREA)), polarities)
        if quick and quick[0].score >= _CLEAR_SCORE:
            if quick[0].diameter >= _WANTED[0]:
                return quick[0]
            if quick[0].diameter >= _LEAST_DIAMETER:
                polarities = (quick[0].polarity,)
    views = _views(grey, polarities)
    if not views:
        msg = "no grains in the picture: nothing stands out from the ground; light it better"
        raise CaseError(msg)
    best = views[0]
    if best.score < _LEAST_SCORE:
        best = max(views, key=lambda view: view.oblong)
    if best.is_long and best.oblong < _LEAST_OBLONG:
        msg = (
            "no grains in the picture: what stands out is not made of separate round things; "
            "spread the grains in one layer on an even ground, and cut out the part with them"
        )
        raise CaseError(msg)
    _check_large_enough(best.diameter)
    return best


def _check_large_enough(diameter: float) -> None:
    if diameter < _LEAST_DIAMETER:
        msg = (
            f"grains are {diameter:.1f} px across, at least {_LEAST_DIAMETER:.0f} can be "
            "measured; go nearer with the camera"
        )
        raise CaseError(msg)


def _views(grey: FloatImage, polarities: tuple[Polarity, ...]) -> list[_View]:
    """Return the photograph levelled in each way that makes things stand out, the best first."""
    views = [view for one in polarities if (view := _view(grey, one)) is not None]
    if not any(view.score >= _CLEAR_SCORE for view in views):
        for one in polarities:
            on_sheets = (_view(sheet, one, half) for sheet, half in sheets(grey, one))
            views += [view for view in on_sheets if view is not None]
    return sorted(views, key=lambda view: -view.score)


def _view(grey: FloatImage, polarity: Polarity, half: FloatImage | None = None) -> _View | None:
    light = levelled(grey, polarity, half)
    if light is None:
        return None
    smooth = blurred(light.image, _SMOOTH)
    diameter = typical_diameter(smooth)
    if not diameter:
        return None
    blobs = separated(smooth, diameter)
    scores = (_score(blobs, whole) for whole in (blobs.compact(), oblong(blobs)))
    return _View(polarity, light, diameter, *scores)


def _score(blobs: Blobs, whole: Mask) -> float:
    """Return the part of what stands out that is a `whole` (n,) grain, from 0 to 1.

    One thing alone may be a dish as well as a grain.
    """
    many = whole.sum() / (whole.sum() + _ALONE)
    return float(many * blobs.areas[whole].sum() / max(blobs.areas.sum(), 1.0))


def _zoomed(view: _View) -> tuple[FloatImage, float]:
    """Return the levelled picture with grains of a good size, and the diameter in it [px]."""
    image = view.light.image
    zoom = 1.0
    if not _WANTED[0] <= view.diameter <= _WANTED[1]:
        zoom = min(_AIM / view.diameter, _MOST_ZOOM, float(np.sqrt(_MOST_WORK / image.size)))
    rows, columns = (max(1, round(side * zoom)) for side in image.shape)
    way = cv2.INTER_LANCZOS4 if zoom > 1.0 else cv2.INTER_AREA
    if zoom != 1.0:
        image = np.asarray(cv2.resize(image, (columns, rows), interpolation=way))
    return blurred(image, _SMOOTH), view.diameter * zoom


def _result(
    outlines: Outlines,
    points: FloatArray,
    reasons: Words,
    nowhere: Mask,
    view: _View,
    zoom: FloatArray,
    metres_per_pixel: float,
) -> GrainSizes:
    """Return what was found in units of the photograph and in metres.

    What lies `nowhere` (n,) in the photograph is not mentioned.
    """
    kept = reasons == ""
    if not kept.any():
        msg = (
            f"no whole grain in the picture; {int((reasons == CUT).sum())} things are cut by its "
            "border, and others are no grains; take more of the ground into the picture"
        )
        raise CaseError(msg)
    clumped = outlines.areas[reasons == CLUMP].sum()
    if clumped > _CLUMPED * outlines.areas[kept].sum():
        msg = (
            f"{int(kept.sum())} grains can be told from each other, the others are clumps; spread "
            "the grains farther apart, or go nearer with the camera"
        )
        raise CaseError(msg)
    shapes = shapes_of(outlines)
    _check_large_enough(float(np.median(shapes.diameters[kept]) / np.sqrt(zoom.prod())))
    scale = metres_per_pixel / float(np.sqrt(zoom.prod()))
    return GrainSizes(
        diameters_m=shapes.diameters[kept] * scale,
        circularities=shapes.circularities[kept],
        outlines=points[kept],
        left_out=points[~kept & ~nowhere],
        reasons=tuple(str(one) for one in reasons[~kept & ~nowhere]),
        others=_others(view),
        polarity=view.polarity,
        metres_per_pixel=metres_per_pixel,
    )


def _others(view: _View) -> int:
    """Return how many grains differ from the ground the other way, as a white tracer does."""
    smooth = blurred(view.light.image, _SMOOTH)
    blobs = separated(-_OTHER_SIDE * smooth, view.diameter)
    alike = np.abs(2.0 * blobs.inner / view.diameter - 1.0) < _ALIKE
    candidates = 1 + np.flatnonzero(blobs.compact() & alike)
    return sum(_alone(blobs, int(k), round(0.5 * view.diameter)) for k in candidates)


def _alone(blobs: Blobs, number: int, reach: int) -> bool:
    """Whether a thing lies on the ground, and is no part of a larger one such as a ruler."""
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * reach + 1, 2 * reach + 1))
    thing = (blobs.labels == number).astype(np.uint8)
    around = cv2.dilate(thing, disc).astype(bool) & (blobs.labels != number)
    return float((blobs.labels[around] > 0).mean()) < _CROWDED
