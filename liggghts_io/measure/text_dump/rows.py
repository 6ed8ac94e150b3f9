"""Turn the rows of text dumps into tables of numbers, and say which row is none."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from liggghts_io.errors import DamagedFile
from liggghts_io.measure.text_dump.blocks import Block
from liggghts_io.measure.text_dump.head import Head, missing_rows

if TYPE_CHECKING:
    import pandas as pd

_SHOWN: Final = 60  # characters of a wrong row in a message
_TEXT_COLUMNS: Final = ("element", "typelabel")
"""Columns of words, which no table of numbers takes."""
_ID: Final = "id"
_MOST_ID: Final = 2**53  # from here on floating point numbers do not tell two neighbours apart
_WORDS: Final = {b"r": b"rue", b"R": b"RUE", b"l": b"als", b"L": b"ALS"}
"""Parts of "true" and "false", which the reader of tables takes for numbers, behind a letter of
theirs that is found ten times as fast and that no number has."""
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
    if len(first.split()) != len(names):
        raise DamagedFile(_wrong_row(frames))
    # Numbers may be set in columns further down, or blanks differ from row to row.
    table = _table(rows, names, words, plain=True) if plain else None
    table = _table(rows, names, words, plain=False) if table is None else table
    if table is None or len(table) != count:
        raise DamagedFile(_wrong_row(frames))
    words_in = any(letter in rows and part in rows for letter, part in _WORDS.items())
    doubtful = words_in or (_ID in table and _too_large(table[_ID]))
    if doubtful and (wrong := _first_wrong_row(frames)):
        raise DamagedFile(wrong)
    return table


def _table(rows: bytes, names: list[str], words: list[str], *, plain: bool) -> pd.DataFrame | None:
    """Return rows as finite numbers without the columns of words, None where they are none."""
    import pandas as pd

    every = [*names, _BEHIND] if plain else names
    try:
        table = pd.read_csv(
            io.BytesIO(rows), sep=" " if plain else r"\s+", header=None, names=every,
            dtype={name: np.float64 for name in every if name not in words},
            quoting=csv.QUOTE_NONE, skip_blank_lines=False, encoding_errors="replace",
        )  # fmt: skip
    except (ValueError, OverflowError):  # errors of pandas' parser among them
        return None
    # A blank more or less than in the first row shifts a number behind the last column, or leaves
    # one empty.
    if plain and table.pop(_BEHIND).notna().any():
        return None
    table = table.drop(columns=words) if words else table
    return table if np.isfinite(table.to_numpy()).all() else None


def _too_large(ids: pd.Series) -> bool:
    return bool((ids.abs() >= _MOST_ID).any())


def _wrong_row(frames: Sequence[tuple[Block, Head]]) -> str:
    """Return the message about the first row that is no row of its frame."""
    block, head = frames[0]
    other = f"{block.path}:{block.line}: the rows from step {head.step} on cannot be read"
    return _first_wrong_row(frames) or other


def _first_wrong_row(frames: Sequence[tuple[Block, Head]]) -> str:
    found = (_wrong_row_of(block, head) for block, head in frames)
    return next(filter(None, found), "")


def _wrong_row_of(block: Block, head: Head) -> str:
    line = block.line + head.lines
    for k, raw in enumerate(block.content[head.size :].splitlines()):
        words = raw.decode("ascii", errors="replace").split()
        shown = " ".join(words)[:_SHOWN]
        if len(words) != len(head.names):
            return (
                f"{block.path}:{line + k}: expected the {len(head.names)} columns of the head, "
                f"got {len(words)}: {shown!r}"
            )
        for name, word in zip(head.names, words, strict=True):
            why = "" if name in _TEXT_COLUMNS else _why_no_number(name, word)
            if why:
                return f"{block.path}:{line + k}: column {name}: {word[:_SHOWN]!r} {why}"
    return ""


def _why_no_number(name: str, word: str) -> str:
    """Return what is wrong with a number of a column, '' where nothing is."""
    try:
        value = float("x" if "_" in word else word)
    except ValueError:
        return "is not a number; numbers are written as 0.0015 or 1.5e-3"
    if not math.isfinite(value):
        return "is not a number that can be measured; take this frame out, or dump without it"
    if name == _ID and abs(value) >= _MOST_ID:
        return "is too large to be told from its neighbours; number the grains anew"
    return ""
