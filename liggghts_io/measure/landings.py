"""Where grains land: from the plane at which they were counted along their free fall."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from liggghts_io.measure.counts import Count, FloatArray

BoolArray: TypeAlias = npt.NDArray[np.bool_]

_GRAVITY: Final = 9.81


class Opening(NamedTuple):
    """The mouth of a box.

    Attributes
    ----------
    near_m, far_m : float
        Its walls, along x [m].
    width_m : float
        Across, its middle at y = 0 [m].
    height_m : float
        [m]
    """

    near_m: float
    far_m: float
    width_m: float
    height_m: float = 0.0


def landing_x(count: Count, height_m: float) -> tuple[FloatArray, FloatArray]:
    """Return where counted grains fall through another height [m].

    Parameters
    ----------
    count : Count
        Falling grains, at any height.
    height_m : float
        Below it, or so little above that they fell there already.

    Returns
    -------
    (n,) float64, (n,) float64
        x and y [m]; NaN for a grain that never was that high.

    Notes
    -----
    Free fall: z + v t - g t^2 / 2 = h on the falling branch. Not in it: collisions on the way, and
    gravity that leans.
    """
    (x, y, z), (vx, vy, vz) = count.position_m.T, count.velocity_m_s.T
    square = vz**2 + 2.0 * _GRAVITY * (z - height_m)
    time = (vz + np.sqrt(np.where(square >= 0.0, square, np.nan))) / _GRAVITY
    return x + vx * time, y + vy * time


def caught(count: Count, box: Opening) -> BoolArray:
    """Return which counted grains fall into a box, (n,), as if it stood alone."""
    x, y = landing_x(count, box.height_m)
    inside = (box.near_m <= x) & (x < box.far_m) & (np.abs(y) <= 0.5 * box.width_m)
    return np.asarray(inside, dtype=np.bool_)


def masses_in(count: Count, boxes: Sequence[Opening]) -> list[float]:
    """Return the mass that falls into each box [kg].

    Parameters
    ----------
    count : Count
        Landings, counted above all rims.
    boxes : sequence of Opening
        Anywhere; each as if it stood alone.
    """
    return [float(count.mass_kg[caught(count, box)].sum()) for box in boxes]
