"""Base of all dumps, and the table of their styles."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, ClassVar, Final, Self

import numpy as np
from numpy.typing import NDArray

from minidem.errors import InputError
from minidem.files import append_bytes, whole_file
from minidem.output.text.custom import frame_name
from minidem.record import record
from minidem.registry import Head, Registry
from minidem.script.paths import inside
from minidem.words import Words, integer
from minidem.world.settings import Schedule
from minidem.world.state import Ints
from minidem.world.world import World

__all__ = [
    "BY_ID",
    "DUMPS",
    "UNSORTED",
    "Dump",
    "TextDump",
    "sort_key",
    "sorted_rows",
    "write_snapshot",
    "write_whole",
]

_KEYWORDS: Final = (
    "first", "every", "pad", "flush", "nfile", "fileper", "buffer", "append", "format", "sort",
)  # fmt: skip
BY_ID: Final = -1_000_000
"""Sort key: the particle id."""
UNSORTED: Final = 0
"""Sort key: none, particles come in the internal order."""
_PROCESS = "%"  # of a file name, for which LIGGGHTS puts the number of a process
_SHOWN = 40  # characters of a file name in a message
_MOST_DIGITS = 20  # of a step in a file name


@record
class Dump:
    """A dump: snapshot every so many steps.

    Attributes
    ----------
    name : str
        Its id in the script.
    style : str
        Style as written.
    bit : int
        Group bit.
    schedule : Schedule
        When it is written.
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
    style: str
    bit: int
    schedule: Schedule
    path: str
    first: bool = False
    last: int = -1
    pad: int = 0

    keywords: ClassVar[tuple[str, ...]] = _KEYWORDS
    """Keywords of ``dump_modify``; those that a style has no use for change nothing."""

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Self:
        """Make a dump from the words after its style.

        Raises
        ------
        InputError
            For an unfit word.
        """
        words.need(2, "dump ID GROUP STYLE N FILE ...")
        made = cls(*head, Schedule(words.interval()), words.take("a file"))
        made.read_rest(world, words)
        return made

    def read_rest(self, world: World, words: Words) -> None:
        """Read what follows interval and file."""

    def refuse_names(self, *parts: str) -> None:
        """Refuse a file name that LIGGGHTS refuses for this style: with ``%``, or with an ending.

        Raises
        ------
        InputError
            With the part.
        """
        for part in parts:
            if self.path.endswith(part) or (part == _PROCESS and part in self.path):
                msg = (
                    f"dump {self.name}: '{part}' may not stand in the file name "
                    f"'{self.path[:_SHOWN]}' of a dump {self.style}, as in LIGGGHTS; leave it out"
                )
                raise InputError(msg)

    def variables_asked(self) -> tuple[str, ...]:
        """Return the names of the variables that it asks in a run."""
        return self.schedule.asked()

    def due_at_start(self, step: int) -> bool:
        """Return True if a snapshot is due before the first step of a run."""
        return (self.schedule.is_multiple(step) or self.first) and self.last != step

    def begin(self, world: World) -> None:
        """Prepare for a run."""

    def act(self, world: World) -> None:
        """Write a snapshot."""
        self.last = world.step
        # ``first`` asks for the very first snapshot only.
        self.first = False
        self.write(world, inside(world.root, self.file_name(self.path, world.step)))

    def file_name(self, pattern: str, step: int) -> str:
        """Return the name of a file of this dump; the first ``*`` becomes the step."""
        return frame_name(pattern, step, self.pad)

    def write(self, world: World, target: Path) -> None:
        """Write a snapshot to a file."""
        raise NotImplementedError

    def modify(self, key: str, words: Words) -> None:
        """Read the value of one of the `keywords`.

        Raises
        ------
        InputError
            If it is not understood.
        """
        if key == "first":
            self.first = words.yes_no()
        elif key == "every":
            self.schedule = Schedule.read(words)
        elif key == "pad":
            self.pad = min(max(words.integer(), 0), _MOST_DIGITS)
        elif key in ("nfile", "fileper"):
            if _PROCESS not in self.path:
                name = self.path[:_SHOWN]
                msg = f"Cannot use dump_modify {key} without % in dump file name '{name}'"
                raise InputError(msg)
            words.interval()
        elif key in ("flush", "buffer"):
            words.yes_no()
        else:
            words.take("a value")


@record
class TextDump(Dump):
    """A dump of text, whose snapshots stand behind each other in one file, or each in its own.

    Attributes
    ----------
    append : bool
        Go on with an existing file.
    """

    append: bool = False

    def modify(self, key: str, words: Words) -> None:
        """Read the value of ``append`` or of a common keyword."""
        if key == "append":
            self.append = words.yes_no()
        else:
            super().modify(key, words)

    def begin(self, world: World) -> None:
        """Make or empty the one file, as LIGGGHTS does, whether or not a snapshot comes."""
        if "*" not in self.path:
            self.put(inside(world.root, self.file_name(self.path, world.step)), "")

    def put(self, target: Path, content: str | bytes) -> None:
        """Write a snapshot to a file of its own, or behind those of this dump."""
        if "*" in self.path:
            write_snapshot(target, content)
            return
        append_bytes(target, _packed(target, content), anew=not self.append)
        self.append = True


def sort_key(dump: Dump, words: Words, columns: int) -> int:
    """Read what ``dump_modify sort`` sorts by: ``off``, ``id``, or a column, -N for descending.

    Returns
    -------
    int
        `UNSORTED`, `BY_ID`, or the column from 1, negative for descending.

    Raises
    ------
    InputError
        If there is no such column.
    """
    word = words.take("a column")
    if word in ("off", "id"):
        return BY_ID if word == "id" else UNSORTED
    column = integer(word, f"dump_modify {dump.name} sort")
    if not 1 <= abs(column) <= columns:
        msg = f"dump_modify {dump.name} sort: there are {columns} columns, not {word}"
        raise InputError(msg)
    return column


def sorted_rows(key: int, rows: Ints, ids: Ints, column: Callable[[int], NDArray[Any]]) -> Ints:
    """Return rows in the order that a sort key asks for.

    Parameters
    ----------
    key : int
        See `sort_key`.
    rows : (n,) int64
        Rows of particles in the internal order.
    ids : (cap,) int64
        Ids of all particles by row.
    column : callable
        Takes the number of a column, from 1, and gives its values by row.
    """
    if key == UNSORTED:
        return rows
    values = (ids if key == BY_ID else np.asarray(column(abs(key))))[rows]
    backwards = key < 0 and key != BY_ID
    found: Ints = rows[np.argsort(-values if backwards else values, kind="stable")]
    return found


DUMPS: Registry[type[Dump]] = Registry("dump style")
"""Dump style to its class."""


def write_snapshot(target: Path, content: str | bytes) -> None:
    """Write a file of a dump as `write_whole` does; by gzip where its name ends in ``.gz``."""
    with whole_file(target) as file:
        file.write(_packed(target, content))


def write_whole(target: Path, text: str) -> None:
    """Write a file that is either complete or not there; OutputError if that fails."""
    with whole_file(target) as file:
        file.write(_encoded(text))


def _packed(target: Path, content: str | bytes) -> bytes:
    """Return what stands in a file; parts that are compressed may follow each other."""
    plain = _encoded(content) if isinstance(content, str) else content
    if target.suffix != ".gz":
        return plain
    import gzip  # few dumps are compressed

    # without a time, so that a run that is repeated writes the same
    return gzip.compress(plain, mtime=0)


def _encoded(text: str) -> bytes:
    return text.encode("utf-8", errors="surrogateescape")
