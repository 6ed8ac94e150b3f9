"""Dumps: what is written, when and where; the text itself is made by `minidem.output.text`."""

from __future__ import annotations

import operator
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from minidem.errors import suggest
from minidem.output.quantities import Quantities
from minidem.output.text import (
    bounding_box_file,
    bounding_box_name,
    column_formats,
    custom_frame,
    frame_name,
    particle_file,
    stl_file,
)
from minidem.script.paths import inside
from minidem.world.world import World

__all__ = ["Dump", "DumpCustom", "DumpStl", "DumpVtk"]

WHOLE: Final = ("id", "type", "ix", "iy", "iz")
"""Columns that hold whole numbers."""

_IGNORED: Final = ("flush", "nfile", "fileper", "buffer")
_COMPARE: Final[dict[str, Callable[[Any, Any], Any]]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
}


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
    last : int
        Step of the latest snapshot, -1 for none.
    pad : int
        Digits of the step in the file name, 0 for as many as needed.
    """

    name: str
    bit: int
    every: int
    path: str
    first: bool = False
    last: int = -1
    pad: int = 0

    def next_step(self, step: int) -> int:
        """Return the next multiple of the interval."""
        return (step // self.every + 1) * self.every

    def act(self, world: World, step: int) -> None:
        """Write a snapshot."""
        self.last = step
        # ``first`` asks for the very first snapshot only.
        self.first = False
        self.write(world, step, inside(world.root, frame_name(self.path, step, self.pad)))

    def write(self, world: World, step: int, target: Path) -> None:
        """Write a snapshot to a file."""
        raise NotImplementedError

    def modify(self, key: str, values: Sequence[str]) -> int:
        """Apply a ``dump_modify`` keyword; return how many words it took.

        Raises
        ------
        ValueError
            If this dump does not know it, or the value is not understood.
        """
        if key == "first":
            self.first = _yes_no(key, values[0])
        elif key == "every":
            self.every = _count(key, values[0], 1)
        elif key == "pad":
            self.pad = min(_count(key, values[0], 0), 20)
        elif key not in _IGNORED:
            known = ("first", "every", "pad", *_IGNORED, *self.own_keywords())
            msg = f"dump_modify {self.name}: unknown keyword '{key[:40]}'{suggest(key[:80], known)}"
            raise ValueError(msg)
        return 1

    def own_keywords(self) -> tuple[str, ...]:
        """Return the ``dump_modify`` keywords beyond the common ones."""
        return ()


@dataclass
class DumpCustom(Dump):
    """``dump custom``: columns of particle values as text.

    Attributes
    ----------
    columns : tuple of str
        What is written.
    sort : int
        0 for the internal order; else column number from 1, negative for descending; `BY_ID`.
    formats : list of str
        Python formats of the columns, empty for the defaults.
    region : str
        Only particles in this region; empty for all.
    thresholds : list of (str, str, float)
        Only particles that fulfil them all.
    append : bool
        Go on with an existing file.
    """

    columns: tuple[str, ...] = ()
    sort: int = 0
    formats: list[str] = field(default_factory=list)
    region: str = ""
    thresholds: list[tuple[str, str, float]] = field(default_factory=list)
    append: bool = False

    def own_keywords(self) -> tuple[str, ...]:
        """Return the keywords of particle dumps."""
        return ("append", "format", "region", "sort", "thresh")

    def modify(self, key: str, values: Sequence[str]) -> int:
        """Apply the keywords of particle dumps and the common ones."""
        if key == "sort":
            self.sort = self._sort_key(values[0])
        elif key == "format":
            integers = [column in WHOLE for column in self.columns]
            none = values[0] == "none"
            self.formats = column_formats(None if none else values[0], integers)
        elif key == "region":
            self.region = "" if values[0] == "none" else values[0]
        elif key == "append":
            self.append = _yes_no(key, values[0])
        elif key == "thresh":
            return self._threshold(values)
        else:
            return super().modify(key, values)
        return 1

    def _sort_key(self, word: str) -> int:
        if word in ("off", "id"):
            return BY_ID if word == "id" else 0
        column = _count("sort", word.removeprefix("-"), 1)
        if column > len(self.columns):
            msg = f"dump_modify {self.name} sort: there are {len(self.columns)} columns, not {word}"
            raise ValueError(msg)
        return -column if word.startswith("-") else column

    def _threshold(self, values: Sequence[str]) -> int:
        if values[0] == "none":
            self.thresholds = []
            return 1
        if len(values) < 3 or values[1] not in _COMPARE:
            msg = f"dump_modify {self.name} thresh: expected COLUMN < VALUE (or <= > >= == !=)"
            raise ValueError(msg)
        try:
            self.thresholds.append((values[0], values[1], float(values[2])))
        except ValueError as err:
            msg = f"dump_modify {self.name} thresh: '{values[2][:40]}' is not a number"
            raise ValueError(msg) from err
        return 3

    def select(self, world: World) -> list[tuple[str, NDArray[Any]]]:
        """Return names and values of the columns, particles in output order."""
        asks = Quantities(world)
        order = world.state.output_order()
        chosen = world.member(self.bit)
        if self.region:
            if self.region not in world.regions:
                msg = f"dump {self.name}: region '{self.region}' does not exist"
                raise ValueError(msg)
            chosen = chosen & world.regions[self.region].match(world.state.row[: world.state.n, :3])
        for column, compare, value in self.thresholds:
            chosen = chosen & _COMPARE[compare](asks.atom_vector(column), value)
        order = order[chosen[order]]
        if self.sort:
            column = "id" if self.sort == BY_ID else self.columns[abs(self.sort) - 1]
            keys = asks.atom_vector(column)[order]
            backwards = self.sort < 0 and self.sort != BY_ID
            order = order[np.argsort(-keys if backwards else keys, kind="stable")]
        found: list[tuple[str, NDArray[Any]]] = []
        for name in self.columns:
            values = asks.atom_vector(name)[order]
            found.append((name, values.astype(np.int64) if name in WHOLE else values))
        return found

    def write(self, world: World, step: int, target: Path) -> None:
        """Append a snapshot, or write it to a file of its own."""
        columns = self.select(world)
        integers = [name in WHOLE for name, _ in columns]
        formats = self.formats or column_formats(None, integers)
        text = custom_frame(step, box_of(world), _letters(world), columns, formats)
        if "*" in self.path:
            write_whole(target, text)
            return
        target.parent.mkdir(parents=True, exist_ok=True)
        with target.open("a" if self.append else "w", encoding="ascii") as file:
            file.write(text)
        # The next snapshot of this dump goes behind this one.
        self.append = True


@dataclass
class DumpVtk(DumpCustom):
    """``dump custom/vtk``: particles and simulation box as legacy VTK files."""

    def write(self, world: World, step: int, target: Path) -> None:
        """Write the particles and the box."""
        write_whole(target, particle_file(self.select(world)))
        name = frame_name(bounding_box_name(self.path), step, self.pad)
        write_whole(inside(world.root, name), bounding_box_file(box_of(world)))


@dataclass
class DumpStl(Dump):
    """``dump mesh/stl``: meshes where they are now.

    Attributes
    ----------
    meshes : tuple of str
        Ids of the meshes, empty for all.
    """

    meshes: tuple[str, ...] = ()

    def write(self, world: World, step: int, target: Path) -> None:
        """Write the triangles, mesh after mesh."""
        del step
        store = world.meshes
        spans = [store.span(name) for name in self.meshes or store.names]
        nodes = [store.table.node[lo:hi] for lo, hi in spans]
        write_whole(target, stl_file(np.concatenate([np.empty((0, 3, 3)), *nodes])))


BY_ID: Final = -1_000_000
"""Sort key: the particle id."""


def box_of(world: World) -> NDArray[np.float64]:
    """Return the simulation box as lower and upper corner, shape (2, 3)."""
    box = world.need_box()
    return np.array([box.lo, box.hi], dtype=np.float64)


def write_whole(target: Path, text: str) -> None:
    """Write a file that is either complete or not there."""
    target.parent.mkdir(parents=True, exist_ok=True)
    part = target.with_name(target.name + ".part")
    part.write_text(text, encoding="ascii", newline="\n")
    part.replace(target)


def _letters(world: World) -> tuple[str, str, str]:
    first, second, third = world.need_box().boundary
    return first, second, third


def _yes_no(key: str, word: str) -> bool:
    if word not in ("yes", "no"):
        msg = f"dump_modify {key}: expected yes or no, got '{word[:40]}'"
        raise ValueError(msg)
    return word == "yes"


def _count(key: str, word: str, least: int) -> int:
    if not word.isascii() or not word.isdigit() or int(word) < least:
        msg = f"dump_modify {key}: expected a whole number from {least}, got '{word[:40]}'"
        raise ValueError(msg)
    return int(word)
