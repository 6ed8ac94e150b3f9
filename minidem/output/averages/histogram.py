"""``fix ID GROUP ave/histo EVERY REPEAT PERIOD LO HI BINS INPUT ...``: how values are spread."""

from __future__ import annotations

from collections import deque
from typing import Final

import numpy as np

from minidem.errors import InputError, UnknownNameError
from minidem.output.averages.report import REPORT_OPTIONS, Report
from minidem.output.averages.sampling import SampledFix, Sampling
from minidem.output.columns import atom_vector, split_indices
from minidem.output.dump_local import local_columns
from minidem.output.quantities import Quantities
from minidem.record import field, record
from minidem.registry import Head
from minidem.words import Words, variables_in
from minidem.world.fix import FIXES
from minidem.world.state import Floats
from minidem.world.values.named import need_names
from minidem.world.world import World

__all__ = ["Histogram"]

_INPUTS: Final = ("x", "y", "z", "vx", "vy", "vz", "fx", "fy", "fz")
_PREFIXES: Final = ("c_", "f_", "v_")
_OPTIONS: Final = ("start", "mode", "beyond", *REPORT_OPTIONS)
_MOST: Final = 1_000_000  # bins
_FAR: Final = 1.0e20  # least and largest of no values


@record
class _Counts:
    """What was counted.

    Attributes
    ----------
    bins : ndarray, shape (n,)
        Values in each bin.
    outside : float
        Values that no bin took.
    least, largest : float
        Of all values.
    """

    bins: Floats
    outside: float = 0.0
    least: float = _FAR
    largest: float = -_FAR

    def add(self, other: _Counts) -> None:
        """Count what another one has as well."""
        self.bins = self.bins + other.bins
        self.outside += other.outside
        self.least = min(self.least, other.least)
        self.largest = max(self.largest, other.largest)


