"""``fix ID GROUP wall/region REGION STYLE EPSILON SIGMA CUTOFF``: a region's surface repels."""

from __future__ import annotations

import numpy as np

from minidem.errors import InputError, SimulationError
from minidem.fixes.forces.body import BodyForce
from minidem.insertion.region import Region
from minidem.kernels.columns import POSITION, RADIUS, TOTAL_FORCE, X, Y, Z
from minidem.record import field, record
from minidem.registry import Head
from minidem.words import Words, one_of
from minidem.world.fix import FIXES
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["WallRegion"]

_STYLES = ("lj93", "lj126", "colloid", "harmonic")
_SPREAD = 7.0  # of the potential of a colloid; the others have one
_FORCE, _ENERGY = range(2)


@FIXES.register("wall/region")
@record
class WallRegion(BodyForce):
    """A potential of the distance of particle centres from the surface of a region.

    Attributes
    ----------
    potential_style : str
        One of `_STYLES`.
    depth, size, cut : float
        Strength (of ``harmonic`` N/m, else J), length and reach of the potential, m.
    wall : str
        The region.
    total : ndarray, shape (4,)
        Energy, J, and force on the wall, N.
    """

    potential_style: str = ""
    depth: float = 0.0
    size: float = 0.0
    cut: float = 0.0
    wall: str = ""
    total: Floats = field(default_factory=lambda: np.zeros(4))

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> WallRegion:
        """Read region and potential."""
        words.need(5, "fix ID GROUP wall/region REGION harmonic EPSILON SIGMA CUTOFF")
        made = cls(*head)
        name = words.take("a region")
        made.wall = one_of(name, tuple(world.regions), "region of fix wall/region")
        made.potential_style = words.choice(_STYLES, "potential")
        made.depth, made.size, made.cut = words.number(), words.number(), words.positive()
        return made

    def check(self, world: World) -> None:
        """Refuse regions whose surface is not known."""
        super().check(world)
        region = self._region(world)
        if region.faceless(outer=False):
            msg = (
                f"fix {self.name} (wall/region): LIGGGHTS knows no surface of a mesh/tet, and "
                "none of a wedge with side out; use another region"
            )
            raise InputError(msg)
        if any(part.moves() for part in region.parts):
            msg = (
                f"fix {self.name} (wall/region): a region with parts that move is not supported; "
                "use a region that moves as a whole"
            )
            raise InputError(msg)

    def _region(self, world: World) -> Region:
        if self.wall not in world.regions:
            msg = f"Region ID '{self.wall}' for fix wall/region does not exist"
            raise InputError(msg)
        found: Region = world.regions[self.wall]
        return found

    def apply(self, world: World) -> None:
        """Push the particles away from the surface."""
        who, state = self.affected(world), world.state
        region, points = self._region(world), state.row[who, POSITION]
        outside = ~region.match(points)
        which, away = region.near_points(points, self.cut)
        x, y, z = away[:, X], away[:, Y], away[:, Z]
        gap = np.sqrt(x * x + y * y + z * z)
        radius = state.row[who, RADIUS][which]
        close = gap <= (radius if self.potential_style == "colloid" else 0.0)
        if outside.any() or close.any():
            worst = int(np.argmax(outside)) if outside.any() else int(which[np.argmax(close)])
            raise SimulationError(
                world.step, int(state.ids[who[worst]]),
                f"is on or behind the surface of region '{self.wall}' that fix {self.name} "
                "(wall/region) makes a wall; start farther inside, or make the wall stronger",
            )  # fmt: skip
        push = self._potential(gap, radius)
        force = push[_FORCE][:, None] * away / gap[:, None]
        np.add.at(state.force[:, TOTAL_FORCE], who[which], force)
        self.total = np.append(push[_ENERGY].sum(), 0.0 - force.sum(axis=0))

    def _potential(self, r: Floats, radius: Floats) -> tuple[Floats, Floats]:
        """Return force, N, and energy, J, at distances from the surface."""
        depth, size = self.depth, self.size
        if self.potential_style == "harmonic":
            return 2.0 * depth * (self.cut - r), depth * (self.cut - r) ** 2
        if self.potential_style == "colloid":
            return self._colloid(r, radius)
        far, near, factor = (9, 3, 2.0 / 15.0) if self.potential_style == "lj93" else (12, 6, 4.0)
        one = factor * depth * size**far
        other = (1.0 if near == 3 else factor) * depth * size**near
        force = far * one / r ** (far + 1) - near * other / r ** (near + 1)
        return force, one / r**far - other / r**near - (
            one / self.cut**far - other / self.cut**near
        )

    def _colloid(self, r: Floats, radius: Floats) -> tuple[Floats, Floats]:
        """Return force and energy of spheres of which each part attracts and repels."""
        one, other = self.depth * self.size**6, self.depth
        gap2 = radius**2 - r**2
        poly = (
            radius**9 + 27.0 * radius**7 * r**2 + 63.0 * radius**5 * r**4 + 21.0 * radius**3 * r**6
        )
        force = -4.0 / 315.0 * one * poly / gap2**8 + 2.0 / 3.0 * other * radius**3 / gap2**2
        wide = _SPREAD * radius
        inner, outer = radius - r, radius + r
        with np.errstate(invalid="ignore", divide="ignore"):
            attraction = (-2.0 * radius * r + inner * outer * (np.log(-inner) - np.log(outer))) * (
                -1.0 / inner / outer
            )
        energy = one / 7560.0 * ((r - wide) / inner**7 + (r + wide) / outer**7)
        cut = self.cut
        offset = one / 7560.0 / cut**9 - other / 6.0 / cut**3
        return force, energy - other / 6.0 * attraction - offset

    def value(self, world: World, index: int) -> float:
        """Return the energy (0) and the force on the wall (1-3)."""
        if not 0 <= index < len(self.total):
            return super().value(world, index)
        return float(self.total[index])
