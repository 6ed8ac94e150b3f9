"""``dump ID GROUP custom N FILE COLUMN ...``: particles as text, or as numbers (``.bin``)."""

from __future__ import annotations

import operator
from collections.abc import Callable
from pathlib import Path
from typing import Any, ClassVar, Final

import numpy as np
from numpy.typing import NDArray

from minidem.errors import InputError
from minidem.kernels.columns import POSITION
from minidem.output.columns import atom_vector, check_columns, is_whole
from minidem.output.dump import DUMPS, UNSORTED, TextDump, sort_key, sorted_rows
from minidem.output.text.binary import binary_frame
from minidem.output.text.custom import custom_frame
from minidem.output.text.formats import column_formats
from minidem.record import field, record
from minidem.words import Words, variables_in
from minidem.world.state import Ints
from minidem.world.values.named import need_names
from minidem.world.world import World

__all__ = ["DumpCustom", "corners", "element_names", "letters"]

ELEMENT: Final = "element"
"""Column of the names that ``dump_modify element`` gives to atom types."""
_NAMELESS: Final = "C"
_BINARY: Final = ".bin"
"""End of the names of files that hold numbers as the machine has them."""

_COMPARE: Final[dict[str, Callable[[Any, Any], Any]]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
}


@DUMPS.register("custom")
@record
class DumpCustom(TextDump):
    """``dump custom``: columns of particle values as text.

    Attributes
    ----------
    columns : tuple of str
        What is written.
    sort : int
        See `minidem.output.dump.sort_key`.
    formats : list of str
        Python formats of the columns, empty for the defaults.
    label : str
        A line of the header; empty for none.
    elements : list of str
        Names of the atom types, for the column `ELEMENT`; empty for C.
    types : int
        Number of atom types.
    region : str
        Only particles in this region; empty for all.
    thresholds : list of (str, str, float)
        Only particles that fulfil them all.
    """

    columns: tuple[str, ...] = ()
    sort: int = UNSORTED
    formats: list[str] = field(default_factory=list)
    label: str = ""
    elements: list[str] = field(default_factory=list)
    types: int = 1
    region: str = ""
    thresholds: list[tuple[str, str, float]] = field(default_factory=list)

    keywords: ClassVar[tuple[str, ...]] = (
        *TextDump.keywords, "element", "label", "region", "thresh",
    )  # fmt: skip
    words: ClassVar[tuple[str, ...]] = (ELEMENT,)
    """Columns that hold words."""

    def read_rest(self, world: World, words: Words) -> None:
        """Read the columns."""
        words.need(1, f"dump ID GROUP {self.style} N FILE COLUMN ...")
        self.columns = check_columns(words.rest(), self.words)
        need_names(world, f"dump {self.name}", self.columns, per_atom=True)
        self.types = world.types

    def variables_asked(self) -> tuple[str, ...]:
        """Return those of its columns, too."""
        return (*super().variables_asked(), *variables_in(self.columns))

    def modify(self, key: str, words: Words) -> None:
        """Read the value of a keyword of particle dumps, or of a common one."""
        if key == "sort":
            self.sort = sort_key(self, words, len(self.columns))
        elif key == "format":
            text = words.take("formats")
            self.formats = self._formats(None if text == "none" else text)
        elif key == "label":
            self.label = words.take("a label")
        elif key == "element":
            self.elements = element_names(words, self.types)
        elif key == "region":
            region = words.take("a region")
            self.region = "" if region == "none" else region
        elif key == "thresh":
            self._threshold(words)
        else:
            super().modify(key, words)

    def _formats(self, text: str | None) -> list[str]:
        """Return the formats of the columns, the usual ones for None."""
        whole = [is_whole(column) for column in self.columns]
        return column_formats(text, whole, [column in self.words for column in self.columns])

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
        order = self._chosen(world)
        return [(name, self._values(world, name)[order]) for name in (*self.columns, *more)]

    def _chosen(self, world: World) -> Ints:
        """Return the particles that are written, in their order."""
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
        return sorted_rows(
            self.sort, order, world.state.ids, lambda column: self._numbers(world, column)
        )

    def _numbers(self, world: World, column: int) -> NDArray[Any]:
        """Return the numbers of column number `column`; those of names are the types."""
        *_, name = self.columns[:column]
        return atom_vector(world, "type" if name in self.words else name)

    def _values(self, world: World, name: str) -> NDArray[Any]:
        if name in self.words:
            kind = world.state.kind[: world.state.n]
            named = bool(self.elements)
            return np.array(self.elements)[kind] if named else np.full(len(kind), _NAMELESS)
        values = atom_vector(world, name)
        return values.astype(np.int64) if is_whole(name) else values

    def write(self, world: World, target: Path) -> None:
        """Append a snapshot, or write it to a file of its own."""
        if self.path.endswith(_BINARY):
            self.put(target, self._binary(world))
            return
        columns = self.select(world)
        formats = self.formats or self._formats(None)
        text = custom_frame(
            world.step, corners(world), letters(world), columns, formats, title=self.label
        )
        self.put(target, text)

    def _binary(self, world: World) -> bytes:
        """Return a snapshot as numbers."""
        order = self._chosen(world)
        columns = [self._numbers(world, 1 + k)[order] for k in range(len(self.columns))]
        return binary_frame(world.step, corners(world), letters(world), columns)


def element_names(words: Words, types: int) -> list[str]:
    """Read a name for each atom type, which ``dump_modify element`` gives."""
    words.need(types, "dump_modify ID element " + " ".join(f"E{k + 1}" for k in range(types)))
    return [words.take("a name") for _ in range(types)]


def corners(world: World) -> NDArray[np.float64]:
    """Return the simulation box as lower and upper corner, shape (2, 3)."""
    box = world.need_box()
    return np.array([box.lo, box.hi], dtype=np.float64)


def letters(world: World) -> tuple[str, str, str]:
    """Return the boundary letters of the box, two per direction."""
    first, second, third = world.need_box().boundary
    return first, second, third
