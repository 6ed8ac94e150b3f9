"""Turn the rows of text dumps into tables of numbers, and say which row is none."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from liggghts_io.errors import DamagedFile
from liggghts_io.measure.dump_text import HEAD_LINES, Block, Head, missing_rows

if TYPE_CHECKING:
    import pandas as pd

_SHOWN: Final = 60  # characters of a wrong row in a message
_TEXT_COLUMNS: Final = ("element",)
"""Columns of words, which no table of numbers takes."""
_BEHIND: Final = " "  # name of the nothing behind the last blank of a row


def rows_of(frames: Sequence[tuple[Block, Head]]) -> pd.DataFrame:
    """Return the rows of one or more frames as a table, one column of numbers for each name.

    Parameters
    ----------
    frames : sequence of (Block, Head)
        Whole frames with the same columns in the same order. Many small ones at once are read
        several times as fast as one by one.

    Raises
    ------
    DamagedFile
        With the line of the first row that does not have the numbers of the head.
    """
    import pandas as pd  # half a second, for who reads dumps

    names = list(frames[0][1].names)
    words = [name for name in names if name in _TEXT_COLUMNS]
    count = sum(head.count for _, head in frames)
    for block, head in frames:
        if missing_rows(block, head):
            raise DamagedFile(missing_rows(block, head))
    if not count:
        return pd.DataFrame(np.empty((0, len(names))), columns=names).drop(columns=words)
    rows = b"".join(block.content[head.size :] for block, head in frames)
    first = rows[: rows.index(b"\n")].rstrip(b"\r")
    # One blank behind each number, as the engines write, is read twice as fast as any space.
    plain = first.split(b" ") == [*first.split(), b""]
    every = [*names, _BEHIND] if plain else names
    if len(first.split()) != len(names):
        raise DamagedFile(_wrong_row(frames))
    try:
        table = pd.read_csv(
            io.BytesIO(rows), sep=" " if plain else r"\s+", header=None, names=every,
            dtype={name: np.float64 for name in every if name not in words},
            quoting=csv.QUOTE_NONE, skip_blank_lines=False, encoding_errors="replace",
        )  # fmt: skip
    except (ValueError, OverflowError, pd.errors.ParserError) as err:
        raise DamagedFile(_wrong_row(frames)) from err
    behind = table.pop(_BEHIND) if plain else pd.Series(dtype=np.float64)
    table = table.drop(columns=words) if words else table
    if len(table) != count or behind.notna().any() or not np.isfinite(table.to_numpy()).all():
        raise DamagedFile(_wrong_row(frames))
    return table


def _wrong_row(frames: Sequence[tuple[Block, Head]]) -> str:
    """Return the message about the first row that is no row of its frame."""
    found = (_wrong_row_of(block, head) for block, head in frames)
    block, head = frames[0]
    other = f"{block.path}:{block.line}: the rows from step {head.step} on cannot be read"
    return next(filter(None, found), other)


def _wrong_row_of(block: Block, head: Head) -> str:
    line = block.line + HEAD_LINES
    for k, raw in enumerate(block.content[head.size :].splitlines()):
        words = raw.decode("ascii", errors="replace").split()
        shown = " ".join(words)[:_SHOWN]
        if len(words) != len(head.names):
            return (
                f"{block.path}:{line + k}: expected the {len(head.names)} columns of the head, "
                f"got {len(words)}: {shown!r}"
            )
        for name, word in zip(head.names, words, strict=True):
            if name not in _TEXT_COLUMNS and not _is_number(word):
                return f"{block.path}:{line + k}: column {name}: {word[:_SHOWN]!r} is not a number"
    return ""


def _is_number(word: str) -> bool:
    try:
        return math.isfinite(float(word)) and "_" not in word
    except ValueError:
        return False
