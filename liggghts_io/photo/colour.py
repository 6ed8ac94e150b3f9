"""One channel out of three: the one in which the things in a photograph stand out."""

from __future__ import annotations

from typing import Final

import cv2
import numpy as np
import numpy.typing as npt

from liggghts_io.photo.light import FloatArray, FloatImage

_SMOOTH: Final = 1.0  # px, before slopes are taken
_SLIGHT: Final = 0.03  # of the most that steep places differ: directions in colour below show noise
_SPECK: Final = 24.0  # grey levels by which a pixel differs from those around it
_CLEAR: Final = 8.0  # usual differences of that kind: more than noise
_MANY_SPECKS: Final = 0.003  # of the pixels, above what edges and dust have
_MAD: Final = 1.4826


def grey_of(colour: npt.NDArray[np.uint8]) -> FloatImage:
    """Return the one channel in which the things in a picture stand out most.

    Brightness, unless colours differ more: then the direction in colour along which most of the
    steep places differ.

    Parameters
    ----------
    colour : (rows, columns, 3) uint8

    Returns
    -------
    (rows, columns) float32
        Grey levels.
    """
    if _is_grey(colour):
        return _brightness(colour)
    values, ways, plain = _ways(colour)
    return _brightness(colour) if plain > 0.5 * values[0] else _along(colour, ways[0])


def channels_of(colour: npt.NDArray[np.uint8]) -> list[FloatImage]:
    """Return brightness, and of a colour picture all ways in which steep places differ, too.

    Each shows other things: in one a heap stands out from the wall, in another its plate.

    Parameters
    ----------
    colour : (rows, columns, 3) uint8

    Returns
    -------
    list of (rows, columns) float32
        Grey levels.
    """
    if _is_grey(colour):
        return [_brightness(colour)]
    values, ways, _ = _ways(colour)
    found = [_along(colour, ways[k]) for k in range(3) if values[k] > _SLIGHT * values[0]]
    return [_brightness(colour), *found]


def _is_grey(colour: npt.NDArray[np.uint8]) -> bool:
    red, green, blue = (colour[:, :, k] for k in range(3))
    return bool((red == green).all() and (green == blue).all())


def _brightness(colour: npt.NDArray[np.uint8]) -> FloatImage:
    return np.asarray(cv2.cvtColor(colour, cv2.COLOR_RGB2GRAY), dtype=np.float32)


def _along(colour: npt.NDArray[np.uint8], way: FloatArray) -> FloatImage:
    """Return a picture seen along a direction in colour, from 0 upwards."""
    along = colour.astype(np.float32) @ way.astype(np.float32)
    return np.asarray(along - along.min(), dtype=np.float32)


def _ways(colour: npt.NDArray[np.uint8]) -> tuple[FloatArray, FloatArray, float]:
    """Return how much steep places differ (3,), along which directions (3, 3), and in brightness.

    The direction in which they differ most comes first.
    """
    step = max(1, round(np.sqrt(colour.shape[0] * colour.shape[1] / 1e6)))
    small = cv2.GaussianBlur(colour.astype(np.float32), (0, 0), _SMOOTH)[::step, ::step]
    across = np.concatenate(
        [np.diff(small, axis=0).reshape(-1, 3), np.diff(small, axis=1).reshape(-1, 3)]
    )
    size = np.einsum("ij,ij->i", across, across)
    across = across[size >= np.quantile(size, 0.98)].astype(np.float64)
    values, ways = np.linalg.eigh(across.T @ across)
    values, ways = values[::-1], ways.T[::-1]
    ways = ways * np.where(ways.sum(axis=1) >= 0.0, 1.0, -1.0)[:, None]
    plain = np.array([0.299, 0.587, 0.114])
    plain /= np.linalg.norm(plain)
    return values, ways, float(plain @ (across.T @ across) @ plain)


def without_specks(grey: FloatImage) -> FloatImage:
    """Return a picture whose single wrong pixels are replaced by the median around them.

    Pictures that have only few of them stay as they are.
    """
    usual = np.asarray(cv2.medianBlur(grey, 3), dtype=np.float32)
    away = np.abs(grey - usual)
    specks = away > max(_SPECK, _CLEAR * _MAD * float(np.median(away)))
    if float(specks.mean()) < _MANY_SPECKS:
        return grey
    return np.where(specks, cv2.medianBlur(usual, 3), grey)
