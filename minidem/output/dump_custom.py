"""``dump ID GROUP custom N FILE COLUMN ...``: particles as text."""

from __future__ import annotations

import operator
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar, Final

import numpy as np
from numpy.typing import NDArray

from minidem.errors import InputError
from minidem.kernels.columns import POSITION
from minidem.output.columns import atom_vector, check_columns, is_whole
from minidem.output.dump import DUMPS, TextDump
from minidem.output.text import column_formats, custom_frame
from minidem.words import Words, integer, variables_in
from minidem.world.world import World

__all__ = ["DumpCustom", "corners", "letters"]

BY_ID: Final = -1_000_000
"""Sort key: the particle id."""

_COMPARE: Final[dict[str, Callable[[Any, Any], Any]]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
}


@DUMPS.register("custom")
@dataclass
class DumpCustom(TextDump):
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
    """

    columns: tuple[str, ...] = ()
    sort: int = 0
    formats: list[str] = field(default_factory=list)
    region: str = ""
    thresholds: list[tuple[str, str, float]] = field(default_factory=list)

    keywords: ClassVar[tuple[str, ...]] = (
        *TextDump.keywords, "format", "region", "sort", "thresh",
    )  # fmt: skip

    def read_rest(self, world: World, words: Words) -> None:
        """Read the columns."""
        del world
        words.need(1, f"dump ID GROUP {self.style} N FILE COLUMN ...")
        self.columns = check_columns(words.rest())

    def variables_asked(self) -> tuple[str, ...]:
        """Return those of its columns, too."""
        return (*super().variables_asked(), *variables_in(self.columns))

    def modify(self, key: str, words: Words) -> None:
        """Read the value of a keyword of particle dumps, or of a common one."""
        if key == "sort":
            self.sort = self._sort_key(words.take("a column"))
        elif key == "format":
            text = words.take("formats")
            integers = [is_whole(column) for column in self.columns]
            self.formats = column_formats(None if text == "none" else text, integers)
        elif key == "region":
            region = words.take("a region")
            self.region = "" if region == "none" else region
        elif key == "thresh":
            self._threshold(words)
        else:
            super().modify(key, words)

    def _sort_key(self, word: str) -> int:
        if word in ("off", "id"):
            return BY_ID if word == "id" else 0
        column = integer(word, f"dump_modify {self.name} sort")
        if not 1 <= abs(column) <= len(self.columns):
            msg = f"dump_modify {self.name} sort: there are {len(self.columns)} columns, not {word}"
            raise InputError(msg)
        return column

    def _threshold(self, words: Words) -> None:
        column = words.take("a column")
        if column == "none":
            self.thresholds = []
            return
        if words.peek() not in _COMPARE:
            msg = f"dump_modify {self.name} thresh: expected COLUMN < VALUE (or <= > >= == !=)"
            raise InputError(msg)
        self.thresholds.append((column, words.take("a comparison"), words.number()))

    def select(self, world: World, more: tuple[str, ...] = ()) -> list[tuple[str, NDArray[Any]]]:
        """Return names and values of the columns and some more, particles in output order."""
        order = world.state.output_order()
        chosen = world.member(self.bit)
        if self.region:
            if self.region not in world.regions:
                msg = f"dump {self.name}: region '{self.region}' does not exist"
                raise InputError(msg)
            chosen = chosen & world.regions[self.region].match(
                world.state.row[: world.state.n, POSITION]
            )
        for column, compare, value in self.thresholds:
            chosen = chosen & _COMPARE[compare](atom_vector(world, column), value)
        order = order[chosen[order]]
        if self.sort:
            column = "id" if self.sort == BY_ID else self.columns[abs(self.sort) - 1]
            keys = atom_vector(world, column)[order]
            backwards = self.sort < 0 and self.sort != BY_ID
            order = order[np.argsort(-keys if backwards else keys, kind="stable")]
        found: list[tuple[str, NDArray[Any]]] = []
        for name in (*self.columns, *more):
            values = atom_vector(world, name)[order]
            found.append((name, values.astype(np.int64) if is_whole(name) else values))
        return found

    def write(self, world: World, target: Path) -> None:
        """Append a snapshot, or write it to a file of its own."""
        columns = self.select(world)
        integers = [is_whole(name) for name, _ in columns]
        formats = self.formats or column_formats(None, integers)
        text = custom_frame(world.step, corners(world), letters(world), columns, formats)
        self.put(target, text)


def corners(world: World) -> NDArray[np.float64]:
    """Return the simulation box as lower and upper corner, shape (2, 3)."""
    box = world.need_box()
    return np.array([box.lo, box.hi], dtype=np.float64)


def letters(world: World) -> tuple[str, str, str]:
    """Return the boundary letters of the box, two per direction."""
    first, second, third = world.need_box().boundary
    return first, second, third
