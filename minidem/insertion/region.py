"""Regions of space as scripts define them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from minidem.errors import InputError, UnknownWordError, suggest
from minidem.insertion.region_table import Part, build_table
from minidem.insertion.seeds import ParkMiller, read_seed
from minidem.kernels.columns import (
    HIGH,
    LOW,
    LOWER,
    POSITION,
    RADIUS,
    ROUND_AXIS,
    ROUND_HIGH,
    ROUND_LOW,
    ROUND_RADIUS,
    ROUND_U,
    ROUND_V,
    SHAPE,
    SIDES,
    UPPER,
)
from minidem.kernels.insertion.regions import (
    BLOCK,
    CYLINDER,
    INTERSECT,
    SPHERE,
    UNION,
    match_all,
)
from minidem.words import Words

__all__ = ["STYLES", "Region", "make_region"]

INFINITE = 1.0e20
DEFAULT_SEED = 3012211
_SHAPES = {"block": 6, "cylinder": 6, "sphere": 4}
STYLES = ("block", "cylinder", "sphere", "union", "intersect")
"""Region styles that are understood."""


@dataclass
class Region:
    """A region of space.

    Attributes
    ----------
    part : Part
        Shape, side and parts.
    extent : (2, 3) ndarray or None
        Lower and upper corner of the bounding box, m; None if there is none (side out).
    random : ParkMiller
        Generator of random points in the region.
    """

    part: Part
    extent: NDArray[np.float64] | None
    random: ParkMiller = field(default_factory=lambda: ParkMiller(DEFAULT_SEED))

    def __post_init__(self) -> None:
        """Translate the shape for the kernels."""
        self.table = build_table(self.part)

    def match(self, points: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Tell which points (N, 3) are in the region; surface points are in with side in."""
        array = np.ascontiguousarray(points, dtype=np.float64).reshape(-1, 3)
        found = np.empty(len(array), dtype=np.bool_)
        match_all(self.table, array, found)
        return found


def make_region(
    words: Sequence[str],
    known: Mapping[str, Region],
    box: NDArray[np.float64] | None,
) -> Region:
    """Make a region from the words of a script.

    Parameters
    ----------
    words : sequence of str
        Style and what follows it: ``block 0 1 0 1 0 INF units box side in``.
    known : mapping
        Regions defined before, for union and intersect.
    box : (2, 3) ndarray or None
        Simulation box for ``EDGE``; None before it exists, then ``INF`` and ``EDGE`` are errors.

    Returns
    -------
    Region

    Raises
    ------
    InputError
        With the word and what was expected.
    """
    source = Words(words, "region")
    style = source.take("a region style")
    if style in _SHAPES:
        shape = _SHAPE_READERS[style](source, box)
        parts: list[Region] = []
    elif style in ("union", "intersect"):
        shape = ()
        parts = _parts(source, known)
    else:
        msg = f"unknown region style '{style[:40]}'{suggest(style[:80], STYLES)}"
        raise UnknownWordError(msg)
    interior, seed = _options(source)
    kind = {"block": BLOCK, "cylinder": CYLINDER, "sphere": SPHERE, "union": UNION}
    part = Part(kind.get(style, INTERSECT), interior, shape, tuple(p.part for p in parts))
    extent = _extent(style, shape, parts) if interior else None
    return Region(part, extent, ParkMiller(seed))


def _coordinate(source: Words, box: NDArray[np.float64] | None, side: int, d: int) -> float:
    """Read a number, INF or EDGE; side is 0 for a lower and 1 for an upper bound."""
    if source.peek() in ("INF", "EDGE"):
        word = source.take("a number")
        if box is None:
            msg = f"region: {word} needs the simulation box; put the region after create_box"
            raise InputError(msg)
        return (INFINITE if side else -INFINITE) if word == "INF" else float(box[side, d])
    return source.number()


def _block(source: Words, box: NDArray[np.float64] | None) -> tuple[float, ...]:
    shape = tuple(_coordinate(source, box, i % SIDES, i // SIDES) for i in range(SHAPE))
    for axis, low, high in zip("xyz", shape[LOW::SIDES], shape[HIGH::SIDES], strict=True):
        if low > high:
            msg = f"region block: {axis} bounds {low} {high} are reversed"
            raise InputError(msg)
    return shape


def _cylinder(source: Words, box: NDArray[np.float64] | None) -> tuple[float, ...]:
    axis = "xyz".find(source.choice(("x", "y", "z")))
    first, second, radius = source.number(), source.number(), source.positive()
    low = _coordinate(source, box, LOWER, axis)
    high = _coordinate(source, box, UPPER, axis)
    return (float(axis), first, second, radius, low, high)


def _sphere(source: Words, box: NDArray[np.float64] | None) -> tuple[float, ...]:
    del box
    return (source.number(), source.number(), source.number(), source.positive())


_SHAPE_READERS = {"block": _block, "cylinder": _cylinder, "sphere": _sphere}


def _parts(source: Words, known: Mapping[str, Region]) -> list[Region]:
    count = source.count()
    if not 2 <= count <= 1000:
        msg = f"region union and intersect need at least 2 regions, got {count}"
        raise InputError(msg)
    parts = []
    for _ in range(count):
        name = source.take("the name of a region")
        if name not in known:
            msg = f"unknown region '{name[:40]}'{suggest(name[:80], known)}"
            raise InputError(msg)
        parts.append(known[name])
    return parts


def _options(source: Words) -> tuple[bool, int]:
    interior, seed = True, DEFAULT_SEED
    while not source.done():
        word = source.choice(("units", "side", "seed", "volume_limit", "move", "rotate"))
        if word in ("move", "rotate"):
            msg = f"region {word}: regions that move are not supported"
            raise UnknownWordError(msg)
        if word == "units":
            source.choice(("box",))
        elif word == "side":
            interior = source.choice(("in", "out")) == "in"
        elif word == "seed":
            seed = read_seed(source.take("a seed"))
        else:
            source.positive()
    return interior, seed


def _extent(
    style: str, shape: tuple[float, ...], parts: list[Region]
) -> NDArray[np.float64] | None:
    if style == "block":
        return np.array([shape[LOW::SIDES], shape[HIGH::SIDES]])
    if style == "sphere":
        centre = np.array(shape[POSITION])
        return np.array([centre - shape[RADIUS], centre + shape[RADIUS]])
    if style == "cylinder":
        axis = int(shape[ROUND_AXIS])
        extent = np.empty((2, 3))
        others = [d for d in range(3) if d != axis]
        for d, middle in zip(others, (shape[ROUND_U], shape[ROUND_V]), strict=True):
            extent[:, d] = (middle - shape[ROUND_RADIUS], middle + shape[ROUND_RADIUS])
        extent[:, axis] = (shape[ROUND_LOW], shape[ROUND_HIGH])
        return extent
    boxes = [part.extent for part in parts if part.extent is not None]
    if style == "union":
        if len(boxes) < len(parts):
            return None
        return np.array([np.min(boxes, axis=0)[LOWER], np.max(boxes, axis=0)[UPPER]])
    if not boxes:
        return None
    return np.array([np.max(boxes, axis=0)[LOWER], np.min(boxes, axis=0)[UPPER]])
