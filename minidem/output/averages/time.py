"""``fix ID GROUP ave/time EVERY REPEAT PERIOD c_ID f_ID[2] v_NAME ... [file NAME] ...``."""

from __future__ import annotations

from collections import deque
from contextlib import suppress
from typing import ClassVar, Final

import numpy as np

from minidem.errors import InputError, MistakeError, UnknownNameError
from minidem.output.averages.report import REPORT_OPTIONS, Report
from minidem.output.averages.sampling import SampledFix, Sampling
from minidem.output.quantities import Quantities
from minidem.record import field, record
from minidem.registry import Head
from minidem.words import Words, variables_in
from minidem.world.fix import FIXES
from minidem.world.state import Floats
from minidem.world.values.named import need_names
from minidem.world.world import World

__all__ = ["AverageTime"]

_PREFIXES: Final = ("c_", "f_", "v_")
_OPTIONS: Final = ("start", "off", "mode", *REPORT_OPTIONS)


@FIXES.register("ave/time")
@record
class AverageTime(SampledFix):
    """Means over time of global values.

    Attributes
    ----------
    names : tuple of str
        What is averaged.
    report : Report
        File, and which averages the value is the mean of.
    vectors : bool
        Whether inputs have several values each.
    off : set of int
        Inputs of which the last value counts, from 0.
    sums : ndarray
        Sums of the present samples.
    means : deque of ndarray
        Averages that count for ``window``; for the others their sum.
    count : int
        Number of averages in it.
    """

    names: tuple[str, ...]
    report: Report
    vectors: bool = False
    off: set[int] = field(default_factory=set)
    sums: Floats = field(default_factory=lambda: np.zeros(0))
    means: deque[Floats] = field(default_factory=deque)
    count: int = 0

    usage: ClassVar[str] = "fix ID GROUP ave/time EVERY REPEAT PERIOD c_ID ..."

    def variables_asked(self) -> tuple[str, ...]:
        """Return the names of the variables that it asks in a run."""
        return variables_in(self.names)

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> AverageTime:
        """Read intervals, inputs and options, and begin the file."""
        words.need(4, cls.usage)
        sampling = Sampling.read(words)
        names = []
        while words.peek()[:2] in _PREFIXES:
            names.append(words.take("an input"))
        if not names:
            words.expect("c_ID")
        need_names(world, f"fix {head.style}", names, per_atom=False)
        made = cls(*head, sampling, tuple(names), Report([""] * 3))
        while not words.done():
            made.read_option(world, words)
        if made.vectors:
            ask = Quantities(world)
            made.names = tuple(column for name in names for column in _columns(ask, name))
        if made.off and not 0 <= min(made.off) <= max(made.off) < len(made.names):
            msg = f"fix ave/time off: there are inputs 1 to {len(made.names)} only"
            raise InputError(msg)
        made.report.titles = made._titles()
        made.sums = np.zeros(len(names))
        if made.vectors:  # only now it is known how many values there are
            made.sums = np.zeros_like(made._sample(world))
            made._check_sums(world)
        made.report.begin(head.style)
        made.sampling.restart(world.step)
        return made

    def _check_sums(self, world: World) -> None:
        """Refuse a table of sums over particles and of other values, as LIGGGHTS does."""
        ask = Quantities(world)
        if len({ask.adds_up(name, (1,)) for name in self.names}) > 1:
            msg = (
                f"Fix ave/time cannot set output array intensive/extensive from these inputs: of "
                f"{' '.join(self.names)} some are sums over particles; use a fix for each kind"
            )
            raise MistakeError(msg)

    def read_option(self, world: World, words: Words) -> None:
        """Read an option."""
        key = words.choice(_OPTIONS)
        if key == "start":
            self.sampling.first = words.integer()
        elif key == "off":
            self.off.add(words.integer() - 1)
        elif key == "mode":
            self.vectors = words.choice(("scalar", "vector"), key) == "vector"
        else:
            self.report.read_option(world, key, words)

    def _titles(self) -> list[str]:
        """Return the first lines of the file: those that were given, and usual ones."""
        names = " ".join(self.names)
        usual = [f"# Time-averaged data for fix {self.name}", f"# TimeStep {names}"]
        if self.vectors:
            usual[1:] = ["# TimeStep Number-of-rows", f"# Row {names}"]
        return [given or line for given, line in zip(self.report.titles, usual, strict=False)]

    def value(self, world: World, index: int) -> float:
        """Return the mean of the only input (0), or of one of several, from 1.

        Of an input that has several values, one of them, from 1.
        """
        mean = self.mean()
        if self.vectors and len(self.names) == 1 and 1 <= index <= len(mean):
            return float(mean[index - 1].item())
        wanted = index <= len(self.names) and (index == 0) == (len(self.names) == 1)
        if self.vectors or not wanted:
            return super().value(world, index)
        return float(mean[max(index, 1) - 1])

    def adds_up(self, world: World, indices: tuple[int, ...]) -> bool:
        """Tell whether the input is a sum over particles; of several vectors the first tells."""
        ask = Quantities(world)
        if not self.vectors:
            return ask.adds_up(self.names[indices[0] - 1 if indices else 0])
        return ask.adds_up(self.names[0], indices[:1])

    def element(self, world: World, indices: tuple[int, ...]) -> float:
        """Return a value of an input: which value, which input, from 1."""
        mean = self.mean()
        if not self.vectors or len(indices) != 2 or min(indices) < 1:
            return super().element(world, indices)
        row, column = indices
        if row > len(mean) or column > len(self.names):
            return super().element(world, indices)
        return float(mean[tuple(index - 1 for index in indices)])

    def mean(self) -> Floats:
        """Return the means, (names,), or (values, names) where inputs have several."""
        if not self.count:
            return np.zeros_like(self.sums)
        found: Floats = np.sum(self.means, axis=0) / self.count
        return found

    def _sample(self, world: World) -> Floats:
        """Return the values now, shaped as `mean`."""
        ask = Quantities(world)
        if not self.vectors:
            return np.array([ask.value(name) for name in self.names])
        columns = [ask.elements(name) for name in self.names]
        lengths = [len(column) for column in columns]
        if len({*lengths}) > 1:
            msg = (
                f"fix {self.name}: inputs of 'mode vector' have {lengths} values; expected as many"
            )
            raise InputError(msg)
        return np.stack(columns, axis=1)

    def act(self, world: World) -> None:
        """Take a sample; with the last of an average write a line."""
        now = self._sample(world)
        if self.sampling.taken == 0:
            self.sums = np.zeros_like(now)
        last = sorted(self.off)
        self.sums += now
        self.sums[..., last] = now[..., last]
        if not self.sampling.done(world.step):
            return
        mean = self.sums / self.sampling.repeat
        mean[..., last] = now[..., last]
        self._join(mean, last)
        self.report.write(self._lines(world.step))

    def _lines(self, step: int) -> list[str]:
        """Return what the file gets."""
        mean = self.mean()
        if not self.vectors:
            return [" ".join([str(step), *(f"{value:g}" for value in mean)])]
        rows = [" ".join(f"{value:g}" for value in row) for row in mean]
        return [f"{step} {len(rows)}", *(f"{k} {row}" for k, row in enumerate(rows, 1))]

    def _join(self, mean: Floats, last: list[int]) -> None:
        """Add an average to those that count."""
        if self.report.mode == "running":
            total = self.means.pop() + mean if self.means else mean.copy()
            self.means.append(total)
            self.count += 1
            total[..., last] = self.count * mean[..., last]
            return
        self.means.append(mean)
        if len(self.means) > self.report.window:
            self.means.popleft()
        self.count = len(self.means)
        for one in self.means:
            one[..., last] = mean[..., last]


def _columns(ask: Quantities, name: str) -> list[str]:
    """Return the names of the columns of an input of ``mode vector``; a table has several."""
    try:
        ask.elements(name)
    except UnknownNameError:
        found: list[str] = []
        with suppress(UnknownNameError):
            while not name.endswith("]") and ask.elements(f"{name}[{len(found) + 1}]").size:
                found.append(f"{name}[{len(found) + 1}]")
        if not found:
            raise
        return found
    return [name]
