"""``dump ID GROUP xyz N FILE``: positions; ``image`` and ``movie`` are skipped with a warning."""

from __future__ import annotations

from pathlib import Path
from typing import ClassVar, Final

import numpy as np

from minidem.kernels.columns import POSITION
from minidem.output.columns import atom_vector
from minidem.output.dump import BY_ID, DUMPS, Dump, TextDump, sort_key, sorted_rows
from minidem.output.dump_custom import element_names
from minidem.output.text.formats import column_formats
from minidem.output.text.table import format_rows
from minidem.record import field, record
from minidem.words import Words
from minidem.world.world import World

__all__ = ["DumpPicture", "DumpXyz"]

_FORMATS: Final = ("%s", "%g", "%g", "%g")
_SORTED_BY: Final = ("id", "type", "x", "y", "z")


@DUMPS.register("xyz")
@record
class DumpXyz(TextDump):
    """``dump xyz``: type and position of the particles.

    Attributes
    ----------
    sort : int
        See `minidem.output.dump.sort_key`, of the columns id, type, x, y and z.
    elements : list of str
        What stands for each type; empty for its number.
    types : int
        Number of atom types.
    formats : list of str
        Python formats of the four columns.
    """

    sort: int = BY_ID
    elements: list[str] = field(default_factory=list)
    types: int = 1
    formats: list[str] = field(default_factory=lambda: list(_FORMATS))

    keywords: ClassVar[tuple[str, ...]] = (*TextDump.keywords, "element")

    def read_rest(self, world: World, words: Words) -> None:
        """Take the number of atom types."""
        del words
        self.refuse_names("%", ".bin")
        self.types = world.types

    def modify(self, key: str, words: Words) -> None:
        """Read the value of ``element``, ``format`` or ``sort``, or of a common keyword."""
        if key == "element":
            self.elements = element_names(words, self.types)
        elif key == "sort":
            self.sort = sort_key(self, words, len(_SORTED_BY))
        elif key == "format":
            text = words.take("formats")
            whole, name = [False] * len(_FORMATS), [True, False, False, False]
            given = " ".join(_FORMATS) if text == "none" else text
            self.formats = column_formats(given, whole, name)
        else:
            super().modify(key, words)

    def write(self, world: World, target: Path) -> None:
        """Append a snapshot, or write it to a file of its own."""
        state = world.state
        order = state.output_order()
        who = sorted_rows(
            self.sort,
            order[world.member(self.bit)[order]],
            state.ids,
            lambda column: atom_vector(world, _SORTED_BY[column - 1]),
        )
        at = state.row[who, POSITION]
        kind, (first, *others) = state.kind[who].astype(np.int64), self.formats
        names = np.array(self.elements)[kind] if self.elements else kind + 1
        if not self.elements and first == _FORMATS[0]:
            first = "%d"  # the same text, and a kernel writes it
        columns = [names, *(at[:, c] for c in range(3))]
        rows = "".join(
            line.removesuffix(" \n") + "\n"
            for line in format_rows(columns, [first, *others]).splitlines(keepends=True)
        )
        text = f"{len(who)}\nAtoms. Timestep: {world.step}\n{rows}"
        self.put(target, text)


@DUMPS.register("image", "movie")
class DumpPicture(Dump):
    """``dump image``: pictures, which are not made."""

    keywords: ClassVar[tuple[str, ...]] = (
        *Dump.keywords, "acolor", "adiam", "amap", "backcolor", "bcolor", "bdiam", "boxcolor",
        "bitrate", "color", "framerate", "thresh", "region",
    )  # fmt: skip

    def read_rest(self, world: World, words: Words) -> None:
        """Pass over all words and say what becomes of them."""
        words.rest()
        world.warn(
            f"dump {self.name}: minidem makes no pictures; '{self.style}' is skipped. "
            "ParaView shows the files of 'dump custom/vtk'"
        )

    def modify(self, key: str, words: Words) -> None:
        """Pass over all words."""
        del key
        words.rest()

    def act(self, world: World) -> None:
        """Write nothing."""
        self.last = world.step
