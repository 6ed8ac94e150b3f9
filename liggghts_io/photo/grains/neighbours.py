"""Outlines where grains touch: what the others add to the picture is taken away first.

Blur joins grains that touch by a bridge. The light of a grain alone is that of the picture less
that of its neighbours, each a blurred disc of its present outline; its half level is the outline,
also where they touch. A few rounds settle it.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree
from scipy.special import ndtr

from liggghts_io.photo.grains.outlines import Outlines
from liggghts_io.photo.grains.rays import (
    RAYS,
    crossings,
    on_rays,
    sampled,
    smooth_outlines,
)
from liggghts_io.photo.grains.separate import HALF
from liggghts_io.photo.light import FloatArray, FloatImage, Mask

_ROUNDS: Final = 8
_STEP: Final = 0.55  # of the way to the next outline: two that touch move both
_REACH: Final = 3.5  # blurs around the present outline within which the next one is looked for
_SAMPLES: Final = 19
_HIDDEN: Final = 0.8  # of a neighbour's light: beyond it the edge lies under the neighbour
_BATCH: Final = 128  # grains
_CLOSEST: Final = 0.5  # px: blur that the picture's pixels make at least


def without_neighbours(image: FloatImage, outlines: Outlines) -> Outlines:
    """Return outlines that blur between grains does not bend.

    Parameters
    ----------
    image : (rows, columns) float32
        0 on the ground, 1 in the grains.
    outlines : Outlines
        At the half level, neighbours included.
    """
    blur = max(outlines.blur, _CLOSEST)
    pairs = _neighbours(outlines, _REACH * blur)
    if not len(pairs):
        return outlines
    for _ in range(_ROUNDS):
        rays, seen = np.empty_like(outlines.radii), np.empty(outlines.radii.shape, dtype=bool)
        for start in range(0, len(rays), _BATCH):
            batch = slice(start, min(start + _BATCH, len(rays)))
            rays[batch], seen[batch] = _alone(image, outlines, pairs, batch, blur)
        moved = outlines.radii + _STEP * (rays - outlines.radii)
        outlines = replace(
            outlines, radii=smooth_outlines(moved, seen, blur), free=seen.mean(axis=1)
        )
    return outlines


def _neighbours(outlines: Outlines, reach: float) -> npt.NDArray[np.int64]:
    """Return pairs (p, 2) of grains whose blurred edges may meet, each in both orders."""
    longest = outlines.radii.max(axis=1)
    usual = float(np.quantile(longest, 0.99))
    tree = cKDTree(outlines.centres)
    found = tree.query_pairs(2.0 * usual + 2.0 * reach, output_type="ndarray")
    away = np.linalg.norm(outlines.centres[found[:, 0]] - outlines.centres[found[:, 1]], axis=1)
    near = found[away < longest[found].sum(axis=1) + 2.0 * reach]
    both = np.concatenate([near, near[:, ::-1]])
    return both[np.argsort(both[:, 0], kind="stable")]


def _alone(
    image: FloatImage, outlines: Outlines, pairs: npt.NDArray[np.int64], batch: slice, blur: float
) -> tuple[FloatArray, Mask]:
    """Return the rays of some grains as if they lay alone, and which of them can be seen."""
    radii, centres = outlines.radii[batch], outlines.centres[batch]
    offsets = np.linspace(-_REACH * blur, _REACH * blur, _SAMPLES)
    along = np.maximum(radii[:, :, None] + offsets, 0.0)
    points = on_rays(centres, along)
    light = sampled(image, points)
    mine = pairs[(pairs[:, 0] >= batch.start) & (pairs[:, 0] < batch.stop)]
    hidden = np.zeros(radii.shape, dtype=bool)
    for one, other in mine:
        k = one - batch.start
        # Rays to the other side do not meet the neighbour's light.
        away = np.linalg.norm(points[k, :, _SAMPLES // 2] - outlines.centres[other], axis=1)
        near = away < outlines.radii[other].max() + 2.0 * _REACH * blur
        theirs = _light_of(outlines, int(other), points[k, near], blur)
        light[k, near] -= theirs
        hidden[k, near] |= theirs[:, _SAMPLES // 2] > _HIDDEN * outlines.level[other]
    level = outlines.level[batch][:, None, None]
    middle = np.full(radii.shape, _SAMPLES // 2)
    step = float(offsets[1] - offsets[0])
    rays, _ = crossings(light / level, middle, step, _SAMPLES * step)
    rays = radii + rays - _REACH * blur
    # Where all is bright, or all dark, the edge is at least that far away.
    inside = light[:, :, _SAMPLES // 2] > HALF * level[:, :, 0]
    rays = np.where(np.isfinite(rays), rays, radii + np.where(inside, 1.0, -1.0) * blur)
    return np.where(hidden, radii, rays), ~hidden


def _light_of(outlines: Outlines, which: int, points: FloatArray, blur: float) -> FloatArray:
    """Return the light of one grain at points (..., 2): its level inside, 0 outside, blurred."""
    x, y = np.moveaxis(points - outlines.centres[which], -1, 0)
    turn = np.arctan2(y, x) * (RAYS / (2.0 * np.pi)) % RAYS
    low = turn.astype(np.int64) % RAYS
    part = turn - np.floor(turn)
    edge = outlines.radii[which]
    radius = edge[low] * (1.0 - part) + edge[(low + 1) % RAYS] * part
    return np.asarray(outlines.level[which] * ndtr((radius - np.hypot(x, y)) / blur))
