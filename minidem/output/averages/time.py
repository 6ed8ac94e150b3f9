"""``fix ID GROUP ave/time EVERY REPEAT PERIOD c_ID f_ID[2] v_NAME ... [file NAME] ...``."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from typing import ClassVar, Final

import numpy as np

from minidem.errors import InputError
from minidem.output.averages.report import REPORT_OPTIONS, Report
from minidem.output.averages.sampling import SampledFix, Sampling
from minidem.output.quantities import Quantities
from minidem.registry import Head
from minidem.words import Words
from minidem.world.fix import FIXES
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["AverageTime"]

_PREFIXES: Final = ("c_", "f_", "v_")
_OPTIONS: Final = ("start", "off", "mode", *REPORT_OPTIONS)


@FIXES.register("ave/time")
@dataclass
class AverageTime(SampledFix):
    """Means over time of global values.

    Attributes
    ----------
    names : tuple of str
        What is averaged.
    report : Report
        File, and which averages the value is the mean of.
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
    off: set[int] = field(default_factory=set)
    sums: Floats = field(default_factory=lambda: np.zeros(0))
    means: deque[Floats] = field(default_factory=deque)
    count: int = 0

    usage: ClassVar[str] = "fix ID GROUP ave/time EVERY REPEAT PERIOD c_ID ..."

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
        titles = [f"# Time-averaged data for fix {head.name}", "# TimeStep " + " ".join(names)]
        made = cls(*head, sampling, tuple(names), Report(titles))
        while not words.done():
            made.read_option(world, words)
        made.report.begin(head.style)
        made.sampling.restart(world.step)
        return made

    def read_option(self, world: World, words: Words) -> None:
        """Read an option."""
        key = words.choice(_OPTIONS)
        if key == "start":
            self.sampling.first = words.integer()
        elif key == "off":
            column = words.integer()
            if not 1 <= column <= len(self.names):
                msg = f"fix ave/time off: there are {len(self.names)} inputs, not {column}"
                raise InputError(msg)
            self.off.add(column - 1)
        elif key == "mode":
            if words.choice(("scalar", "vector"), key) == "vector":
                msg = "fix ave/time: 'mode vector' is not supported; give the elements one by one"
                raise InputError(msg)
        else:
            self.report.read_option(world, key, words)

    def value(self, world: World, index: int) -> float:
        """Return the mean of the only input (0), or of one of several, from 1."""
        if index > len(self.names) or (index == 0) != (len(self.names) == 1):
            return super().value(world, index)
        return float(self.mean()[max(index, 1) - 1])

    def mean(self) -> Floats:
        """Return the means."""
        if not self.count:
            return np.zeros(len(self.names))
        found: Floats = np.sum(self.means, axis=0) / self.count
        return found

    def act(self, world: World) -> None:
        """Take a sample; with the last of an average write a line."""
        ask = Quantities(world).value
        now = np.array([ask(name) for name in self.names])
        if self.sampling.taken == 0:
            self.sums = np.zeros(len(now))
        last = sorted(self.off)
        self.sums += now
        self.sums[last] = now[last]
        if not self.sampling.done(world.step):
            return
        mean = self.sums / self.sampling.repeat
        mean[last] = now[last]
        self._join(mean, last)
        shown = (f"{value:g}" for value in self.mean())
        self.report.write([" ".join([str(world.step), *shown])])

    def _join(self, mean: Floats, last: list[int]) -> None:
        """Add an average to those that count."""
        if self.report.mode == "running":
            total = self.means.pop() + mean if self.means else mean.copy()
            self.means.append(total)
            self.count += 1
            total[last] = self.count * mean[last]
            return
        self.means.append(mean)
        if len(self.means) > self.report.window:
            self.means.popleft()
        self.count = len(self.means)
        for one in self.means:
            one[last] = mean[last]
