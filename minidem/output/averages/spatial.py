"""``fix ID GROUP ave/spatial EVERY REPEAT PERIOD z lower 0.01 vx density/mass ... [file NAME]``."""

from __future__ import annotations

from collections import deque
from typing import Final

import numpy as np

from minidem.kernels.columns import MASS, POSITION
from minidem.output.averages.bins import Axis, Bins, read_axes
from minidem.output.averages.report import REPORT_OPTIONS, Report
from minidem.output.averages.sampling import SampledFix, Sampling
from minidem.output.averages.spread import Spread
from minidem.output.columns import atom_vector
from minidem.record import field, record
from minidem.registry import Head
from minidem.words import Words, one_of, variables_in
from minidem.world.fix import FIXES
from minidem.world.state import Floats
from minidem.world.values.named import need_names
from minidem.world.world import World

__all__ = ["AverageSpatial"]

_OPTIONS: Final = ("norm", "units", "region", "write_ts", "std", *REPORT_OPTIONS)
COUNT: Final = 0
"""Column of the sums that holds how many particles there were."""
_DENSITIES: Final = ("density/number", "density/mass")
_INPUTS: Final = ("vx", "vy", "vz", "fx", "fy", "fz", *_DENSITIES)


@FIXES.register("ave/spatial")
@record
class AverageSpatial(SampledFix):
    """Means over time and particles in bins.

    Attributes
    ----------
    axes : tuple of Axis
        Directions that are cut.
    names : tuple of str
        What is averaged.
    report : Report
        File, and which averages are put together.
    reduced, by_sample : bool
        ``units reduced`` and ``norm sample``.
    region : str
        Only particles in this region; empty for all.
    steps : bool
        Whether the file says the step.
    spread : Spread or None
        What is told of the scatter over the bins.
    bins : Bins or None
        Of the present samples.
    sums : ndarray, shape (bins, 1 + names)
        Counts and sums of the present samples.
    parts : deque of ndarray
        Averages that count; for ``running`` their sum.
    joined : int
        Number of averages in it.
    """

    axes: tuple[Axis, ...]
    names: tuple[str, ...]
    report: Report
    reduced: bool = False
    by_sample: bool = False
    region: str = ""
    steps: bool = True
    spread: Spread | None = None
    bins: Bins | None = None
    sums: Floats = field(default_factory=lambda: np.zeros((0, 0)))
    parts: deque[Floats] = field(default_factory=deque)
    joined: int = 0

    def variables_asked(self) -> tuple[str, ...]:
        """Return the names of the variables that it asks in a run."""
        return variables_in(self.names)

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> AverageSpatial:
        """Read intervals, bins, inputs and options, and begin the file."""
        words.need(7, "fix ID GROUP ave/spatial EVERY REPEAT PERIOD z lower 0.01 INPUT ...")
        sampling, axes = Sampling.read(words), read_axes(words)
        names = []
        while words.peek() in _INPUTS or words.peek()[:2] in ("c_", "f_", "v_"):
            names.append(words.take("an input"))
        if not names:
            words.choice(_INPUTS, "input")
        need_names(world, f"fix {head.style}", names, per_atom=True)
        group = next(name for name, bit in world.groups.items() if bit == head.bit)
        coords = " ".join(f"Coord{k + 1}" for k in range(len(axes))) if axes[1:] else "Coord"
        first = f"# Spatial-averaged data for fix {head.name} and group {group}"
        titles = [
            first,
            "# Timestep Number-of-bins", f"# Bin {coords} Ncount " + " ".join(names),
        ]  # fmt: skip
        made = cls(*head, sampling, axes, tuple(names), Report(titles))
        while not words.done():
            made.read_option(world, words)
        made.bins = Bins.of(world, axes, reduced=made.reduced)
        titles[:] = [title for title in titles if len(title) > 1]  # as LIGGGHTS leaves out lines
        made.report.begin(head.style)
        if made.spread is not None:
            made.spread.begin(first, names)
        sampling.restart(world.step)
        return made

    def read_option(self, world: World, words: Words) -> None:
        """Read an option."""
        key = words.choice(_OPTIONS)
        if key == "norm":
            self.by_sample = words.choice(("all", "sample"), key) == "sample"
        elif key == "units":
            self.reduced = words.choice(("box", "lattice", "reduced"), key) == "reduced"
        elif key == "region":
            self.region = one_of(words.take("a region"), tuple(world.regions), "region")
        elif key == "write_ts":
            self.steps = words.yes_no()
        elif key == "std":
            self.spread = Spread.read(world, words)
        else:
            self.report.read_option(world, key, words)

    def act(self, world: World) -> None:
        """Take a sample; with the last of an average write the bins."""
        if self.bins is None or self.sampling.taken == 0:
            self.bins = Bins.of(world, self.axes, reduced=self.reduced)
            self.sums = np.zeros((self.bins.count, 1 + len(self.names)))
        one = self._sample(world, self.bins)
        if self.by_sample:
            filled = np.maximum(one[:, COUNT], 1.0)
            for at in self._plain():
                one[:, at] /= filled
        self.sums += one
        if self.sampling.done(world.step):
            self._join(self._mean(self.bins))
            self._write(world, self.bins)
            if self.spread is not None:
                count, *values = np.sum(self.parts, axis=0).T
                self.spread.write(world.step, count, np.stack(values, axis=1), self.joined)

    def _plain(self) -> list[int]:
        """Return the columns that are no densities."""
        return [1 + k for k, name in enumerate(self.names) if name not in _DENSITIES]

    def _sample(self, world: World, bins: Bins) -> Floats:
        """Return counts and sums of the particles that count."""
        chosen = world.member(self.bit)
        row = world.state.row[: world.state.n]
        if self.region:
            chosen = chosen & world.regions[self.region].match(row[:, POSITION])
        at = bins.of_particles(world)[chosen]
        columns = [np.bincount(at, minlength=bins.count).astype(np.float64)]
        for name in self.names:
            if name == "density/number":
                columns.append(columns[0])
                continue
            values = row[:, MASS] if name == "density/mass" else atom_vector(world, name)
            columns.append(np.bincount(at, values[chosen], bins.count).astype(np.float64))
        return np.stack(columns, axis=1)

    def _mean(self, bins: Bins) -> Floats:
        """Return the averages of the samples."""
        found = self.sums / self.sampling.repeat
        for at in range(1, found.shape[1]):
            if self.names[at - 1] in _DENSITIES:
                found[:, at] /= bins.volume
            elif not self.by_sample:
                found[:, at] = self.sums[:, at] / np.maximum(self.sums[:, COUNT], 1.0)
        return found

    def _join(self, mean: Floats) -> None:
        """Put an average to those that count."""
        if self.parts and self.parts[0].shape != mean.shape:
            self.parts.clear()  # the box has other bins now
            self.joined = 0
        if self.report.mode == "running" and self.parts:
            self.parts.append(self.parts.pop() + mean)
            self.joined += 1
            return
        self.parts.append(mean)
        if self.report.mode != "running" and len(self.parts) > self.report.window:
            self.parts.popleft()
        self.joined = len(self.parts)

    def element(self, world: World, indices: tuple[int, ...]) -> float:
        """Return coordinates, count or averages (columns, from 1) of a bin (from 1).

        Counts and averages are 0 before the first average, everything in bins that are not there.
        """
        columns = len(self.axes) + 1 + len(self.names)
        if self.bins is None or len(indices) != 2 or not 1 <= indices[1] <= columns:
            return super().element(world, indices)
        row, column = (index - 1 for index in indices)
        return float(self._table(self.bins)[row, column]) if row < self.bins.count else 0.0

    def _table(self, bins: Bins) -> Floats:
        """Return centres, counts and averages of the bins, shape (bins, columns)."""
        mean = np.zeros((bins.count, 1 + len(self.names)))
        if self.parts:
            mean = np.sum(self.parts, axis=0) / self.joined
        return np.concatenate([bins.centres(), mean], axis=1)

    def _write(self, world: World, bins: Bins) -> None:
        table = self._table(bins)
        lines = [f"{world.step} {bins.count}"] if self.steps else []
        lines += [
            f"  {k + 1} " + " ".join(f"{value:g}" for value in row)
            for k, row in enumerate(table.tolist())
        ]
        self.report.write(lines)
