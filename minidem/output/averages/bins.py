"""Slabs, columns or blocks that particles are sorted into by their positions."""

from __future__ import annotations

from math import prod
from typing import Final

import numpy as np

from minidem.errors import InputError
from minidem.kernels.columns import POSITION
from minidem.record import record
from minidem.words import Words, number
from minidem.world.state import Floats, Ints
from minidem.world.world import World

__all__ = ["Axis", "Bins", "read_axes"]

_AXES: Final = ("x", "y", "z")
_MOST = 1_000_000  # bins


@record(frozen=True)
class Axis:
    """A direction that is cut into bins.

    Attributes
    ----------
    axis : int
        0 to 2.
    origin : str or float
        ``lower``, ``center``, ``upper`` or a place, m.
    width : float
        m; parts of the box if bins are.
    """

    axis: int
    origin: str | float
    width: float


@record(frozen=True)
class Bins:
    """Bins of a box.

    Attributes
    ----------
    axes : tuple of Axis
        Directions that are cut.
    reduced : bool
        Whether lengths are parts of the box.
    offset : tuple of float
        Where the first bin begins.
    layers : tuple of int
        Number of bins in each direction.
    volume : float
        Of a bin, m3.
    """

    axes: tuple[Axis, ...]
    reduced: bool
    offset: tuple[float, ...]
    layers: tuple[int, ...]
    volume: float

    @classmethod
    def of(cls, world: World, axes: tuple[Axis, ...], *, reduced: bool) -> Bins:
        """Lay bins over the present box, as LIGGGHTS does.

        Raises
        ------
        InputError
            If there are too many.
        """
        box = world.need_box()
        volume = box.volume
        offset, layers = [], []
        for one in axes:
            lo, hi = (0.0, 1.0) if reduced else (box.lo[one.axis], box.hi[one.axis])
            places = {"lower": lo, "upper": hi, "center": 0.5 * (lo + hi)}
            origin = places[one.origin] if isinstance(one.origin, str) else one.origin
            first, last = _edges(float(origin), one.width, float(lo), float(hi))
            offset.append(first)
            layers.append(int((last - first) * (1.0 / one.width) + 0.5))
            volume *= one.width / (hi - lo)
        if prod(layers) > _MOST:
            msg = f"fix ave/spatial: {prod(layers)} bins are more than {_MOST}; make them wider"
            raise InputError(msg)
        return cls(axes, reduced, tuple(offset), tuple(layers), float(volume))

    @property
    def count(self) -> int:
        """Number of bins."""
        return prod(self.layers)

    def centres(self) -> Floats:
        """Return the places of the bins, shape (count, directions)."""
        lines = [
            start + (np.arange(layers) + 0.5) * one.width
            for start, layers, one in zip(self.offset, self.layers, self.axes, strict=True)
        ]
        grids = np.meshgrid(*lines, indexing="ij")
        return np.stack([grid.ravel() for grid in grids], axis=1)

    def of_particles(self, world: World) -> Ints:
        """Return the bin of every particle."""
        box = world.need_box()
        period = box.period()
        at = world.state.row[: world.state.n, POSITION].copy()
        at += period * ((at < box.lo) * 1.0 - (at >= box.hi))
        if self.reduced:
            at = (at - box.lo) / (box.hi - box.lo)
        found = np.zeros(len(at), np.int64)
        for start, layers, one in zip(self.offset, self.layers, self.axes, strict=True):
            layer = ((at[:, one.axis] - start) * (1.0 / one.width)).astype(np.int64)
            found = found * layers + np.clip(layer, 0, layers - 1)
        return found


def _edges(origin: float, width: float, lo: float, hi: float) -> tuple[float, float]:
    """Return the edges of bins next to the box, outside or on it."""
    inverse = 1.0 / width
    first = origin + int((lo - origin) * inverse) * width
    if origin >= lo and first > lo:
        first -= width
    last = origin + int((hi - origin) * inverse) * width
    if origin < hi and last < hi:
        last += width
    return first, last


def read_axes(words: Words) -> tuple[Axis, ...]:
    """Read one to three groups of direction, origin and width.

    Raises
    ------
    InputError
        If a direction comes twice.
    """
    found: list[Axis] = []
    while not found or words.peek() in _AXES:
        axis = _AXES.index(words.choice(_AXES, "direction"))
        word = words.take("lower, center, upper or a place")
        origin = word if word in ("lower", "center", "upper") else number(word, "origin")
        if any(one.axis == axis for one in found):
            msg = f"fix ave/spatial: direction {_AXES[axis]} comes twice"
            raise InputError(msg)
        found.append(Axis(axis, origin, words.positive()))
    return tuple(found)
