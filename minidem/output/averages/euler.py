"""``fix ID GROUP ave/euler nevery N cell_size_relative C parallel yes ...``: means in cells."""

from __future__ import annotations

from typing import ClassVar, Final

import numpy as np

from minidem.contact.actions import pair_contacts
from minidem.errors import InputError, NoParticlesError
from minidem.insertion.seeds import ParkMiller
from minidem.kernels.columns import MASS, POSITION, RADIUS, VELOCITY, X, Y, Z
from minidem.record import field, record
from minidem.registry import Head
from minidem.words import Words, one_of
from minidem.world.event import next_multiple
from minidem.world.fix import FIXES, Fix, largest_inserted
from minidem.world.state import Bools, Floats, Ints
from minidem.world.world import World

__all__ = ["AverageEuler", "Cells"]

_SEED: Final = 15485863
_TRIES: Final = 50  # random points per cell
_THIRD: Final = -0.333333333333333  # as in LIGGGHTS
_MOST: Final = 10_000_000  # cells
_AXES: Final = 3


@record
class Cells:
    """A regular grid over the box and what is in its cells, the first direction running fastest.

    Attributes
    ----------
    lo, size : ndarray, shape (3,)
        Lower corner and edges of a cell, m.
    count : ndarray, shape (3,)
        Numbers of cells.
    weight : ndarray, shape (n,)
        Part of each cell that is inside the region.
    velocity : ndarray, shape (n, 3)
        Mean of the masses, m/s.
    fraction, radius, pressure : ndarray, shape (n,)
        Volume fraction; mean radius, m; pressure of contacts and fluctuations, Pa.
    """

    lo: Floats
    size: Floats
    count: Ints
    weight: Floats
    velocity: Floats
    fraction: Floats
    radius: Floats
    pressure: Floats

    @classmethod
    def of(cls, world: World, edge: float) -> Cells:
        """Cut the box into cells with edges of at least `edge`, m.

        Raises
        ------
        InputError
            If there would be too many.
        """
        box = world.need_box()
        numbers = np.maximum(((box.hi - box.lo) / edge).astype(np.int64), 1)
        total = int(np.prod(numbers.astype(float)))
        if total > _MOST:
            msg = f"fix ave/euler: {total} cells; at most {_MOST} are possible, use larger ones"
            raise InputError(msg)
        size = (box.hi - box.lo) / numbers
        nothing = np.zeros(total)
        return cls(
            box.lo.copy(), size, numbers, np.ones(total), np.zeros((total, 3)), nothing,
            nothing, nothing,
        )  # fmt: skip

    def centres(self) -> Floats:
        """Return the centres of the cells, shape (n, 3), m."""
        axes = [self.lo[c] + (np.arange(self.count[c]) + 0.5) * self.size[c] for c in range(_AXES)]
        z, y, x = np.meshgrid(axes[2], axes[1], axes[0], indexing="ij")
        return np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)

    def find(self, points: Floats, hi: Floats) -> tuple[Bools, Ints]:
        """Tell which points are within the box, and in which cells those are."""
        inside: Bools = np.logical_and.reduce((points > self.lo) & (points < hi), axis=1)
        place: Ints = ((points[inside] - self.lo) * (1.0 / self.size)).astype(np.int64)
        nx, ny = int(self.count[X]), int(self.count[Y])
        cell: Ints = (place[:, Z] * ny + place[:, Y]) * nx + place[:, X]
        np.minimum(cell, len(self.weight) - 1, out=cell)
        return inside, cell


