"""Insertion: two or three commands that share a distribution and a face or a region.

Some are taken away half-way, and others come. Streams of one face are equally fast: between
particles in flight that slide on each other, the friction at the beginning of a run is that of the
step before, and rounding decides whether it is at its limit.
"""

from __future__ import annotations

import numpy as np

from tests.twins.references.batch import Batch
from tests.twins.references.insertions import CELLS, STEPS, STYLES, Cell, primes
from tests.twins.references.places import HALF, dump, header


class SharedCell(Cell):
    """A cell whose commands have one distribution and one place."""

    _made: tuple[np.ndarray, bool] | None = None
    _pace: float | None = None
    _name = ""

    def _face(self) -> tuple[np.ndarray, bool]:
        self._made = self._made or super()._face()
        return self._made

    def _speed(self) -> float:
        self._pace = self._pace or super()._speed()
        return self._pace

    def _region(self) -> str:
        self._name = self._name or super()._region()
        return self._name

    def stages(self) -> tuple[list[str], list[str]]:
        """Return the lines of the first half and those of the second."""
        rng = self.rng
        self._distribution()
        styles = STYLES[2:] if rng.uniform() < 0.6 else STYLES[:2]
        count = int(rng.integers(2, 4))
        commands = [self._command(str(rng.choice(styles)), f"{j}") for j in range(count)]
        later = []
        if rng.uniform() < 0.4:
            later.append(f"unfix i{self.k}{int(rng.integers(count))}")
        if rng.uniform() < 0.4:
            later.append(self._command(str(rng.choice(styles)), f"{count}"))
        return [*self.lines, *commands], later


def batch(seed: int) -> Batch:
    """Return six groups of commands of a seed."""
    rng = np.random.default_rng([44, seed])
    numbers = primes(300)
    cells = [SharedCell(rng, k, numbers) for k in range(CELLS)]
    boundary = str(rng.choice(["f f f", "p p p", "p f p"]))
    stages = [cell.stages() for cell in cells]
    lines = header(boundary, HALF, 0.001)
    lines += [line for first, _ in stages for line in first]
    lines += ["fix free all nve/sphere", *dump("out", 20, "id x y z vx vy vz radius mass")]
    lines += [f"run {STEPS}", *(line for _, second in stages for line in second)]
    lines += [f"run {STEPS}", ""]
    files = {name: text for cell in cells for name, text in cell.files.items()}
    return Batch(f"sharing-{seed}", "\n".join(lines), ("out.dump",), CELLS, files)
