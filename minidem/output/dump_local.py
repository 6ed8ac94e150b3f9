"""``dump ID GROUP local N FILE c_ID[1] ...`` and ``local/gran/vtk N FILE ID``: contacts."""

from __future__ import annotations

from pathlib import Path
from typing import ClassVar, Final

import numpy as np

from minidem.errors import InputError
from minidem.output.columns import split_indices
from minidem.output.dump import DUMPS, Dump, TextDump, write_snapshot
from minidem.output.dump_custom import corners, letters
from minidem.output.dump_vtk import vtk_format
from minidem.output.text.custom import custom_frame
from minidem.output.text.formats import column_formats
from minidem.output.text.polydata import LINES, PolyData
from minidem.record import field, record
from minidem.words import Words, integer
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["DumpLocal", "DumpLocalVtk", "local_columns"]

_ENDS: Final = ("pos1", "pos2")
_POINT: Final = "contact_point"
_NO_FIELD: Final = (*_ENDS, _POINT, "periodic", "history")


def local_columns(world: World, name: str) -> Floats:
    """Return the values per contact of compute `name` as columns, shape (contacts, columns)."""
    values = [np.atleast_2d(value.T).T for value in world.computes[name].local(world).values()]
    found: Floats = np.concatenate(values, axis=1)
    return found


def _needed(world: World, name: str, dump: str) -> None:
    """Refuse an id that is no compute of contacts."""
    if name not in world.computes or not world.computes[name].per_contact:
        msg = f"dump {dump}: '{name[:40]}' is no compute of contacts, as pair/gran/local is"
        raise InputError(msg)


@DUMPS.register("local")
@record
class DumpLocal(TextDump):
    """``dump local``: values per contact as text.

    Attributes
    ----------
    columns : tuple of str
        ``index`` and ``c_ID[i]``.
    label : str
        What the header calls a line.
    sort : int
        Column to sort by, from 1, negative for descending; 0 for none.
    formats : list of str
        Python formats of the columns, empty for the defaults.
    """

    columns: tuple[str, ...] = ()
    label: str = "ENTRIES"
    sort: int = 0
    formats: list[str] = field(default_factory=list)

    keywords: ClassVar[tuple[str, ...]] = (*TextDump.keywords, "label")

    def read_rest(self, world: World, words: Words) -> None:
        """Read the columns."""
        words.need(1, f"dump ID GROUP {self.style} N FILE c_ID[1] ...")
        self.columns = tuple(words.rest())
        for column in self.columns:
            if column != "index":
                _needed(world, _compute_of(column), self.name)
        if all(column == "index" for column in self.columns):
            msg = f"dump {self.name}: no column is one of a compute, c_ID[1]"
            raise InputError(msg)

    def modify(self, key: str, words: Words) -> None:
        """Read the value of a keyword of local dumps, or of a common one."""
        if key == "label":
            self.label = words.take("a label")
        elif key == "format":
            text = words.take("formats")
            integers = [column == "index" for column in self.columns]
            self.formats = column_formats(None if text == "none" else text, integers)
        elif key == "sort":
            word = words.take("a column")
            self.sort = 0 if word == "off" else integer(word, f"dump_modify {self.name} sort")
            if abs(self.sort) > len(self.columns):
                msg = f"dump_modify {self.name} sort: there are {len(self.columns)} columns"
                raise InputError(msg)
        else:
            super().modify(key, words)

    def write(self, world: World, target: Path) -> None:
        """Append a snapshot, or write it to a file of its own."""
        names = dict.fromkeys(_compute_of(c) for c in self.columns if c != "index")
        tables = {name: local_columns(world, name) for name in names}
        rows = {len(table) for table in tables.values()}
        if len(rows) != 1:
            msg = f"dump {self.name}: the computes have different numbers of contacts"
            raise InputError(msg)
        values = [
            (c, np.arange(1, 1 + next(iter(rows))) if c == "index" else self._column(tables, c))
            for c in self.columns
        ]
        if self.sort:
            key = values[abs(self.sort) - 1][1]
            order = np.argsort(-key if self.sort < 0 else key, kind="stable")
            values = [(column, value[order]) for column, value in values]
        formats = self.formats or column_formats(None, [c == "index" for c in self.columns])
        text = custom_frame(world.step, corners(world), letters(world), values, formats, self.label)
        self.put(target, text)

    def _column(self, tables: dict[str, Floats], column: str) -> Floats:
        _, indices = split_indices(column)
        table = tables[_compute_of(column)]
        at = indices[0] if indices else 1
        if at > table.shape[1]:
            msg = f"dump {self.name}: {column}: the compute has {table.shape[1]} columns"
            raise InputError(msg)
        place = at - 1
        found: Floats = table[:, place]
        return found


def _compute_of(column: str) -> str:
    """Return the id in ``c_ID[i]``."""
    base, _ = split_indices(column)
    return base.removeprefix("c_")


@DUMPS.register("local/gran/vtk")
@record
class DumpLocalVtk(Dump):
    """``dump local/gran/vtk``: contacts as lines between the centres.

    Attributes
    ----------
    compute : str
        Id of a compute of contacts.
    """

    compute: str = ""

    keywords: ClassVar[tuple[str, ...]] = (
        *Dump.keywords, "binary", "compressor", "label",
    )  # fmt: skip

    suffixes: ClassVar[tuple[str, ...]] = (".vtk", ".vtp", ".vtu")

    def read_rest(self, world: World, words: Words) -> None:
        """Read the id of the compute, which must give positions."""
        vtk_format(self, self.suffixes)
        self.compute = words.take("the ID of a compute pair/gran/local")
        _needed(world, self.compute, self.name)
        if "pos" not in world.computes[self.compute].wanted:
            msg = f"dump {self.name}: compute {self.compute} must have the keyword 'pos'"
            raise InputError(msg)

    def write(self, world: World, target: Path) -> None:
        """Write the contacts."""
        values = world.computes[self.compute].local(world)
        ends = [values[name] for name in _ENDS]
        fields = [(name, value) for name, value in values.items() if name not in _NO_FIELD]
        order = None
        if _POINT in values:
            # three lines: from centre to centre, and from both to the point of contact
            ends.append(values[_POINT])
            fields = [(name, np.repeat(value, 3, axis=0)) for name, value in fields]
            first = 3 * np.arange(len(ends[0]))[:, None]
            order = (first + np.array([0, 1, 0, 2, 1, 2])).ravel()
        points = np.stack(ends, axis=1).reshape(-1, 3)
        data = PolyData(points, LINES, (), fields, order)
        write_snapshot(target, vtk_format(self, self.suffixes).text(data))
