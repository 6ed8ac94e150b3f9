"""Shadows that grains throw to one side: no part of them, though as dark.

A lamp beside the ground draws all grains out in one direction. Their rim towards the lamp shows
them alone, so an ellipse through it takes the place of the outline on the other side.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import cv2
import numpy as np
import numpy.typing as npt

from liggghts_io.photo.grains.outlines import Outlines
from liggghts_io.photo.grains.rays import RAYS, directions, on_rays, sampled
from liggghts_io.photo.light import FloatArray, FloatImage, Mask

_FEWEST: Final = 8  # grains that tell a direction
_MOSTLY_FREE: Final = 0.8  # of the outline: such grains tell the direction
_DRAWN_OUT: Final = 0.015  # second harmonic of the radii that grains have in common
_DARKER: Final = 0.08  # first harmonic of the brightness beside them, parts of the contrast
_BENEATH: Final = 0.85  # cosine of the angle to it, where a shadow lies beside a grain
_PALE: Final = 0.35  # darkness of one that is hardly a part of the outline, which lies at a half
_FAINT: Final = 0.005  # the same of a shadow too pale to be taken for a part of grains
_LIKELY: Final = 2.0  # standard errors of that
_SURE: Final = 3.0  # standard errors of both, that chance exceeds once in ten thousand photographs
_BESIDE: Final = (1.15, 1.25, 1.35)  # radii
_WITHIN: Final = (0.8, 0.9)
_PALER: Final = 0.05  # the same within them, where their shadow's end is taken for a part of them
_FACING: Final = -0.15  # cosine of the angle between the shadow and a rim that faces the lamp
_ROUND: Final = 2.5  # longest axis over shortest of what is believed
_WORTH: Final = 0.98  # of the area with the shadow: what shadows leave of it, at most
_LARGER: Final = 1.03  # of the area with the shadow


def without_shadows(image: FloatImage, outlines: Outlines, grains: Mask) -> Outlines:
    """Return outlines without the shadows that grains throw, the same ones where they throw none.

    Parameters
    ----------
    image : (rows, columns) float32
        0 on the ground, 1 in the grains.
    outlines : Outlines
    grains : (n,) bool
        Which of them are grains.
    """
    which = np.flatnonzero(grains & (outlines.free > _MOSTLY_FREE))
    if len(which) < _FEWEST:
        return outlines
    ways = _ways(image, outlines, which)
    if not ways:
        return outlines
    tried = [_completed(outlines, np.flatnonzero(grains), way) for way in ways]
    # The far end of a shadow is a rim of the grain, too, or longer than that.
    best = min(tried, key=lambda one: float(np.median(one.areas[grains])))
    # A bright spot on one side of every grain is no shadow: then nothing comes off.
    worth = np.median(best.areas[grains] / outlines.areas[grains]) < _WORTH
    return best if worth else outlines


def _ways(image: FloatImage, outlines: Outlines, which: npt.NDArray[np.int64]) -> list[FloatArray]:
    """Return the directions (2,) to which shadows may fall, none if they do not."""
    angle = 2.0 * np.pi * np.arange(RAYS) / RAYS
    radii = outlines.radii[which]
    usual = radii.mean(axis=1, keepdims=True)
    beside, within = (
        sampled(image, on_rays(outlines.centres[which], usual[:, :, None] * _at(rings)))
        for rings in (_BESIDE, _WITHIN)
    )
    dark = 2.0 * (beside.mean(axis=2) * np.exp(1j * angle)).mean(axis=1)
    darker = _common(dark, _DARKER)
    if darker is not None:
        way = np.array([darker.real, darker.imag]) / abs(darker)
        beneath = directions() @ way > _BENEATH
        pale = float(np.median(beside[:, beneath, 0])) < _PALE
        return [] if pale else [way]
    longer = _common(2.0 * (radii / usual * np.exp(2j * angle)).mean(axis=1), _DRAWN_OUT)
    turn = 0.5 * np.angle(longer) if longer is not None else None
    if turn is None:
        paler = _common(2.0 * (within.mean(axis=2) * np.exp(1j * angle)).mean(axis=1), _PALER)
        turn = np.angle(paler) if paler is not None and not _own_shade(dark, paler) else None
    if turn is None:
        return []
    way = np.array([np.cos(turn), np.sin(turn)])
    return [way, -way]


def _at(rings: tuple[float, ...]) -> FloatArray:
    """Return circles (1, RAYS, k) of these radii."""
    return np.broadcast_to(np.array(rings), (1, RAYS, len(rings)))


def _common(each: npt.NDArray[np.complex128], least: float) -> complex | None:
    """Return the mean of complex numbers (n,) if it is surely more than `least`."""
    mean = complex(each.mean())
    error = float(np.sqrt(np.mean(np.abs(each - mean) ** 2) / len(each)))
    return mean if abs(mean) > max(least, _SURE * error) else None


def _own_shade(dark: npt.NDArray[np.complex128], paler: complex) -> bool:
    """Whether the ground is darker beside the darker side of grains: they are shaded as balls are.

    Where the end of a shadow was taken for a part of them, it is their paler side.
    """
    along = (dark * np.conj(paler)).real / abs(paler)
    error = float(along.std()) / np.sqrt(len(along))
    return bool(along.mean() > max(_FAINT, _LIKELY * error))


def _completed(outlines: Outlines, which: npt.NDArray[np.int64], way: FloatArray) -> Outlines:
    """Return outlines whose side in the direction of shadows is that of an ellipse."""
    points = outlines.points()[which]
    tangent = np.roll(points, -2, axis=1) - np.roll(points, 2, axis=1)
    normal = np.stack([tangent[..., 1], -tangent[..., 0]], axis=-1)
    facing = normal @ way / np.maximum(np.linalg.norm(normal, axis=-1), 1e-9) < _FACING
    centres, radii = outlines.centres.copy(), outlines.radii.copy()
    for k, rim, seen in zip(which, points, facing, strict=True):
        found = _ellipse(rim[seen], float(outlines.areas[k]))
        if found is not None:
            centres[k], radii[k] = found
    return replace(outlines, centres=centres, radii=radii)


def _ellipse(rim: FloatArray, most: float) -> tuple[FloatArray, FloatArray] | None:
    """Return centre (2,) and radii (RAYS,) of the ellipse through a rim (n, 2), if it is a grain's.

    Parameters
    ----------
    rim : (n, 2) float64
    most : float
        Area with the shadow [px^2].
    """
    if len(rim) < RAYS // 5:
        return None
    middle = rim.mean(axis=0)
    (x, y), axes, turn = cv2.fitEllipseDirect((rim - middle).astype(np.float32))
    a, b = 0.5 * axes[0], 0.5 * axes[1]
    if not 0.0 < b <= _ROUND * a or not 0.0 < a <= _ROUND * b or np.pi * a * b > _LARGER * most:
        return None
    c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    right, down = directions().T
    across = np.hypot((right * c + down * s) / a, (down * c - right * s) / b)
    return middle + np.array([x, y]), 1.0 / across
