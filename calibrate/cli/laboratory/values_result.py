"""Repeated numbers from a command line or a table: mean, error, unit and where they come from."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from calibrate.errors import CalibrationError
from calibrate.laboratory.replicates import (
    Column,
    numbers_in_table,
    numbers_in_words,
    replicates,
)

__all__ = ["values_of"]

_SUFFIXES: Final = (".csv", ".txt", ".tsv", ".dat")


def values_of(
    words: Sequence[str],
    column: str,
    where: Sequence[str],
    unit: str,
    se: float | None,
    repeats: int,
    surface: str = "",
    material: str = "",
) -> dict[str, Any]:
    """Return mean, standard error, unit, repeats and origin, as JSON shows them.

    Parameters
    ----------
    words : sequence of str
        Numbers, or one table.
    column : str
        Its column.
    where : sequence of str
        ``column=word``: which rows count.
    unit : str
    se : float, optional
        Standard error of one number.
    repeats : int
        Measurements behind it.
    surface, material : str, optional
        Whose rows of the table count, where it tells them apart.

    Raises
    ------
    CalibrationError
    """
    if column or where or (len(words) == 1 and words[0].lower().endswith(_SUFFIXES)):
        found_there, origin = _table(words, column, where, surface, material)
        numbers, said, doubt = list(found_there.numbers), found_there.unit, found_there.doubt
        if unit and said and unit != said:
            msg = f"--unit {unit}: column '{column}' is in {said}; leave the option out, or correct"
            raise CalibrationError(msg)
        unit = unit or said
    else:
        numbers, origin, doubt = numbers_in_words(words), "the command line", ""
    if se is not None:
        mean, error = _given(numbers, se), se
    else:
        if repeats:
            msg = f"--repeats {repeats}: belongs to --se; the numbers given are the repeats"
            raise CalibrationError(msg)
        found = replicates(numbers, origin)
        mean, error, repeats = found.mean, found.se, len(numbers)
    return {"mean": mean, "se": error, "unit": unit, "repeats": repeats, "values": numbers,
            "from": origin, "doubts": [doubt] if doubt else []}  # fmt: skip


def _given(numbers: Sequence[float], se: float) -> float:
    """Return the only number, to which an error is given."""
    if len(numbers) != 1:
        msg = f"--se {se:g}: belongs to one number, and there are {len(numbers)}; leave it out"
        raise CalibrationError(msg)
    if not (math.isfinite(se) and se > 0.0):
        msg = f"--se {se:g}: is not a positive number; give the standard error of the mean"
        raise CalibrationError(msg)
    return numbers[0]


def _table(
    words: Sequence[str], column: str, where: Sequence[str], surface: str, material: str
) -> tuple[Column, str]:
    """Return the numbers in a table, and where they stand."""
    if len(words) != 1:
        msg = f"{len(words)} words: with --column or --where, name one table"
        raise CalibrationError(msg)
    if not column:
        msg = f"--column: is missing; name the column of {words[0]} that holds the numbers"
        raise CalibrationError(msg)
    asked = {}
    for pair in where:
        key, equals, word = pair.partition("=")
        if not equals or not key:
            msg = f"--where {pair}: write --where column=word, such as --where surface=steel"
            raise CalibrationError(msg)
        asked[key.strip()] = word.strip()
    path = Path(words[0])
    numbers = numbers_in_table(path, column, asked, surface, material)
    rows = "".join(f", {key} {word}" for key, word in asked.items())
    return numbers, f"{path.name}, column {column}{rows}"
