"""What the shape of an outline tells: whether it is a whole grain, and if not, what it is."""

from __future__ import annotations

from typing import Final, NamedTuple

import cv2
import numpy as np
import numpy.typing as npt

from liggghts_io.photo.grains.oblong import LONGEST
from liggghts_io.photo.grains.outlines import Outlines
from liggghts_io.photo.grains.rays import RAYS
from liggghts_io.photo.grains.separate import Blobs
from liggghts_io.photo.light import FloatArray, Mask

Words = npt.NDArray[np.str_]

CUT: Final = "cut by the border"
DUST: Final = "dust"
NO_GRAIN: Final = "scratch, ruler or other shape"
CLUMP: Final = "clump that cannot be separated"
OTHER: Final = "of other brightness (tracer)"
REASONS: Final = (CUT, DUST, NO_GRAIN, CLUMP, OTHER)

_LEAST_PX: Final = 3.0  # diameter in the photograph
_SMALLEST: Final = 0.2  # of the usual diameter: all below is dust
_DUST_BELOW: Final = 0.6  # of the usual diameter: below it a gap in the sizes divides dust
_CLEAR_PX: Final = 5.0  # diameter in the photograph, from which dust would be seen to be none
_MANY: Final = 0.1  # of the grains, as many as a second kind of them has at least
_GAP: Final = 1.35  # ratio of two sizes next to each other
_LARGEST: Final = 3.0  # of the usual diameter
_LONGEST: Final = 2.5  # longest axis over shortest, where grains are round
_LONGER: Final = 1.8  # than the usual grain
_HOLLOW: Final = (0.03, 0.06)  # by so much less of its hull than usual does a clump fill
_UNLIKE: Final = 0.25  # by which label and outline may differ in area
_BRIGHTER: Final = 0.6  # level of a grain of another kind, beside that of the usual one
_TICKS: Final = 6  # parallel strokes in a row make a ruler
_TICK_LONGEST: Final = 2.5
_PARALLEL: Final = 0.12  # rad
_IN_ROW: Final = 1.5  # tick lengths
_PIECES: Final = 5  # of one thing that is no heap of grains, such as a ruler's face
_MOSTLY: Final = 0.5  # of its area is in pieces of no grain's shape
_MAD: Final = 1.4826
_SPREADS: Final = 6.0  # robust standard deviations of hollowness


class Shapes(NamedTuple):
    """Shapes of n outlines.

    Attributes
    ----------
    diameters : (n,) float64
        Of the circle of equal area, equation 1 of the paper [px].
    circularities : (n,) float64
        Perimeter of that circle over the perimeter, equation 2.
    aspects, turns : (n,) float64
        Longest axis over shortest of the ellipse of equal moments, and its direction [rad].
    filled : (n,) float64
        Area over that of the convex hull.
    """

    diameters: FloatArray
    circularities: FloatArray
    aspects: FloatArray
    turns: FloatArray
    filled: FloatArray


def shapes_of(outlines: Outlines) -> Shapes:
    """Return the shapes of outlines."""
    diameters = 2.0 * np.sqrt(outlines.areas / np.pi)
    turn = np.arange(RAYS) * (2.0 * np.pi / RAYS)
    fourth = outlines.radii**4
    along = np.mean(fourth * np.cos(2.0 * turn), axis=1)
    across = np.mean(fourth * np.sin(2.0 * turn), axis=1)
    unequal = np.minimum(np.hypot(along, across) / fourth.mean(axis=1), 0.999)
    hulls = [cv2.contourArea(cv2.convexHull(one.astype(np.float32))) for one in outlines.points()]
    return Shapes(
        diameters=diameters,
        circularities=np.minimum(np.pi * diameters / outlines.perimeters, 1.0),
        aspects=np.sqrt((1.0 + unequal) / (1.0 - unequal)),
        turns=0.5 * np.arctan2(across, along),
        filled=outlines.areas / np.maximum(hulls, 1e-9),
    )


