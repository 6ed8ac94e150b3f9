"""``fix ID GROUP ave/correlate EVERY REPEAT PERIOD INPUT ...``: how values follow each other."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Final

import numpy as np

from minidem.errors import InputError
from minidem.output.averages.report import REPORT_OPTIONS, Report
from minidem.output.averages.sampling import refuse_missed
from minidem.output.quantities import Quantities
from minidem.record import field, record
from minidem.registry import Head
from minidem.words import Words, variables_in
from minidem.world.event import NEVER
from minidem.world.fix import FIXES, Fix
from minidem.world.state import Floats
from minidem.world.values.named import need_names
from minidem.world.world import World

__all__ = ["Correlation"]

_OPTIONS: Final = ("type", "start", "prefactor", *REPORT_OPTIONS)
_PREFIXES: Final = ("c_", "f_", "v_")
_TYPES: Final[dict[str, Callable[[int, int], bool]]] = {
    "auto": lambda i, j: i == j,
    "upper": lambda i, j: i < j,
    "lower": lambda i, j: i > j,
    "auto/upper": lambda i, j: i <= j,
    "auto/lower": lambda i, j: i >= j,
    "full": lambda i, j: True,
}
_MOST: Final = 1_000_000  # numbers that are kept
_APART, _COUNT, _MEANS = range(3)  # columns of results


@FIXES.register("ave/correlate")
@record
class Correlation(Fix):
    """Time correlations of global values.

    Attributes
    ----------
    every, repeat, period : int
        Steps between samples, number of time differences, steps between results.
    names : tuple of str
        What is correlated.
    report : Report
        File, and whether results are of all samples so far (``running``).
    pairs : list of (int, int)
        The earlier and the later input of each column, from 0.
    first : int
        No sample before this step.
    due : int
        Step of the next sample.
    factor : float
        What results are multiplied with.
    samples : deque of ndarray
        The latest samples, the last one first.
    counts : ndarray, shape (repeat,)
        Samples of each time difference.
    sums : ndarray, shape (repeat, pairs)
        Their products.
    result : ndarray, shape (repeat, 2 + pairs)
        Time differences, in steps, numbers and means of the last result.
    """

    every: int
    repeat: int
    period: int
    names: tuple[str, ...]
    report: Report
    pairs: list[tuple[int, int]] = field(default_factory=list)
    first: int = 0
    due: int = -1
    factor: float = 1.0
    samples: deque[Floats] = field(default_factory=deque)
    counts: Floats = field(default_factory=lambda: np.zeros(0))
    sums: Floats = field(default_factory=lambda: np.zeros((0, 0)))
    result: Floats = field(default_factory=lambda: np.zeros((0, 0)))

    def variables_asked(self) -> tuple[str, ...]:
        """Return the names of the variables that it asks in a run."""
        return variables_in(self.names)

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Correlation:
        """Read intervals, inputs and options, and begin the file."""
        words.need(4, "fix ID GROUP ave/correlate EVERY REPEAT PERIOD c_ID ...")
        every, repeat, period = words.interval(), words.interval(), words.interval()
        names = []
        while words.peek()[:2] in _PREFIXES:
            names.append(words.take("an input"))
        if not names:
            words.expect("c_ID")
        need_names(world, f"fix {head.style}", names, per_atom=False)
        titles = [
            f"# Time-correlated data for fix {head.name}", "# Timestep Number-of-time-windows", "",
        ]  # fmt: skip
        made = cls(*head, every, repeat, period, tuple(names), Report(titles))
        kind = "auto"
        while not words.done():
            kind = made._option(world, words, kind)
        fits = made.report.mode == "running" or (repeat - 1) * every <= period
        if period % every or not fits:
            msg = (
                f"fix ave/correlate: {repeat} samples, {every} steps apart, must fit into {period} "
                f"steps, a multiple of {every}"
            )
            raise InputError(msg)
        count = len(names)
        made.pairs = [(i, j) for i in range(count) for j in range(count) if _TYPES[kind](i, j)]
        if repeat * (2 + len(made.pairs)) > _MOST:
            msg = f"fix ave/correlate: more than {_MOST} numbers; use fewer samples or inputs"
            raise InputError(msg)
        shown = " ".join(f"{names[i]}*{names[j]}" for i, j in made.pairs)
        titles[2] = titles[2] or f"# Index TimeDelta Ncount {shown}"
        made._forget()
        made.due = made._due_from(world.step)
        made.result = np.zeros((repeat, 2 + len(made.pairs)))
        made.result[:, _APART] = every * np.arange(repeat)
        made.report.begin(head.style)
        return made

    def _option(self, world: World, words: Words, kind: str) -> str:
        """Read an option; return which pairs are correlated."""
        key = words.choice(_OPTIONS)
        if key == "type":
            return words.choice(tuple(_TYPES), key)
        if key == "start":
            self.first = words.integer()
        elif key == "prefactor":
            self.factor = words.number()
        else:
            self.report.read_option(world, key, words, ("one", "running"))
        return kind

    def _forget(self) -> None:
        self.counts = np.zeros(self.repeat)
        self.sums = np.zeros((self.repeat, len(self.pairs)))

    def element(self, world: World, indices: tuple[int, ...]) -> float:
        """Return time difference (1), number (2) or means (3 ...) of a row, from 1."""
        rows, columns = self.result.shape
        if len(indices) != 2 or indices[0] > rows or indices[1] > columns:
            return super().element(world, indices)
        return float(self.result[tuple(index - 1 for index in indices)])

    def start(self, world: World) -> None:
        """Take a sample at the start of a run if one is due; begin anew if it has been missed."""
        if self.due < world.step:
            self.samples.clear()
            self.due = self._due_from(world.step)
        if self.due == world.step:
            self.act(world)

    def next_step(self, step: int) -> int:
        """Return the step of the next sample."""
        return self.due if self.due > step else NEVER

    def _due_from(self, step: int) -> int:
        """Return the first step with a sample from a step on."""
        return -(-max(step, self.first) // self.every) * self.every

    def steps_shifted(self, world: World, shift: int) -> None:
        """Keep the step of the next sample, as LIGGGHTS does."""
        late = max(0, (world.step - self.due) // self.every + 1)
        refuse_missed(self, self.due + late * self.every, world.step + shift)

    def act(self, world: World) -> None:
        """Take a sample, and give a result if it is time."""
        self.due = world.step + self.every
        ask = Quantities(world).value
        self.samples.appendleft(np.array([ask(name) for name in self.names]))
        if len(self.samples) > self.repeat:
            self.samples.pop()
        self._add()
        if world.step % self.period:
            return
        filled = np.maximum(self.counts, 1.0)[:, None]
        self.result[:, _COUNT] = self.counts
        self.result[:, _MEANS:] = self.factor * self.sums / filled
        self._write(world)
        if self.report.mode == "one":
            self._forget()
            while len(self.samples) > 1:
                self.samples.pop()
            self._add()

    def _add(self) -> None:
        """Add the products of the latest sample with those before."""
        now = self.samples[0]
        for k, before in enumerate(self.samples):
            self.counts[k] += 1
            self.sums[k] += [before[i] * now[j] for i, j in self.pairs]

    def _write(self, world: World) -> None:
        lines = [f"{world.step} {self.repeat}"]
        for k, (apart, count, *means) in enumerate(self.result.tolist(), 1):
            shown = " ".join(f"{mean:g}" if count else "0.0" for mean in means)
            lines.append(f"{k} {apart:.0f} {count:.0f} {shown}")
        self.report.write(lines)
