"""Which rows of a table are those of a material and a wall, and that nobody has to guess it."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Final

from calibrate.errors import CalibrationError
from calibrate.study.measured.tables import (
    MATERIAL,
    PARTICLE,
    SURFACE,
    TARGET,
    UNIT,
    Row,
    Table,
)
from calibrate.study.schema.materials import Material
from calibrate.study.schema.targets import Target
from liggghts_io.decimals import number_in

__all__ = [
    "HEADS",
    "Around",
    "alike",
    "check_units",
    "column_in_other_words",
    "refuse_shared_rows",
    "rows_here",
]

HEADS: Final = {SURFACE: (SURFACE,), MATERIAL: (PARTICLE, MATERIAL)}
"""What rows are told apart by, and the columns that say it."""

_OTHER_WORDS: Final = {
    SURFACE: ("wall", "walls", "plate", "substrate", "wand", "oberfläche", "platte", "unterlage",
              "wandmaterial", "wall material", "paroi", "plaque", "superficie"),
    MATERIAL: ("materials", "bulk", "bulk solid", "powder", "grains", "granulate", "schüttgut",
               "pulver", "granulat", "stoff", "matériau", "materiale"),
}  # fmt: skip
"""Heads that say the same in other words; no wall is averaged with another one under them."""
_MOST_SHOWN: Final = 5


@dataclass(frozen=True)
class Around:
    """What else a study has, so that a column of its walls is known under any head.

    Attributes
    ----------
    targets : tuple of Target
    materials : tuple of Material
    """

    targets: tuple[Target, ...] = ()
    materials: tuple[Material, ...] = ()

    def words(self, what: str) -> set[str]:
        """Return what tables may call the walls or the materials of the study."""
        if what == SURFACE:
            return {one.surface for one in self.targets}
        return {word for one in self.materials for word in (one.called, one.name)}


def alike(cell: str, word: str) -> bool:
    """Whether a cell stands for a word: capitals do not count.

    Examples
    --------
    >>> alike("Steel", "steel"), alike("stainless", "steel")
    (True, False)
    """
    return cell.casefold() == word.casefold()


def rows_here(
    target: Target, material: Material, table: Table, around: Around | None = None
) -> tuple[Row, ...]:
    """Return the rows of a target: of its name, material and surface, as far as a table has them.

    Where a table names targets, an empty cell for material or surface fits all of them.

    Parameters
    ----------
    target : Target
    material : Material
        The target's.
    table : Table
    around : Around, optional
        The rest of the study.

    Raises
    ------
    CalibrationError
        When a table tells walls or materials apart in a way that is not understood: under another
        head, or with an empty cell.
    """
    around = around or Around((target,), (material,))
    named = TARGET in table.columns
    rows = [row for row in table.rows if not named or row.cells[TARGET] == target.name]
    here = {SURFACE: (target.surface,), MATERIAL: (material.called, material.name)}
    asked = [
        (column, words, around.words(what) - {*words})
        for what, words in here.items()
        for column in HEADS[what]
        if column in table.columns
    ]
    rows = [row for row in rows if all(_fits(row.cells[one], *rest) for one, *rest in asked)]
    for row in rows if not named else ():
        for column, words, _ in asked:
            if not row.cells[column]:
                msg = f"is empty: nobody knows whether the row is of '{words[0]}'; fill it"
                raise row.wrong(column, msg)
    for what, words in here.items():
        if not named and not {*HEADS[what]} & {*table.columns}:
            _check_other_heads(table, rows, what, words, around.words(what))
    return tuple(rows)


def _fits(cell: str, words: Collection[str], others: Collection[str]) -> bool:
    """Whether a cell may stand for one of some words; capitals count where others need them."""
    if not cell or cell in words:
        return True
    return cell not in others and any(alike(cell, word) for word in words)


def _check_other_heads(
    table: Table, rows: Sequence[Row], what: str, words: Sequence[str], known: Collection[str]
) -> None:
    """Refuse a table that names walls or materials under another head than the one read here."""
    column = column_in_other_words(table, rows, what, known)
    if column is None:
        return
    cells = dict.fromkeys(row.cells[column] for row in rows)
    ours = all(any(alike(cell, word) for word in words) for cell in cells)
    known_ones = any(alike(cell, word) for cell in cells for word in known)
    if ours or (len(cells) == 1 and not known_ones):  # one wall, whatever it is called there
        return
    msg = (
        f"{table.path}: column '{column}' holds {_list(cells)}, and there is no column '{what}', "
        f"so that rows of '{words[0]}' cannot be told from others; call the column '{what}', and "
        "what stands in it as the study does"
    )
    raise CalibrationError(msg)


def column_in_other_words(
    table: Table, rows: Sequence[Row], what: str, known: Collection[str]
) -> str | None:
    """Return the column that says walls or materials of rows under a head of its own, or None.

    Parameters
    ----------
    table : Table
        Without one of the columns `HEADS`.
    rows : sequence of Row
    what : {"surface", "material"}
    known : collection of str
        Names that give such a column away.
    """
    for column in table.columns:
        cells = {row.cells[column] for row in rows} - {""}
        cells = {cell for cell in cells if isinstance(number_in(cell, ""), str)}
        if cells and column.casefold() in _OTHER_WORDS[what]:
            return column
        if any(alike(cell, word) for cell in cells for word in known):
            return column
    return None


def refuse_shared_rows(target: Target, table: Table, around: Around) -> None:
    """Refuse a column that several walls or materials take, while nothing tells rows apart.

    Raises
    ------
    CalibrationError
        With the targets and what is missing.
    """
    if TARGET in table.columns:
        return
    column = table.column(target.column or "")
    same = [one for one in around.targets
            if one.file == target.file and _named(table, one.column) == column]  # fmt: skip
    for what, heads in HEADS.items():
        here = dict.fromkeys(str(getattr(one, what)) for one in same)
        if len(here) > 1 and not {*heads} & {*table.columns}:
            msg = (
                f"{table.path}: has no column '{what}', and targets of {_list(here)} take its "
                f"column '{column}': nobody knows which rows are those of "
                f"'{getattr(target, what)}'; add the column, or give each its own file or column"
            )
            raise CalibrationError(msg)


def _named(table: Table, name: str | None) -> str | None:
    """Return the column of a name, None where there is none, which is told elsewhere."""
    with suppress(CalibrationError):
        return table.column(name or "")
    return None


def check_units(table: Table, rows: Sequence[Row], unit: str) -> None:
    """Refuse a row whose cell for the unit says another one than the study.

    Raises
    ------
    CalibrationError
        With place and value.
    """
    if UNIT in table.columns:
        for row in rows:
            if row.cells[UNIT] not in ("", unit):
                raise row.wrong(UNIT, f"but the study says unit = '{unit}'; correct one")


def _list(words: Iterable[str]) -> str:
    shown = [f"'{word}'" for word in words]
    more = ["..."] if len(shown) > _MOST_SHOWN else []
    return ", ".join([*shown[:_MOST_SHOWN], *more])
