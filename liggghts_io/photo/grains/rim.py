"""How bright grains are just inside their edge, which shading makes another than their middle.

The edge of a ball lies where the picture is half as bright as its rim, be the rim darker than the
middle (a glossy bead), brighter (a lit ball) or of another kind (a glass bead with a bright spot).
So the brightness across the edge, the median over all directions, is compared with a blurred step
on whose inner side brightness rises or falls evenly.
"""

from __future__ import annotations

from typing import Final, Literal

import numpy as np
from scipy.special import ndtr

from liggghts_io.photo.light import FloatArray, Mask

STEP: Final = 0.25  # blurs between samples across an edge
REACH: Final = 6.0  # blurs that are sampled on both sides
MOST_BLUR: Final = 0.12  # of a radius: beyond it a grain has no inside that is free of the edge
HIDING_BLUR: Final = 0.18  # of a radius: beyond it even grains look shaded

_BLURS: Final = np.linspace(0.5, 1.7, 25)  # that are tried, of the blur that the half level tells
_PLACES: Final = np.linspace(-1.0, 1.0, 41)  # of the edge, blurs from where it is steepest
_INSIDE: Final = 2.0  # blurs inside and outside the edge that are compared
_OUTSIDE: Final = 3.0
_LEAST_RAYS: Final = 16  # on which an edge must be seen
_LEAST_STEP: Final = 0.1  # parts of the usual grain
_CLEARER: Final = 0.5  # of the misfit without shading, has a fit with shading
_SLIGHT: Final = 0.03  # other brightness of the rim that makes less difference than noise
_MUCH: Final = 0.2  # that blur does not feign: even grains have less

Shade = Literal["none", "inside", "outside"]
_MAD: Final = 1.4826


def rims(
    across: FloatArray, core: FloatArray, like: Mask, bend: float, *, blurred: bool
) -> FloatArray | None:
    """Return twice the brightness at the edge of each grain (n,), None where shading is slight.

    Parameters
    ----------
    across : (n, RAYS, samples) float64
        Brightness across the half level, from `REACH` blurs inside to as many outside; NaN on
        rays that meet a neighbour.
    core : (n,) float64
        Brightness of the middle of each grain.
    like : (n,) bool
        Which look like grains; dust and ticks of a ruler tell nothing of their shading.
    bend : float
        Those blurs over the usual radius.
    blurred : bool
        Whether these blurs are less than the picture's, for want of room in the grains; then only
        a rim that is much brighter or darker is believed.
    """
    many = like & (np.isfinite(across[:, :, 0]).sum(axis=1) >= _LEAST_RAYS)
    if not many.any():
        return None
    profiles = np.nanmedian(across[many], axis=1)
    usual = np.median(profiles, axis=0)[None]
    inner = np.abs(np.arange(usual.shape[1]) * STEP - REACH) < REACH - _OUTSIDE
    about = float(np.argmin(np.where(inner, np.gradient(usual[0]), 0.0)) * STEP - REACH)

    def misfit(shade: Shade) -> tuple[float, float]:
        tried = [(_fitted(usual, about, blur, bend, shade)[1], blur) for blur in _BLURS]
        return min((float(np.sqrt(rest[0])), float(blur)) for rest, blur in tried)

    plain, _ = misfit("none")
    shades: tuple[Shade, ...] = ("inside", "outside")
    (rest, blur), shade = min((misfit(one), one) for one in shades)
    clear = rest < _CLEARER * plain
    shade = shade if clear else "none"
    edge = 2.0 * _fitted(profiles, about, blur, bend, shade)[0]
    middle = core[many]
    ratio = float(np.median(edge / middle))
    least = _SLIGHT if clear and not blurred else _MUCH
    if abs(ratio - 1.0) < least and (least == _MUCH or _scatter(middle) < _SLIGHT):
        return None
    # Grains of one kind are shaded alike: then the middle tells the rim more surely.
    level = core * ratio
    if _scatter(edge) < _scatter(middle):
        level[many] = edge
    return np.maximum(level, 2.0 * _LEAST_STEP)


def _scatter(values: FloatArray) -> float:
    middle = float(np.median(values))
    return _MAD * float(np.median(np.abs(values - middle))) / max(abs(middle), 1e-9)


def _fitted(
    profiles: FloatArray, about: float, blur: float, bend: float, shade: Shade
) -> tuple[FloatArray, FloatArray]:
    """Return the brightness at the edge of each profile (n,), and how badly it is met.

    Parameters
    ----------
    profiles : (n, samples) float64
    about : float
        Where the edge is, in units of the samples' blur.
    blur : float
        Standard deviation, in these units.
    bend : float
        One of these units over the radius.
    """
    place = np.arange(profiles.shape[1]) * STEP - REACH - about
    near = (place > -_INSIDE) & (place < _OUTSIDE)
    values = profiles[:, near].T
    best = np.full(len(profiles), np.inf)
    edge = np.zeros(len(profiles))
    for middle in _PLACES:
        terms = _terms((place[near] - middle) / blur, blur * bend, shade)
        found = np.linalg.pinv(terms) @ values
        rest = np.mean((values - terms @ found) ** 2, axis=0)
        at = (_terms(np.zeros(1), 0.0, shade) @ found)[0]
        better = (rest < best) & (found[0] > _LEAST_STEP)
        best[better], edge[better] = rest[better], at[better]
    return edge, best


def _terms(x: FloatArray, bend: float, shade: Shade) -> FloatArray:
    """Return a blurred step down at 0 at places x [blurs], and a blurred ramp on one side of it.

    The edge of a disc, bent by a blur over its radius, is a little darker than a straight one.
    """
    inside = ndtr(-x)
    hill = np.exp(-0.5 * x**2) / np.sqrt(2.0 * np.pi)
    terms = [inside - 0.5 * bend * hill]
    if shade == "inside":
        terms.append(hill - x * inside)
    if shade == "outside":
        terms += [np.ones_like(x), hill + x * ndtr(x)]
    return np.stack(terms, axis=1)