def judged(
    outlines: Outlines, shapes: Shapes, blobs: Blobs, apart: Mask, zoom: float, *, long: bool
) -> Words:
    """Return for each outline the reason why it is not counted, empty for a grain.

    Parameters
    ----------
    outlines, shapes : Outlines, Shapes
    blobs : Blobs
        What the outlines were drawn around.
    apart : (n,) bool
        Which do not lie on the ground.
    zoom : float
        Pixels of these outlines to one of the photograph.
    long : bool
        Whether grains are as long as rice.
    """
    longest = LONGEST if long else _LONGEST
    reasons = np.full(blobs.count, "", dtype="U40")
    cut = blobs.cut()
    # A speck may have an outline that is lost far outside it.
    unlike = np.abs(blobs.areas / np.maximum(outlines.areas, 1e-9) - 1.0) > _UNLIKE
    compact = ~cut & ~apart & ~unlike
    compact &= (shapes.aspects < longest) & (shapes.diameters > _LEAST_PX * zoom)
    usual = _weighted_median(shapes.diameters[compact], shapes.diameters[compact] ** 2)
    whole = compact & (shapes.diameters > 0.5 * usual) & (shapes.diameters < _LARGEST * usual)
    if not whole.any():
        reasons[:] = np.where(cut, CUT, NO_GRAIN)
        return reasons
    level, filled, aspect = (
        float(np.median(of[whole])) for of in (outlines.level, shapes.filled, shapes.aspects)
    )
    spread = _SPREADS * _MAD * float(np.median(np.abs(shapes.filled[whole] - filled)))
    hollow = shapes.filled < filled - float(np.clip(spread, *_HOLLOW))
    odd = (shapes.aspects > max(longest, _LONGER * aspect)) | (shapes.diameters > _LARGEST * usual)
    # What counts as last reason stands first.
    reasons[np.abs(outlines.level - level) > _BRIGHTER * level] = OTHER
    reasons[hollow | unlike] = CLUMP
    reasons[odd] = NO_GRAIN
    reasons[shapes.diameters < _dust_limit(shapes.diameters[compact], usual, zoom)] = DUST
    shapeless = _in_shapeless(blobs, (hollow | unlike | odd) & (shapes.diameters > 0.5 * usual))
    reasons[apart | shapeless | _on_ruler(outlines, shapes, odd)] = NO_GRAIN
    reasons[cut] = CUT
    return reasons


def _weighted_median(values: FloatArray, weight: FloatArray) -> float:
    if not len(values):
        return 0.0
    order = np.argsort(values)
    total = np.cumsum(weight[order])
    return float(values[order][np.searchsorted(total, 0.5 * total[-1])])


def _dust_limit(diameters: FloatArray, usual: float, zoom: float) -> float:
    """Return the diameter below which things are dust.

    Dust is divided from grains by a gap in the sizes; without one only the smallest things are.
    Behind a gap, too, many things that are large enough to be measured are grains.
    """
    limit = max(_SMALLEST * usual, _LEAST_PX * zoom)
    small = np.sort(diameters[(diameters < usual) & (diameters > 0.5 * limit)])
    if len(small) < 2:
        return limit
    ratio = small[1:] / small[:-1]
    gaps = np.flatnonzero((ratio > _GAP) & (small[:-1] < _DUST_BELOW * usual))
    if not len(gaps):
        return limit
    widest = gaps[np.argmax(ratio[gaps])]
    clear = small[: widest + 1] > max(limit, _CLEAR_PX * zoom)
    if clear.sum() > _MANY * (diameters > small[widest]).sum():
        return max(limit, _CLEAR_PX * zoom)
    return max(limit, float(np.sqrt(small[widest] * small[widest + 1])))


def _in_shapeless(blobs: Blobs, bad: Mask) -> Mask:
    """Return the pieces (n,) of what is cut in many, most of them of no grain's shape.

    The face of a ruler as bright as grains is, cut where its ticks make it narrow.
    """
    _, regions = cv2.connectedComponents((blobs.labels > 0).astype(np.uint8), connectivity=8)
    region = np.zeros(blobs.count + 1, dtype=np.int64)
    region[blobs.labels.ravel()] = regions.ravel()
    region = region[1:]
    pieces = np.bincount(region)
    whole = np.maximum(np.bincount(region, weights=blobs.areas), 1.0)
    share = np.bincount(region, weights=blobs.areas * bad) / whole
    return np.asarray(((pieces >= _PIECES) & (share > _MOSTLY))[region])


def _on_ruler(outlines: Outlines, shapes: Shapes, odd: Mask) -> Mask:
    """Return what lies among the ticks of a ruler: figures, which may be as round as grains."""
    none = np.zeros(len(odd), dtype=bool)
    stroke = np.flatnonzero(odd & (shapes.aspects > _TICK_LONGEST))
    if len(stroke) < _TICKS:
        return none
    turns = shapes.turns[stroke]
    apart = np.abs(np.angle(np.exp(2j * (turns[:, None] - turns[None, :])))) / 2.0
    best = np.argmax((apart < _PARALLEL).sum(axis=1))
    ticks = stroke[apart[best] < _PARALLEL]
    if len(ticks) < _TICKS:
        return none
    way = np.array([np.cos(turns[best]), np.sin(turns[best])])
    across = outlines.centres @ way
    length = float(np.median(shapes.diameters[ticks] * np.sqrt(shapes.aspects[ticks])))
    row = float(np.median(across[ticks]))
    ticks = ticks[np.abs(across[ticks] - row) < _IN_ROW * length]
    if len(ticks) < _TICKS:
        return none
    along = outlines.centres @ np.array([-way[1], way[0]])
    reach = along[ticks].min() - length, along[ticks].max() + length
    near = np.abs(across - row) < _IN_ROW * length
    return np.asarray(near & (along > reach[0]) & (along < reach[1]))
