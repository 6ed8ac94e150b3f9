"""Dumps: what is written, when and where; the text itself is made by `minidem.output`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from minidem.quantities import Quantities
from minidem.script.paths import inside
from minidem.state import Floats
from minidem.world import World

__all__ = ["Dump", "DumpCustom"]

_WHOLE = ("id", "type", "ix", "iy", "iz")


@dataclass
class Dump:
    """A dump: snapshot every so many steps.

    Attributes
    ----------
    name : str
        Its id.
    bit : int
        Group bit.
    every : int
        Interval in steps.
    path : str
        File name; ``*`` stands for the step.
    first : bool
        Write at the first step of a run even if it is no multiple of `every`.
    """

    name: str
    bit: int
    every: int
    path: str
    first: bool = False
    last: int = -1

    def next_step(self, step: int) -> int:
        """Return the next multiple of the interval."""
        return (step // self.every + 1) * self.every

    def act(self, world: World, step: int) -> None:
        """Write a snapshot."""
        self.last = step
        target = inside(world.root, self.path.replace("*", str(step)))
        target.parent.mkdir(parents=True, exist_ok=True)
        self.write(world, step, target)

    def write(self, world: World, step: int, target: Path) -> None:
        """Write a snapshot to a file; a file with ``*`` in its name holds one snapshot."""
        raise NotImplementedError

    def modify(self, key: str, values: Sequence[str]) -> int:
        """Apply a ``dump_modify`` keyword; return how many words it took.

        Raises
        ------
        ValueError
            If this dump does not know it.
        """
        if key == "first":
            self.first = values[0] == "yes"
            return 1
        if key == "every":
            self.every = int(values[0])
            return 1
        if key in ("flush", "pad", "append", "nfile", "fileper", "thresh", "buffer"):
            return 1
        msg = f"dump_modify {key} is not supported for this dump"
        raise ValueError(msg)


@dataclass
class DumpCustom(Dump):
    """``dump custom``: columns of particle values as text."""

    columns: tuple[str, ...] = ()
    sort: str = ""
    formats: list[str] = field(default_factory=list)
    started: bool = False

    def modify(self, key: str, values: Sequence[str]) -> int:
        """Apply ``sort``, ``format`` and the common keywords."""
        if key == "sort":
            self.sort = "" if values[0] == "off" else values[0]
            return 1
        if key == "format":
            self.formats = values[0].split()
            return 1
        return super().modify(key, values)

    def select(self, world: World) -> tuple[Floats, list[Floats]]:
        """Return the particles in output order and their columns."""
        order = world.state.output_order()
        order = order[world.member(self.bit)[order]]
        if self.sort == "id":
            order = order[np.argsort(world.state.ids[order], kind="stable")]
        asks = Quantities(world)
        return order, [asks.atom_vector(name)[order] for name in self.columns]

    def write(self, world: World, step: int, target: Path) -> None:
        """Append a snapshot, or write it to a file of its own."""
        order, columns = self.select(world)
        formats = self.formats or ["%d" if c in _WHOLE else "%g" for c in self.columns]
        box = world.need_box()
        lines = [
            "ITEM: TIMESTEP", str(step), "ITEM: NUMBER OF ATOMS", str(len(order)),
            "ITEM: BOX BOUNDS " + " ".join(box.boundary),
            *(f"{lo:g} {hi:g}" for lo, hi in zip(box.lo, box.hi, strict=True)),
            "ITEM: ATOMS " + " ".join(self.columns) + " ",
        ]  # fmt: skip
        line = " ".join(formats) + " "
        typed = [
            c.astype(np.int64).tolist() if "d" in f else c.tolist()
            for c, f in zip(columns, formats, strict=True)
        ]
        lines.extend(line % row for row in zip(*typed, strict=True))
        mode = "w" if "*" in self.path or not self.started else "a"
        self.started = True
        with target.open(mode) as out:
            out.write("\n".join(lines) + "\n")