@FIXES.register("ave/histo")
@record
class Histogram(SampledFix):
    """Histograms of values, and their sums over time.

    Attributes
    ----------
    lo, hi : float
        Range of the bins.
    wanted : int
        Number of bins between them.
    names : tuple of str
        What is counted.
    report : Report
        File, and which histograms are put together.
    vectors : bool
        Whether inputs have several values each.
    beyond : str
        What becomes of values outside: ``ignore``, ``end`` or ``extra``.
    present : _Counts or None
        Of the present samples.
    kept : deque of _Counts
        Histograms that count; for ``running`` their sum.
    """

    lo: float
    hi: float
    wanted: int
    names: tuple[str, ...]
    report: Report
    vectors: bool = False
    beyond: str = "ignore"
    present: _Counts | None = None
    kept: deque[_Counts] = field(default_factory=deque)

    def variables_asked(self) -> tuple[str, ...]:
        """Return the names of the variables that it asks in a run."""
        return variables_in(self.names)

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Histogram:
        """Read intervals, bins, inputs and options, and begin the file."""
        words.need(7, "fix ID GROUP ave/histo EVERY REPEAT PERIOD LO HI BINS INPUT ...")
        sampling = Sampling.read(words)
        lo, hi, bins = words.number(), words.number(), words.interval()
        if lo >= hi or bins > _MOST:
            msg = f"fix ave/histo: {bins} bins from {lo:g} to {hi:g}; expected LO below HI, and "
            msg += f"at most {_MOST} bins"
            raise InputError(msg)
        names = []
        while words.peek() in _INPUTS or words.peek()[:2] in _PREFIXES:
            names.append(words.take("an input"))
        if not names:
            words.choice(_INPUTS, "input")
        need_names(world, f"fix {head.style}", names, per_atom=None)
        titles = [
            f"# Histogrammed data for fix {head.name}",
            "# TimeStep Number-of-bins Total-counts Missing-counts Min-value Max-value",
            "# Bin Coord Count Count/Total",
        ]
        made = cls(*head, sampling, lo, hi, bins, tuple(names), Report(titles))
        while not words.done():
            made._option(world, words)
        single = [name for name in names if name in _INPUTS]
        if single and not made.vectors:
            msg = f"fix ave/histo: '{single[0]}' has a value per particle and needs 'mode vector'"
            raise InputError(msg)
        made.report.begin(head.style)
        sampling.restart(world.step)
        return made

    def _option(self, world: World, words: Words) -> None:
        """Read an option."""
        key = words.choice(_OPTIONS)
        if key == "start":
            self.sampling.first = words.integer()
        elif key == "mode":
            self.vectors = words.choice(("scalar", "vector"), key) == "vector"
        elif key == "beyond":
            self.beyond = words.choice(("ignore", "end", "extra"), key)
        else:
            self.report.read_option(world, key, words)

    def act(self, world: World) -> None:
        """Take a sample; with the last of a histogram write it."""
        if self.present is None or self.sampling.taken == 0:
            self.present = self._nothing()
        for name in self.names:
            self.present.add(self._count(self._values(world, name)))
        if self.sampling.done(world.step):
            self._join(self.present)
            self._write(world)

    def _nothing(self) -> _Counts:
        return _Counts(np.zeros(self.wanted + 2 * (self.beyond == "extra")))

    def _values(self, world: World, name: str) -> Floats:
        """Return the values of an input now."""
        ask = Quantities(world)
        if not self.vectors:
            return np.array([ask.value(name)])
        base, indices = split_indices(name)
        compute = world.computes.get(base[2:]) if base.startswith("c_") else None
        if compute is not None and compute.per_contact:
            table, at = local_columns(world, compute.name), (indices or (1,))[0]
            if at > table.shape[1]:
                msg = f"fix {self.name}: '{name[:40]}' has {table.shape[1]} columns"
                raise InputError(msg)
            column = at - 1
            return table[:, column]
        try:
            return atom_vector(world, name)[world.member(self.bit)]
        except UnknownNameError:
            return ask.elements(name)

    def _count(self, values: Floats) -> _Counts:
        """Sort values into the bins."""
        found = self._nothing()
        if not len(values):
            return found
        found.least, found.largest = float(values.min()), float(values.max())
        below, above = values < self.lo, values > self.hi
        within = values[~(below | above)]
        scale = 1.0 / ((self.hi - self.lo) / self.wanted)
        place = np.minimum(((within - self.lo) * scale).astype(np.int64), self.wanted - 1)
        first = int(self.beyond == "extra")
        counts = np.bincount(place, minlength=self.wanted)
        found.bins[first : first + self.wanted] = counts
        if self.beyond == "ignore":
            found.outside = float(np.count_nonzero(below | above))
        else:
            found.bins[0] += np.count_nonzero(below)
            found.bins[-1] += np.count_nonzero(above)
        return found

    def _join(self, new: _Counts) -> None:
        """Put a histogram to those that count."""
        if self.report.mode == "running":
            if not self.kept:  # LIGGGHTS takes 0 for the first least and largest value
                self.kept.append(_Counts(np.zeros_like(new.bins), 0.0, 0.0, 0.0))
            self.kept[0].add(new)
            return
        self.kept.append(new)
        if len(self.kept) > self.report.window:
            self.kept.popleft()

    def total(self) -> tuple[list[float], Floats]:
        """Return the four numbers of a histogram, and a row per bin: middle, count and share."""
        extra = self.beyond == "extra"
        width = (self.hi - self.lo) / self.wanted
        middle = self.lo + (np.arange(self.wanted) + 0.5) * width
        if extra:
            middle = np.concatenate([[self.lo], middle, [self.hi]])
        if not self.kept:
            nothing = np.zeros_like(middle)
            return [0.0] * 4, np.stack([middle, nothing, nothing], axis=1)
        whole = self._nothing()
        for one in self.kept:
            whole.add(one)
        count = float(whole.bins.sum())
        share = whole.bins / count if count else whole.bins
        numbers = [count, whole.outside, whole.least, whole.largest]
        return numbers, np.stack([middle, whole.bins, share], axis=1)

    def value(self, world: World, index: int) -> float:
        """Return the count (1), the values outside (2), the least (3) or the largest value (4)."""
        if not 1 <= index <= 4:
            return super().value(world, index)
        numbers, _ = self.total()
        return dict(enumerate(numbers, 1))[index]

    def element(self, world: World, indices: tuple[int, ...]) -> float:
        """Return middle (1), count (2) or share (3) of a bin, from 1."""
        _, rows = self.total()
        if len(indices) != 2 or indices[0] > len(rows) or indices[1] > rows.shape[1]:
            return super().element(world, indices)
        return float(rows[tuple(index - 1 for index in indices)])

    def _write(self, world: World) -> None:
        numbers, rows = self.total()
        head = [str(world.step), str(len(rows)), *(f"{value:g}" for value in numbers)]
        lines = [" ".join(head)]
        lines += [
            f"{k} {middle:g} {count:g} {share:g}"
            for k, (middle, count, share) in enumerate(rows.tolist(), 1)
        ]
        self.report.write(lines)
