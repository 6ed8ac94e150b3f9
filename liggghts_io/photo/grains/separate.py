"""Find grains in a levelled picture and separate those that touch: watershed of the distance."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, NamedTuple

import cv2
import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from liggghts_io.photo.light import FloatArray, FloatImage, Mask, blurred, slope_of

Labels = npt.NDArray[np.int32]
Bits = npt.NDArray[np.uint8]
Index = npt.NDArray[np.int64]

HALF: Final = 0.5  # between ground and grains
_HIGHER: Final = (0.7, 0.85)
_NECK: Final = 0.82  # of the smaller radius: two grains touch where the blob is narrower
_SAMPLES: Final = 24  # along the way from one middle to the next
_COMPACT: Final = 2.0  # area over that of the circle inside
_SMOOTH: Final = 0.04  # of a diameter: roughness of an edge makes no summit
_FINE_SMOOTH: Final = 0.7  # px, where the diameter is not known yet
_BLURRED: Final = 0.04  # blur over diameter, from which grains are sharpened to part them
_QUIETER: Final = 8.0  # px of smoothing before, times noise
_AT_EDGE: Final = 0.1  # around the half level
_UPPER: Final = 0.7  # quantile of slopes at the half level: clear edges
_WALL: Final = 6.0  # radii of a hole that its wall is followed outwards
_WAYS: Final = 48  # in which it is
_THIN: Final = 0.35  # of the usual thickness, where grains touch
_HOLE: Final = 0.8  # of what is around it, area of a hole
_ROUND_HOLE: Final = 0.88  # of its convex hull: a reflection fills it, a gap between grains less


@dataclass(frozen=True)
class Blobs:
    """Separated things in a picture.

    Attributes
    ----------
    labels : (rows, columns) int32
        0 on the ground, else the number of the thing.
    count : int
        Things; they have the numbers 1 to `count`.
    areas : (count,) float64
        [px^2].
    inner : (count,) float64
        Radius of the largest circle inside [px].
    """

    labels: Labels
    count: int
    areas: FloatArray
    inner: FloatArray

    def cut(self) -> Mask:
        """Return which things (count,) reach the border of the picture."""
        names = self.labels
        edge = np.concatenate([names[0], names[-1], names[:, 0], names[:, -1]])
        return np.isin(np.arange(1, self.count + 1), np.unique(edge))

    def compact(self) -> Mask:
        """Return which things (count,) are about as round as grains and whole."""
        round_ = self.areas < _COMPACT * np.pi * self.inner**2
        return np.asarray(round_ & ~self.cut())


def typical_diameter(image: FloatImage) -> float:
    """Return the usual diameter of the things in a levelled picture [px], 0 where there is none.

    The median over the things, each with the weight of its area, so that specks of noise count
    little.
    """
    mask = _without_reflections((image > HALF).astype(np.uint8))
    if mask.all():  # far from any ground
        return 0.0
    distance = _distance(mask)
    hills = _hills(blurred(distance, _FINE_SMOOTH), mask)
    if not len(hills.summits):
        return 0.0
    radii = distance.ravel()[hills.summits].astype(np.float64)
    group = _merged(hills.summits, radii, distance, mask)
    best = np.zeros(group.max() + 1)
    np.maximum.at(best, group, radii)
    best = np.sort(best)
    weight = np.cumsum(best**2)
    return 2.0 * float(best[np.searchsorted(weight, 0.5 * weight[-1])])


def separated(image: FloatImage, diameter: float) -> Blobs:
    """Return the things in a levelled picture, cut where they touch.

    Parameters
    ----------
    image : (rows, columns) float32
        0 on the ground, 1 in the grains.
    diameter : float
        Usual diameter [px].
    """
    mask = _without_reflections((image > HALF).astype(np.uint8))
    plain = _distance(mask)
    # Between grains that blur joins the picture is darker than in them: higher levels part them.
    distance = plain.copy()
    for level in _HIGHER:
        distance += _distance(_without_reflections((image > level).astype(np.uint8)))
    distance /= 1.0 + len(_HIGHER)
    hills = _hills(blurred(distance, _SMOOTH * diameter), mask)
    if not len(hills.summits):
        return Blobs(np.zeros(mask.shape, dtype=np.int32), 0, np.zeros(0), np.zeros(0))
    radii = distance.ravel()[hills.summits].astype(np.float64)
    group = _merged(hills.summits, radii, distance, mask)
    count = int(group.max()) + 1
    inner = np.zeros(count)
    np.maximum.at(inner, group, plain.ravel()[hills.summits])
    labels = np.zeros(mask.size, dtype=np.int32)
    labels[hills.pixels] = group[hills.of] + 1
    areas = np.bincount(group[hills.of], minlength=count).astype(np.float64)
    return Blobs(labels.reshape(mask.shape), count, areas, inner)


def parted(image: FloatImage, diameter: float, noise: float) -> FloatImage:
    """Return a picture whose grains are parted more clearly where blur joins them.

    Three rounds of van Cittert's deconvolution, which part what is there and make nothing new;
    outlines are followed without them.

    Parameters
    ----------
    image : (rows, columns) float32
        0 on the ground, 1 in the grains.
    diameter : float
        Usual diameter [px].
    noise : float
        Of the photograph, parts of the contrast, times the zoom.
    """
    quiet = blurred(image, 0.1 + _QUIETER * noise)
    edge = slope_of(quiet)[np.abs(quiet - HALF) < _AT_EDGE]
    if not edge.size:
        return image
    blur = 1.0 / (float(np.quantile(edge, _UPPER)) * np.sqrt(2.0 * np.pi))
    if blur < _BLURRED * diameter:
        return image
    once = blurred(quiet, blur)
    sharp = 3.0 * quiet - 3.0 * once + blurred(once, blur)
    return np.asarray(np.minimum(sharp, quiet + _AT_EDGE))


def _distance(mask: Bits) -> FloatImage:
    """Distance to the ground; the border of the picture is none."""
    framed = cv2.copyMakeBorder(mask, 1, 1, 1, 1, cv2.BORDER_REPLICATE)
    return np.asarray(cv2.distanceTransform(framed, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)[1:-1, 1:-1])


class _Hills(NamedTuple):
    """Which summit of the distance the steepest way up leads to.

    Attributes
    ----------
    summits : (m,) int
        Pixels, counted row by row.
    pixels : (p,) int
        Those of the mask.
    of : (p,) int
        Number of the summit of each.
    """

    summits: Index
    pixels: Index
    of: Index


def _hills(height: FloatImage, mask: Bits) -> _Hills:
    """Divide a mask into the hills of its distance to the ground: a watershed, seen from above."""
    # The ground is low: over a narrow gap the blurred distance is higher than beside it, and who
    # climbs out of the mask is nowhere.
    low = np.where(mask > 0, height, np.float32(-1.0))
    framed = cv2.copyMakeBorder(low, 1, 1, 1, 1, cv2.BORDER_CONSTANT, value=-1.0)
    inside = cv2.copyMakeBorder(mask, 1, 1, 1, 1, cv2.BORDER_CONSTANT, value=0)
    wide, flat = framed.shape[1], framed.ravel()
    pixels = np.flatnonzero(inside)
    target, top = pixels.copy(), flat[pixels]
    for step in (-wide - 1, -wide, -wide + 1, -1, 1, wide - 1, wide, wide + 1):
        there = flat[pixels + step]
        # Of equal neighbours the one that comes first, so that a plateau has one summit.
        up = (there > top) | ((there == top) & (pixels + step < target))
        target, top = np.where(up, pixels + step, target), np.where(up, there, top)
    place = np.zeros(framed.size, dtype=np.int64)
    place[pixels] = np.arange(len(pixels))
    up_to = place[target]
    while True:
        further = up_to[up_to]
        if np.array_equal(further, up_to):
            break
        up_to = further
    summits, of = np.unique(up_to, return_inverse=True)
    plain = (pixels // wide - 1) * (wide - 2) + pixels % wide - 1
    return _Hills(plain[summits], plain, of)


def _merged(
    summits: Index, radii: FloatArray, distance: FloatImage, mask: Bits
) -> npt.NDArray[np.int32]:
    """Return the number of the thing that each summit belongs to.

    Two summits are of one thing where the blob is nearly as wide between them as it is there.
    """
    _, component = cv2.connectedComponents(mask, connectivity=8)
    points = np.column_stack(np.unravel_index(summits, mask.shape))
    home = component.ravel()[summits]
    reach = 2.0 * float(np.quantile(radii, 0.98)) + 2.0
    pairs = cKDTree(points).query_pairs(reach, output_type="ndarray")
    i, j = pairs[:, 0], pairs[:, 1]
    near = (home[i] == home[j]) & (
        np.linalg.norm(points[i] - points[j], axis=1) < 1.2 * (radii[i] + radii[j])
    )
    i, j = i[near], j[near]
    part = np.linspace(0.0, 1.0, _SAMPLES)[None, :, None]
    way = np.round(points[i][:, None] * (1.0 - part) + points[j][:, None] * part).astype(np.int64)
    narrow = distance[way[..., 0], way[..., 1]].min(axis=1)
    one = narrow >= _NECK * np.minimum(radii[i], radii[j])
    links = coo_array((np.ones(one.sum()), (i[one], j[one])), shape=(len(points), len(points)))
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.int32)


def _without_reflections(mask: Bits) -> Bits:
    """Fill round holes with nothing in them: light that grains reflect, or that goes through them.

    Gaps between grains have corners, and at each corner two grains touch.
    """
    contours, family = cv2.findContours(mask, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    filled = mask.copy()
    for contour, relatives in zip(contours, [] if family is None else family[0], strict=True):
        if relatives[3] < 0:  # the outside of a thing
            continue
        around = cv2.contourArea(contours[relatives[3]])
        area = cv2.contourArea(contour)
        round_ = area >= _ROUND_HOLE * cv2.contourArea(cv2.convexHull(contour))
        if (
            round_
            and area <= _HOLE * around
            and _is_empty(mask, contour)
            and _is_walled(mask, contour)
        ):
            cv2.drawContours(filled, [contour], -1, 1, cv2.FILLED)
    return filled


def _is_walled(mask: Bits, contour: cv2.typing.MatLike) -> bool:
    """Whether a hole has an even wall, which a bead may make thin on one side only."""
    middle = contour.reshape(-1, 2).mean(axis=0)
    far = float(np.linalg.norm(contour.reshape(-1, 2) - middle, axis=1).max())
    along = np.arange(1.0, _WALL * far + 10.0, 0.5)
    turn = np.linspace(0.0, 2.0 * np.pi, _WAYS, endpoint=False)
    x, y = (
        np.clip(np.rint(at + np.outer(way, along)).astype(np.int64), 0, side - 1)
        for at, way, side in zip(
            middle, (np.cos(turn), np.sin(turn)), mask.shape[::-1], strict=True
        )
    )
    walls = mask[y, x] > 0
    after = np.logical_or.accumulate(walls, axis=1)
    thick = np.logical_and.accumulate(walls | ~after, axis=1).sum(axis=1) - (~after).sum(axis=1)
    thin = thick < _THIN * np.median(thick)
    return int((thin & ~np.roll(thin, 1)).sum()) < 2


def _is_empty(mask: Bits, contour: cv2.typing.MatLike) -> bool:
    """Whether nothing of a mask lies inside a contour."""
    x, y, wide, tall = cv2.boundingRect(contour)
    inside = np.zeros((tall, wide), dtype=np.uint8)
    cv2.drawContours(inside, [contour - [x, y]], -1, 1, cv2.FILLED)
    cv2.drawContours(inside, [contour - [x, y]], -1, 0, 1)
    return not (inside & mask[y : y + tall, x : x + wide]).any()
