"""Rays from the middle of a grain outwards: the picture along them, and smooth outlines."""

from __future__ import annotations

from typing import Final

import cv2
import numpy as np
import numpy.typing as npt

from liggghts_io.photo.grains.separate import HALF
from liggghts_io.photo.light import FloatArray, FloatImage, Mask

RAYS: Final = 96
_HARMONICS: Final = 10  # of the outline: what is finer is noise
_HIDDEN: Final = 4.0  # blurs: waves of an outline that are shorter are half suppressed
_ROUNDS: Final = 4
_TUKEY: Final = 4.0
_REMAPPED: Final = 16  # grains at once; cv2 takes at most 32767 points in a row


def directions() -> FloatArray:
    """Return the directions of the rays (RAYS, 2): to the right and down."""
    turn = np.arange(RAYS) * (2.0 * np.pi / RAYS)
    return np.column_stack([np.cos(turn), np.sin(turn)])


def on_rays(centres: FloatArray, along: FloatArray) -> FloatArray:
    """Return points (n, RAYS, k, 2) at distances (n, RAYS, k) from the centres."""
    return np.asarray(
        centres[:, None, None] + along[..., None] * directions()[None, :, None], dtype=np.float64
    )


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
        scale = 1.5 * median_of(rest, weight > 0)[:, None]
        floor = 0.01 * np.abs(fitted).mean(axis=1, keepdims=True) + 1e-6
        scale = np.maximum(np.nan_to_num(scale), floor)
        weight = np.where(
            usable & np.isfinite(rays),
            np.clip(1.0 - ((value - fitted) / (_TUKEY * scale)) ** 2, 0.0, None) ** 2, 0.0,
        )  # fmt: skip
    return np.maximum(fitted, 0.25)


def median_of(values: FloatArray, use: Mask) -> FloatArray:
    """Return the median over the rays in use, NaN where there is none."""
    kept = np.where(use, values, np.nan)
    some = np.isfinite(kept).any(axis=1)
    found = np.full(len(kept), np.nan)
    found[some] = np.nanmedian(kept[some], axis=1)
    return found


def _middle_ray(rays: FloatArray) -> FloatArray:
    return np.nan_to_num(median_of(rays, np.isfinite(rays)))
