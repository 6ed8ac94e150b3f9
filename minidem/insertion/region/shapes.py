"""Shapes of regions, from the words of a script to numbers and bounding boxes."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, floor, pi, sin

import numpy as np
from numpy.typing import NDArray

from minidem.errors import InputError, UnknownWordError
from minidem.kernels.columns import LOWER, UPPER, X, Y, Z
from minidem.kernels.insertion.shape_columns import BLOCK_SHAPE, HIGH, LOW, SIDES
from minidem.record import record
from minidem.words import Words

__all__ = ["READERS", "Frame", "Shape"]

INFINITE = 1.0e20
_AXES = ("x", "y", "z")
_NARROWEST = 5.0  # degrees, of a wedge
_HALF = 180.0  # degrees
_QUARTER = 0.5 * pi
Floats = NDArray[np.float64]


@record(frozen=True)
class Frame:
    """What the numbers of a shape refer to.

    Attributes
    ----------
    box : (2, 3) ndarray or None
        Simulation box for ``INF`` and ``EDGE``; None before it exists.
    scale : ndarray, shape (3,)
        Box units per unit of the numbers along each axis, m.
    value : callable
        Gives the value of an equal-style variable now.
    """

    box: Floats | None
    scale: Floats
    value: Callable[[str], float]


@record(frozen=True)
class Shape:
    """Numbers of a shape.

    Attributes
    ----------
    numbers : tuple of float
        As `minidem.kernels.insertion.shape_columns` has them.
    extent : (2, 3) ndarray or None
        Bounding box, m; None if there is none.
    radius : str
        Variable that gives the radius; empty for none.
    """

    numbers: tuple[float, ...]
    extent: Floats | None
    radius: str = ""


def _coordinate(source: Words, frame: Frame, side: int, d: int) -> float:
    """Read a number, INF or EDGE; side is 0 for a lower and 1 for an upper bound."""
    if source.peek() in ("INF", "EDGE"):
        word = source.take("a number")
        if frame.box is None:
            msg = f"region: {word} needs the simulation box; put the region after create_box"
            raise InputError(msg)
        return (INFINITE if side else -INFINITE) if word == "INF" else float(frame.box[side, d])
    return float(frame.scale[d]) * source.number()


def _bounds(source: Words, frame: Frame, style: str, *, flat: bool) -> tuple[float, ...]:
    """Read the six bounds of a block or prism."""
    found = tuple(_coordinate(source, frame, i % SIDES, i // SIDES) for i in range(BLOCK_SHAPE))
    for axis, low, high in zip(_AXES, found[LOW::SIDES], found[HIGH::SIDES], strict=True):
        if low > high or (low == high and not flat):
            fault = "are reversed" if low > high else "leave it no thickness"
            msg = f"region {style}: {axis} bounds {low} {high} {fault}"
            raise InputError(msg)
    return found


def _block(source: Words, frame: Frame) -> Shape:
    found = _bounds(source, frame, "block", flat=True)
    return Shape(found, np.array([found[LOW::SIDES], found[HIGH::SIDES]]))


def _axis(source: Words) -> int:
    return _AXES.index(source.choice(_AXES, "axis"))


def _round_extent(axis: int, centre: tuple[float, float], radius: float, ends: Floats) -> Floats:
    """Return the bounding box of a cylinder or cone."""
    extent = np.empty((2, 3))
    others = [d for d in range(3) if d != axis]
    for d, middle in zip(others, centre, strict=True):
        extent[:, d] = (middle - radius, middle + radius)
    extent[:, axis] = ends
    return extent


def _centre(source: Words, frame: Frame, axis: int) -> tuple[float, float]:
    """Read the place of an axis, in the two other directions."""
    first, second = (d for d in range(3) if d != axis)
    return frame.scale[first] * source.number(), frame.scale[second] * source.number()


def _radius(source: Words, frame: Frame) -> tuple[float, str]:
    """Read a radius, or a variable that gives it."""
    if not source.peek().startswith("v_"):
        return float(frame.scale[X]) * source.positive(), ""
    name = source.variable()
    return float(frame.scale[X]) * frame.value(name), name


def _cylinder(source: Words, frame: Frame) -> Shape:
    axis = _axis(source)
    centre = _centre(source, frame, axis)
    radius, variable = _radius(source, frame)
    low = _coordinate(source, frame, LOWER, axis)
    high = _coordinate(source, frame, UPPER, axis)
    extent = _round_extent(axis, centre, radius, np.array([low, high]))
    return Shape((float(axis), *centre, radius, low, high), extent, variable)


def _cone(source: Words, frame: Frame) -> Shape:
    axis = _axis(source)
    centre = _centre(source, frame, axis)
    scale = frame.scale[Y if axis == X else X]
    radii = scale * source.number(), scale * source.number()
    if min(radii) < 0.0 or max(radii) == 0.0:
        msg = f"region cone: radii {radii[0]:g} {radii[1]:g} make no cone; one must be above zero"
        raise InputError(msg)
    edge = source.peek() == "EDGE"
    low = _coordinate(source, frame, LOWER, axis)
    if (edge and source.peek() not in ("EDGE", "INF")) or (axis == Y and source.peek() == "INF"):
        msg = (
            "region cone: LIGGGHTS 3.8.0 takes the face of the box as upper bound here, whatever "
            "is given; write EDGE for it, or numbers for both bounds"
        )
        raise UnknownWordError(msg)
    high = _coordinate(source, frame, UPPER, axis)
    if low >= high:
        msg = f"region cone: bounds {low:g} {high:g} leave it no length"
        raise InputError(msg)
    extent = _round_extent(axis, centre, max(radii), np.array([low, high]))
    return Shape((float(axis), *centre, radii[0], low, high, radii[1]), extent)


def _sphere(source: Words, frame: Frame) -> Shape:
    centre = frame.scale * np.array(source.numbers(3))
    radius, variable = _radius(source, frame)
    extent = np.array([centre - radius, centre + radius])
    return Shape((*centre.tolist(), radius), extent, variable)


def _plane(source: Words, frame: Frame) -> Shape:
    point = frame.scale * np.array(source.numbers(3))
    normal = frame.scale * np.array(source.numbers(3))
    x, y, z = normal.tolist()
    size = float(np.sqrt(x * x + y * y + z * z))
    if not 0.0 < size < np.inf:
        msg = f"region plane: the normal {x:g} {y:g} {z:g} has no direction"
        raise InputError(msg)
    return Shape((*point.tolist(), *(normal / size).tolist()), None)


def _prism(source: Words, frame: Frame) -> Shape:
    found = _bounds(source, frame, "prism", flat=False)
    low, high = np.array(found[LOW::SIDES]), np.array(found[HIGH::SIDES])
    xy, xz = frame.scale[X] * source.number(), frame.scale[X] * source.number()
    yz = frame.scale[Y] * source.number()
    endless = (low == -INFINITE) & (high == INFINITE)
    for tilt, one, other in ((xy, X, Y), (xz, X, Z), (yz, Y, Z)):
        if tilt and (endless[one] or endless[other]):
            msg = f"region prism: a side from INF to INF cannot be tilted (by {tilt:g})"
            raise InputError(msg)
    size = high - low
    a, b, c = np.array([size[X], 0, 0]), np.array([xy, size[Y], 0]), np.array([xz, yz, size[Z]])
    inverse = (
        1.0 / size[X],
        -xy / (size[X] * size[Y]),
        (xy * yz - xz * size[Y]) / (size[X] * size[Y] * size[Z]),
        1.0 / size[Y],
        -yz / (size[Y] * size[Z]),
        1.0 / size[Z],
    )
    normals = [_unit(one, other) for one, other in ((a, b), (c, a), (b, c))]
    # as LIGGGHTS has it: too large where tilts have different signs
    lower = [min(low[X], low[X] + xy), min(low[Y], low[Y] + yz), low[Z]]
    upper = [max(high[X], high[X] + xy), max(high[Y], high[Y] + yz), high[Z]]
    lower[X], upper[X] = min(lower[X], lower[X] + xz), max(upper[X], upper[X] + xz)
    numbers = (low, low + a + b + c, inverse, *normals, a, b, c)
    return Shape(
        tuple(float(number) for part in numbers for number in part), np.array([lower, upper])
    )


def _unit(one: Floats, other: Floats) -> Floats:
    """Return the direction across two edges."""
    across = np.cross(one, other)
    x, y, z = across.tolist()
    found: Floats = across * (1.0 / np.sqrt(x * x + y * y + z * z))
    return found


def _wedge(source: Words, frame: Frame) -> Shape:
    source.expect("axis")
    axis = _axis(source)
    source.expect("center")
    centre = _centre(source, frame, axis)
    source.expect("radius")
    radius = float(frame.scale[Y if axis == X else X]) * source.positive()
    source.expect("bounds")
    low = _coordinate(source, frame, LOWER, axis)
    high = _coordinate(source, frame, UPPER, axis)
    source.expect("angle0")
    start = source.number() * pi / _HALF
    source.expect("angle")
    width = source.number()
    if not _NARROWEST <= width <= 2.0 * _HALF:
        msg = f"region wedge: an angle of {width:g} degrees is not between 5 and 360"
        raise InputError(msg)
    angle = width * pi / _HALF
    end = start + angle
    normals = (sin(start), -cos(start), -sin(end), cos(end))
    numbers = (float(axis), *centre, radius, low, high, *normals, float(angle > pi))
    return Shape(numbers, _wedge_extent(axis, centre, radius, (low, high), (start, end)))


def _wedge_extent(
    axis: int,
    centre: tuple[float, float],
    radius: float,
    ends: tuple[float, float],
    angles: tuple[float, float],
) -> Floats:
    """Return the bounding box of a wedge; it is that of LIGGGHTS, which may be too small."""
    start, end = angles
    along, across = [0.0, cos(start), cos(end)], [0.0, sin(start), sin(end)]
    quarter = min(0, floor(start / _QUARTER))
    for _ in range(3):
        phi = quarter * _QUARTER
        if start <= phi <= end:
            along.append(cos(phi))
            across.append(sin(phi))
        quarter = int(quarter + _QUARTER)
    first = [centre[0] + min(along) * radius, centre[0] + max(along) * radius]
    second = [centre[1] + min(across) * radius, centre[1] + max(across) * radius]
    if axis == Y:
        first = [centre[0] + min(across) * radius, centre[0] + max(across) * radius]
        second = [centre[1] + min(along) * radius, centre[1] + max(along) * radius]
    others = [d for d in range(3) if d != axis]
    extent = np.empty((2, 3))
    extent[:, axis] = ends
    extent[:, others[0]], extent[:, others[1]] = first, second
    return extent


READERS = {
    "block": _block, "cylinder": _cylinder, "sphere": _sphere, "cone": _cone, "prism": _prism,
    "plane": _plane, "wedge": _wedge,
}  # fmt: skip
"""Style of a primitive region to what reads its words."""
