"""Outlines of separated grains, to parts of a pixel: rays from the middle to the half level.

Where a grain touches another one its edge cannot be seen; the smooth outline through the rest goes
on there. Equations 1 and 2 of the paper are then integrals over the outline.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from liggghts_io.photo.grains.rays import (
    RAYS,
    crossings,
    directions,
    median_of,
    on_rays,
    sampled,
    smooth_outlines,
)
from liggghts_io.photo.grains.rim import HIDING_BLUR, MOST_BLUR, REACH, STEP, rims
from liggghts_io.photo.grains.separate import HALF, Blobs
from liggghts_io.photo.light import FloatArray, FloatImage, Mask

_STEP: Final = 0.5  # px along a ray
_BATCH: Final = 256  # grains
_SEARCH: Final = 5.0  # px around the cut of the mask within which the edge is looked for
_CORE: Final = 0.6  # of the radius: the inside, free of blur
_BESIDE: Final = 2.5  # px along the outline beside a contact, where the edge is bent
_DEPTHS: Final = 8  # samples from the middle to the core's edge
_ALIKE: Final = (0.5, 2.0)  # of the usual radius: surely grains
_MOST_SHARPENED: Final = 0.2  # of a radius


@dataclass(frozen=True)
class Outlines:
    """Outlines of n grains.

    Attributes
    ----------
    centres : (n, 2) float64
        Where rays start: column and row [px].
    radii : (n, RAYS) float64
        Length of the rays, the first to the right, then clockwise as rows grow downwards [px].
    free : (n,) float64
        Part of the outline that touches nothing.
    level : (n,) float64
        Brightness of the inside: 0 as the ground, 1 as the usual grain.
    blur : float
        Standard deviation of the edge's blur, median [px].
    """

    centres: FloatArray
    radii: FloatArray
    free: FloatArray
    level: FloatArray
    blur: float

    @property
    def areas(self) -> FloatArray:
        """Projected areas (n,) [px^2]."""
        return np.asarray(np.pi * np.mean(self.radii**2, axis=1))

    @property
    def perimeters(self) -> FloatArray:
        """Lengths of the outlines (n,) [px]."""
        spectrum = np.fft.rfft(self.radii, axis=1)
        turn = np.fft.irfft(1j * np.arange(spectrum.shape[1]) * spectrum, RAYS, axis=1)
        return np.asarray(2.0 * np.pi * np.mean(np.hypot(self.radii, turn), axis=1))

    def points(self) -> FloatArray:
        """Return the outlines as points (n, RAYS, 2): column and row [px]."""
        return np.asarray(self.centres[:, None] + self.radii[:, :, None] * directions())


def outlines_of(image: FloatImage, blobs: Blobs) -> Outlines:
    """Return the outlines of separated things in a levelled picture."""
    centres, reach = _extents(blobs)
    parts = [slice(k, k + _BATCH) for k in range(0, blobs.count, _BATCH)]
    ends, touching = (
        np.concatenate(both)
        for both in zip(*(_ends(blobs, centres, reach, part) for part in parts), strict=True)
    )
    usual = np.maximum(ends.mean(axis=1), 1.0)
    free = ~_widened(touching, usual)
    level = np.concatenate([_inside(image, centres[part], usual[part]) for part in parts])
    first = _crossed(image, centres, ends, free, level)
    radius = _usual_radius(blobs)
    unit = min(first.blur, MOST_BLUR * radius)
    if not 0.0 < first.blur <= HIDING_BLUR * radius:
        return first
    like = blobs.compact() & (blobs.inner > _ALIKE[0] * radius) & (blobs.inner < _ALIKE[1] * radius)
    rim = np.concatenate([_across(image, first, free, part, unit) for part in parts])
    found = rims(rim, level, like, unit / radius, blurred=unit < first.blur)
    return first if found is None else _crossed(image, centres, first.radii, free, found)


def _usual_radius(blobs: Blobs) -> float:
    """Return the median over what is compact, each with the weight of its area [px]."""
    radii = np.sort(blobs.inner[blobs.compact()])
    total = np.cumsum(radii**2)
    return float(radii[np.searchsorted(total, 0.5 * total[-1])]) if len(radii) else 0.0


def _crossed(
    image: FloatImage, centres: FloatArray, about: FloatArray, free: Mask, level: FloatArray
) -> Outlines:
    """Return smooth outlines through the half levels near to `about` (n, RAYS)."""
    offsets = np.arange(-_SEARCH, _SEARCH + _STEP, _STEP)
    middle = np.full(about.shape, len(offsets) // 2)
    rays, blur = np.empty_like(about), np.empty_like(about)
    for k in range(0, len(about), _BATCH):
        part = slice(k, k + _BATCH)
        along = np.maximum(about[part, :, None] + offsets, 0.0)
        values = sampled(image, on_rays(centres[part], along))
        found, blur[part] = crossings(
            values / level[part, None, None], middle[part], _STEP, _SEARCH
        )
        rays[part] = found + along[:, :, 0]
    seen = free & np.isfinite(rays)
    each = median_of(blur, free)
    sharp = each[np.isfinite(each)]
    sigma = float(np.median(sharp)) if len(sharp) else 0.0
    return Outlines(centres, smooth_outlines(rays, seen, sigma), seen.mean(axis=1), level, sigma)


def _across(
    image: FloatImage, outlines: Outlines, free: Mask, part: slice, unit: float
) -> FloatArray:
    """Return the brightness across the outlines of some grains, NaN where they touch others."""
    offsets = np.arange(-REACH, REACH + 0.5 * STEP, STEP) * unit
    along = np.maximum(outlines.radii[part, :, None] + offsets, 0.0)
    values = sampled(image, on_rays(outlines.centres[part], along))
    return np.where(free[part, :, None], values, np.nan)


def sharpened(outlines: Outlines) -> Outlines:
    """Return the outlines that grains would have in a sharp picture.

    Blur draws the half level of a convex edge inwards, by sigma^2 / (2 R) for a disc.
    """
    usual = outlines.radii.mean(axis=1, keepdims=True)
    further = np.minimum(outlines.blur**2 / (2.0 * usual), _MOST_SHARPENED * usual)
    return replace(outlines, radii=outlines.radii + further)


def _extents(blobs: Blobs) -> tuple[FloatArray, FloatArray]:
    """Return the centre of each thing and a distance beyond its farthest pixel."""
    y, x = np.nonzero(blobs.labels)
    which = blobs.labels[y, x] - 1
    count = np.maximum(np.bincount(which, minlength=blobs.count), 1)
    centres = np.column_stack(
        [np.bincount(which, weights=axis, minlength=blobs.count) / count for axis in (x, y)]
    )
    away = np.hypot(x - centres[which, 0], y - centres[which, 1])
    reach = np.zeros(blobs.count)
    np.maximum.at(reach, which, away)
    return centres, reach + _SEARCH + 2.0


def _ends(
    blobs: Blobs, centres: FloatArray, reach: FloatArray, part: slice
) -> tuple[FloatArray, Mask]:
    """Return where rays leave some things (n, RAYS) [px], and whether they meet another one."""
    own = np.arange(1, len(centres) + 1, dtype=np.int32)[part, None]
    centres, farthest = centres[part], float(reach[part].max())
    rows, columns = blobs.labels.shape
    along = np.arange(1, int(farthest) + 2, dtype=np.float32)
    names = np.empty((len(centres), RAYS, len(along)), dtype=np.int32)
    for ray, (right, down) in enumerate(directions().astype(np.float32)):
        x = np.rint(centres[:, :1].astype(np.float32) + right * along).astype(np.int32)
        y = np.rint(centres[:, 1:].astype(np.float32) + down * along).astype(np.int32)
        np.clip(x, 0, columns - 1, out=x)
        np.clip(y, 0, rows - 1, out=y)
        names[:, ray] = blobs.labels[y, x]
    inside = names == own[:, :, None]
    last = len(along) - 1 - np.argmax(inside[:, :, ::-1], axis=2)
    last = np.where(inside.any(axis=2), last, 0)
    met = np.zeros(last.shape, dtype=np.int32)
    for further in (1, 2):
        beyond = np.minimum(last + further, len(along) - 1)[:, :, None]
        met = np.maximum(met, np.take_along_axis(names, beyond, 2)[:, :, 0])
    return last + 1.5, (met > 0) & (met != own)


def _inside(image: FloatImage, centres: FloatArray, usual: FloatArray) -> FloatArray:
    """Return the median brightness of the inside of each thing."""
    far = _CORE * usual[:, None, None] * np.linspace(0.1, 1.0, _DEPTHS)[None, None, :]
    way = directions()[:: RAYS // 24]
    points = centres[:, None, None] + far[..., None] * way[None, :, None]
    level = np.median(sampled(image, points).reshape(len(centres), -1), axis=1)
    return np.maximum(level, HALF)


def _widened(touching: Mask, usual: FloatArray) -> Mask:
    """Return the rays that touch something, and those beside them."""
    beside = np.ceil(_BESIDE / (usual * (2.0 * np.pi / RAYS))).astype(int)
    wide = touching.copy()
    for shift in range(1, int(beside.max(initial=0)) + 1):
        far = (beside >= shift)[:, None]
        wide |= far & (np.roll(touching, shift, axis=1) | np.roll(touching, -shift, axis=1))
    return wide
