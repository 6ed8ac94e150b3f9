"""Regions of space, at rest or moving."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from minidem.errors import InputError
from minidem.insertion.region.table import Part, build_table
from minidem.insertion.seeds import ParkMiller
from minidem.kernels.columns import RADIUS, X, Y, Z
from minidem.kernels.insertion.regions import list_surface, match_all
from minidem.kernels.insertion.shape_columns import ROUND_RADIUS
from minidem.kernels.insertion.shapes import INTERSECT, PRISM, SPHERE, TETS, UNION, WEDGE
from minidem.record import field, record, replace

__all__ = ["DEFAULT_SEED", "Motion", "OncePerStep", "Region"]

DEFAULT_SEED = 3012211
Floats = NDArray[np.float64]


@record
class OncePerStep:
    """Values of variables that are asked once a step.

    LIGGGHTS moves a region once a step: what changes between two runs moves it in the next one.

    Attributes
    ----------
    value : callable
        Gives the value of an equal-style variable now.
    step : callable
        Gives the present step.
    """

    value: Callable[[str], float]
    step: Callable[[], int]
    _at: int = -1
    _kept: dict[str, float] = field(default_factory=dict)

    def __call__(self, name: str) -> float:
        """Return the value that a variable had when it was asked first in this step."""
        if self.step() != self._at:
            self._at, self._kept = self.step(), {}
        if name not in self._kept:
            self._kept[name] = self.value(name)
        return self._kept[name]


@record(frozen=True)
class Motion:
    """How a region moves: it turns about an axis, then it is displaced.

    Attributes
    ----------
    value : callable
        Gives the value of an equal-style variable now.
    shift : tuple of str or None
        Variables of the displacement along the axes of space, m; None for none.
    angle : str
        Variable of the angle, rad; empty for none.
    point, axis : ndarray, shape (3,)
        A point on the axis, m, and its direction, of length one.
    radius : str
        Variable of the radius of a sphere or cylinder; empty for none.
    unit : float
        Box units per unit of the radius, m.
    """

    value: Callable[[str], float]
    shift: tuple[str | None, ...] = (None, None, None)
    angle: str = ""
    point: Floats = field(default_factory=lambda: np.zeros(3))
    axis: Floats = field(default_factory=lambda: np.zeros(3))
    radius: str = ""
    unit: float = 1.0

    def moves(self) -> bool:
        """Return whether anything follows a variable."""
        return bool(any(self.shift) or self.angle or self.radius)

    def turned(self, vectors: Floats, *, back: bool = False) -> Floats:
        """Return vectors (N, 3) as the region has turned them; with `back` the other way."""
        if not self.angle:
            return vectors
        angle = self.value(self.angle)
        if back:
            angle = -angle
        part = (
            vectors[:, X] * self.axis[X]
            + vectors[:, Y] * self.axis[Y]
            + vectors[:, Z] * self.axis[Z]
        )
        along = part[:, None] * self.axis
        out = vectors - along
        found: Floats = along + (out * cos(angle) + np.cross(self.axis, out) * sin(angle))
        return found

    def undone(self, points: Floats) -> Floats:
        """Return points (N, 3) as seen by the region at its place of definition."""
        moved: Floats = points - np.array(
            [self.value(name) if name else 0.0 for name in self.shift]
        )
        if not self.angle:
            return moved
        found: Floats = self.point + self.turned(moved - self.point, back=True)
        return found


@record
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
    parts : tuple of Region
        What a union or intersection is made of.
    motion : Motion or None
        None for a region at rest.
    volume : float
        m3, if it is known; else 0.
    """

    part: Part
    extent: Floats | None
    random: ParkMiller = field(default_factory=lambda: ParkMiller(DEFAULT_SEED))
    parts: tuple[Region, ...] = ()
    motion: Motion | None = None
    volume: float = 0.0

    def __post_init__(self) -> None:
        """Translate the shape for the kernels."""
        self.table = build_table(self.part)

    def moves(self) -> bool:
        """Return whether it, or a part of it, follows a variable."""
        return self.motion is not None or any(part.moves() for part in self.parts)

    def is_prism(self) -> bool:
        """Return whether it is a prism, which as a box would be tilted."""
        return self.part.kind == PRISM

    def match(self, points: Floats) -> NDArray[np.bool_]:
        """Tell which points (N, 3) are in the region; surface points are in with side in."""
        array = np.ascontiguousarray(points, dtype=np.float64).reshape(-1, 3)
        if self.moves():
            return self._match_moving(array)
        return _matches(self, array)

    def near_points(self, points: Floats, cut: float) -> tuple[NDArray[np.int64], Floats]:
        """Find the points of the surface that are nearer than `cut` to points inside.

        Returns
        -------
        (m,) ndarray of int64
            Numbers of the points.
        (m, 3) ndarray of float64
            Vectors from the surface to them, m.
        """
        region, motion = self, self.motion
        if motion is not None:
            region, points = self._now(motion), motion.undone(points)
        array = np.ascontiguousarray(points, dtype=np.float64).reshape(-1, 3)
        count = len(array)
        while True:
            which, away = np.empty(count, np.int64), np.empty((count, 3))
            found = list_surface(region.table, array, cut, which, away)
            if found <= count:
                break
            count = found
        away = away[:found]
        return which[:found], away if motion is None else motion.turned(away)

    def _match_moving(self, points: Floats) -> NDArray[np.bool_]:
        """Tell which points are in a region that moves, or has parts that do."""
        if self.motion is not None:
            points = np.ascontiguousarray(self.motion.undone(points))
            return _matches(self._now(self.motion), points)
        members = np.array([part.match(points) for part in self.parts])
        held = members.all(axis=0) if self.part.kind == INTERSECT else members.any(axis=0)
        found: NDArray[np.bool_] = held == self.part.interior
        return found

    def _now(self, motion: Motion) -> Region:
        """Return the region at its place of definition, with its present radius."""
        if not motion.radius:
            return self
        radius = motion.unit * motion.value(motion.radius)
        if radius < 0.0:
            msg = f"region: its variable gives the radius {radius:g}, which is negative"
            raise InputError(msg)
        shape = list(self.part.shape)
        shape[RADIUS if self.part.kind == SPHERE else ROUND_RADIUS] = radius
        return Region(replace(self.part, shape=tuple(shape)), None)

    def faceless(self, *, outer: bool) -> bool:
        """Return whether LIGGGHTS does not know how far a point is from its surface.

        Parameters
        ----------
        outer : bool
            For points outside of the region, else inside.
        """
        if self.part.kind < UNION:
            return self.part.kind == TETS or (
                self.part.kind == WEDGE and outer == self.part.interior
            )
        flipped = outer == self.part.interior
        return any(part.faceless(outer=flipped) for part in self.parts)


def _matches(region: Region, points: Floats) -> NDArray[np.bool_]:
    """Tell which points are in a region at rest."""
    found = np.empty(len(points), dtype=np.bool_)
    match_all(region.table, points, found)
    return found
