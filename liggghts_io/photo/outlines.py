"""Outlines of separated grains, to parts of a pixel: rays from the middle to the half level.

Where a grain touches another one its edge cannot be seen; the smooth outline through the rest goes
on there. Equations 1 and 2 of the paper are then integrals over the outline.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import cv2
import numpy as np
import numpy.typing as npt

from liggghts_io.photo.light import FloatArray, FloatImage, Mask
from liggghts_io.photo.separate import HALF, Blobs

RAYS: Final = 96
_STEP: Final = 0.5  # px along a ray
_BATCH: Final = 256  # grains
_HARMONICS: Final = 10  # of the outline: what is finer is noise
_HIDDEN: Final = 4.0  # blurs: waves of an outline that are shorter are half suppressed
_ROUNDS: Final = 4
_TUKEY: Final = 4.0
_SEARCH: Final = 5.0  # px around the cut of the mask within which the edge is looked for
_CORE: Final = 0.6  # of the radius: the inside, free of blur
_BESIDE: Final = 2.5  # px along the outline beside a contact, where the edge is bent
_DEPTHS: Final = 8  # samples from the middle to the core's edge
_REMAPPED: Final = 16  # grains at once; cv2 takes at most 32767 points in a row
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
    found = [
        _batch(image, blobs, centres[k : k + _BATCH], reach[k : k + _BATCH], k + 1)
        for k in range(0, blobs.count, _BATCH)
    ]
    rays, seen, level, blur = (np.concatenate([one[part] for one in found]) for part in range(4))
    sharp = blur[np.isfinite(blur)]
    sigma = float(np.median(sharp)) if len(sharp) else 0.0
    return Outlines(centres, smooth_outlines(rays, seen, sigma), seen.mean(axis=1), level, sigma)


def sharpened(outlines: Outlines) -> Outlines:
    """Return the outlines that grains would have in a sharp picture.

    Blur draws the half level of a convex edge inwards, by sigma^2 / (2 R) for a disc.
    """
    usual = outlines.radii.mean(axis=1, keepdims=True)
    further = np.minimum(outlines.blur**2 / (2.0 * usual), _MOST_SHARPENED * usual)
    return replace(outlines, radii=outlines.radii + further)


def directions() -> FloatArray:
    """Return the directions of the rays (RAYS, 2): to the right and down."""
    turn = np.arange(RAYS) * (2.0 * np.pi / RAYS)
    return np.column_stack([np.cos(turn), np.sin(turn)])


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


def _batch(
    image: FloatImage, blobs: Blobs, centres: FloatArray, reach: FloatArray, first: int
) -> tuple[FloatArray, Mask, FloatArray, FloatArray]:
    """Return rays, which of them end at the ground, level and blur of some things."""
    ends, touching = _ends(blobs, centres, float(reach.max()), first)
    usual = np.maximum(ends.mean(axis=1), 1.0)
    level = _inside(image, centres, usual)
    offsets = np.arange(-_SEARCH, _SEARCH + _STEP, _STEP)
    along = np.maximum(ends[:, :, None] + offsets, 0.0)
    values = sampled(image, centres[:, None, None] + along[..., None] * directions()[None, :, None])
    middle = np.full(ends.shape, len(offsets) // 2)
    rays, blur = crossings(values / level[:, None, None], middle, _STEP, _SEARCH)
    rays = rays + along[:, :, 0]
    free = ~_widened(touching, usual)
    return rays, free & np.isfinite(rays), level, _median(blur, free)


def _ends(blobs: Blobs, centres: FloatArray, reach: float, first: int) -> tuple[FloatArray, Mask]:
    """Return where rays leave their thing (n, RAYS) [px], and whether they meet another one."""
    own = np.arange(first, first + len(centres), dtype=np.int32)[:, None]
    rows, columns = blobs.labels.shape
    along = np.arange(1, int(reach) + 2, dtype=np.float32)
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


def sampled(image: FloatImage, points: FloatArray) -> FloatArray:
    """Return the values of a picture at points (n, ..., 2): column and row [px]."""
    flat = points.reshape(len(points), -1, 2).astype(np.float32)
    parts = [
        cv2.remap(
            image, flat[k : k + _REMAPPED, :, 0], flat[k : k + _REMAPPED, :, 1],
            cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE,
        )
        for k in range(0, len(flat), _REMAPPED)
    ]  # fmt: skip
    return np.concatenate(parts).reshape(points.shape[:-1]).astype(np.float64)


def _inside(image: FloatImage, centres: FloatArray, usual: FloatArray) -> FloatArray:
    """Return the median brightness of the inside of each thing."""
    far = _CORE * usual[:, None, None] * np.linspace(0.1, 1.0, _DEPTHS)[None, None, :]
    way = directions()[:: RAYS // 24]
    points = centres[:, None, None] + far[..., None] * way[None, :, None]
    level = np.median(sampled(image, points).reshape(len(centres), -1), axis=1)
    return np.maximum(level, HALF)


def crossings(
    values: FloatArray, near: npt.NDArray[np.int64], step: float, search: float
) -> tuple[FloatArray, FloatArray]:
    """Return where samples along rays fall through the half level, and the blur there.

    Parameters
    ----------
    values : (n, RAYS, samples) float64
        1 inside, 0 outside.
    near : (n, RAYS) int
        Sample near which the edge is looked for.
    step : float
        Distance of samples [px].
    search : float
        How far from there it may be [px].

    Returns
    -------
    rays, blur : (n, RAYS) float64
        Distance from the first sample, and standard deviation of the blur [px]; NaN where a ray
        falls through the level nowhere near.
    """
    falls = (values[:, :, :-1] >= HALF) & (values[:, :, 1:] < HALF)
    place = np.arange(falls.shape[2])[None, None, :]
    away = np.where(falls, np.abs(place + 1 - near[:, :, None]), np.inf)
    best = np.argmin(away, axis=2)[:, :, None]
    found = np.take_along_axis(away, best, 2)[:, :, 0] * step <= search
    before = np.take_along_axis(values, best, 2)[:, :, 0]
    after = np.take_along_axis(values, best + 1, 2)[:, :, 0]
    steep = np.maximum(before - after, 1e-9)
    rays = step * (best[:, :, 0] + (before - HALF) / steep)
    # A step of height 1 blurred by sigma falls by 1 / (sigma sqrt(2 pi)) per pixel.
    blur = step / (steep * np.sqrt(2.0 * np.pi))
    return np.where(found, rays, np.nan), np.where(found, blur, np.nan)


def _widened(touching: Mask, usual: FloatArray) -> Mask:
    """Return the rays that touch something, and those beside them."""
    beside = np.ceil(_BESIDE / (usual * (2.0 * np.pi / RAYS))).astype(int)
    wide = touching.copy()
    for shift in range(1, int(beside.max(initial=0)) + 1):
        far = (beside >= shift)[:, None]
        wide |= far & (np.roll(touching, shift, axis=1) | np.roll(touching, -shift, axis=1))
    return wide


def _median(values: FloatArray, use: Mask) -> FloatArray:
    """Return the median over the rays in use, NaN where there is none."""
    kept = np.where(use, values, np.nan)
    some = np.isfinite(kept).any(axis=1)
    found = np.full(len(kept), np.nan)
    found[some] = np.nanmedian(kept[some], axis=1)
    return found


def smooth_outlines(rays: FloatArray, seen: Mask, blur: float) -> FloatArray:
    """Return smooth closed outlines (n, RAYS) through the rays that are seen.

    Parameters
    ----------
    rays : (n, RAYS) float64
        Distances of the edge [px].
    seen : (n, RAYS) bool
    blur : float
        Standard deviation [px]; what is much finer cannot be seen in the picture and is noise.
    """
    turn = np.arange(RAYS) * (2.0 * np.pi / RAYS)
    orders = np.arange(1, _HARMONICS + 1)
    waves = np.concatenate(
        [np.ones((RAYS, 1)), np.cos(np.outer(turn, orders)), np.sin(np.outer(turn, orders))], axis=1
    )
    around = 2.0 * np.pi * np.maximum(_middle_ray(rays), 1.0)
    fine = np.minimum(_HIDDEN * blur * orders / around[:, None], 10.0)
    stiff = np.concatenate([np.zeros((len(rays), 1)), np.tile(0.5 * fine**4, 2)], axis=1)
    usable = seen | ~seen.any(axis=1, keepdims=True)  # all rays of a thing that is all contact
    value = np.where(np.isfinite(rays), rays, 0.0)
    weight = (usable & np.isfinite(rays)).astype(np.float64)
    fitted = value
    for _ in range(_ROUNDS):
        normal = np.einsum("nr,ri,rj->nij", weight, waves, waves, optimize=True)
        normal += (stiff[:, :, None] * RAYS + 1e-9) * np.eye(waves.shape[1])
        right = np.einsum("nr,nr,ri->ni", weight, value, waves, optimize=True)
        fitted = np.linalg.solve(normal, right[:, :, None])[:, :, 0] @ waves.T
        rest = np.where(weight > 0, np.abs(value - fitted), np.nan)
        scale = 1.5 * _median(rest, weight > 0)[:, None]
        floor = 0.01 * np.abs(fitted).mean(axis=1, keepdims=True) + 1e-6
        scale = np.maximum(np.nan_to_num(scale), floor)
        weight = np.where(
            usable & np.isfinite(rays),
            np.clip(1.0 - ((value - fitted) / (_TUKEY * scale)) ** 2, 0.0, None) ** 2, 0.0,
        )  # fmt: skip
    return np.maximum(fitted, 0.25)


def _middle_ray(rays: FloatArray) -> FloatArray:
    return np.nan_to_num(_median(rays, np.isfinite(rays)))