@FIXES.register("ave/euler")
@record
class AverageEuler(Fix):
    """Means over the particles in cells, which ``dump euler/vtk`` writes.

    Attributes
    ----------
    every : int
        Steps between means.
    relative : float
        Edge of a cell in largest diameters.
    region : str
        Volume that grains can fill; empty for all.
    random : ParkMiller
        Generator of points for that volume.
    cells : Cells or None
        The last means.
    """

    every: int
    relative: float
    region: str = ""
    random: ParkMiller = field(default_factory=lambda: ParkMiller(_SEED))
    cells: Cells | None = None

    looks_inside: ClassVar[bool] = True
    usage: ClassVar[str] = "fix ID GROUP ave/euler nevery N cell_size_relative C parallel yes"

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> AverageEuler:
        """Read interval, size of the cells and the volume that counts."""
        words.need(6, cls.usage)
        words.expect("nevery")
        every = words.interval()
        words.expect("cell_size_relative")
        relative = words.number()
        if relative < 1.0:
            msg = f"fix ave/euler: cell_size_relative {relative:g} is below 1"
            raise InputError(msg)
        words.expect("parallel")
        words.yes_no()
        made = cls(*head, every, relative)
        while not words.done():
            words.expect("basevolume_region")
            made.region = one_of(words.take("a region"), tuple(world.regions), "region")
        return made

    def start(self, world: World) -> None:
        """Choose the cells at the start of a run and take the first means."""
        self._cut(world)
        self.act(world)

    def next_step(self, step: int) -> int:
        """Return the next multiple of the interval."""
        return next_multiple(step, self.every)

    def _cut(self, world: World) -> Cells:
        radii = world.state.row[: world.state.n, RADIUS]
        largest = max(float(radii.max(initial=0.0)), largest_inserted(world))
        if largest <= 0.0:
            msg = "fix ave/euler: there are no particles that give the size of its cells"
            raise NoParticlesError(msg)
        self.cells = Cells.of(world, self.relative * 2.0 * largest * world.neighbor.reach)
        if self.region:
            self._weigh(world, self.cells)
        return self.cells

    def _weigh(self, world: World, cells: Cells) -> None:
        """Find the part of each cell that is in the region, by random points."""
        if self.region not in world.regions:
            msg = f"fix ave/euler: region '{self.region}' is not there any more"
            raise InputError(msg)
        box, total = world.need_box(), len(cells.weight)
        numbers = self.random.uniforms(total * _TRIES * _AXES).reshape(-1, _AXES)
        points = box.lo + (box.hi - box.lo) * numbers
        points = points[world.regions[self.region].match(points)]
        _, cell = cells.find(points, box.hi)
        hits = np.bincount(cell, minlength=total)
        cells.weight = np.minimum(hits * (1.0 / _TRIES), 1.0)

    def act(self, world: World) -> None:
        """Take the means of the present step."""
        cells, box = self.cells, world.need_box()
        grows = any(set(face) & set("sm") for face in box.boundary)
        if cells is None or grows:
            cells = self._cut(world)
        row = world.state.row[: world.state.n]
        inside, cell = cells.find(row[:, POSITION], box.hi)
        who = np.flatnonzero(inside)
        member = world.member(self.bit)[who]
        who, cell = who[member], cell[member]
        total = len(cells.weight)

        def add(values: Floats) -> Floats:
            found: Floats = np.bincount(cell, values, total).astype(np.float64)
            return found

        mass, radius, speed = row[who, MASS], row[who, RADIUS], row[who, VELOCITY]
        number = np.bincount(cell, minlength=total)
        filled = np.where(number, add(mass), 1.0)
        cells.velocity = np.stack([add(mass * v) for v in speed.T], axis=1) / filled[:, None]
        cells.radius = add(radius) / np.maximum(number, 1)
        volume = float(np.prod(cells.size))
        solid = add(radius**3)
        least = 1.0 / _TRIES
        cells.weight[(solid > 0.0) & (np.abs(cells.weight) <= 1e-6)] = least
        counted = cells.weight >= least
        share = np.where(counted, cells.weight, 1.0) * volume
        cells.fraction = np.where(counted, solid * (4.0 / 3.0 * np.pi) / share, 0.0)
        apart = speed - cells.velocity[cell]
        stress = -mass * (apart**2).sum(axis=1) - _virial(world)[who]
        cells.pressure = np.where(counted, _THIRD * add(stress) / share, 0.0)


def _virial(world: World) -> Floats:
    """Return the trace of the contact virial of each particle, J; walls do not count."""
    found = pair_contacts(world, in_step=True)
    half = 0.5 * (found.arm * found.force).sum(axis=1)
    n = world.state.n
    total = np.zeros(n)
    for side in (0, 1):
        total += np.bincount(found.who[:, side], half, n)
    return total
