"""``fix ID all property/global NAME peratomtype VALUES``: material values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from minidem.errors import InputError
from minidem.registry import Head
from minidem.words import Words
from minidem.world.fix import FIXES, Fix
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["PropertyGlobal"]

_LISTS = ("scalar", "vector", "peratomtype")
_TABLES = ("matrix", "peratomtypepair")


@FIXES.register("property/global")
@dataclass
class PropertyGlobal(Fix):
    """A material property; its values are in the world's `Materials`."""

    before_box: ClassVar[bool] = True

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> PropertyGlobal:
        """Read the values of a property and hand them to the materials."""
        words.need(3, "fix ID all property/global NAME peratomtype VALUES")
        name = words.take("a name")
        kind = words.choice((*_LISTS, *_TABLES), "style")
        columns = words.integer() if kind in _TABLES else 0
        values = []
        while not words.done():
            values.append(words.number())
        found = np.array(values)
        if kind in _TABLES:
            found = _table(name, kind, found, columns, max(world.types, 1))
        world.materials.values[name] = found
        return cls(*head)


def _table(name: str, kind: str, values: Floats, columns: int, types: int) -> Floats:
    """Return values as rows and columns; those of pairs of types must be symmetric."""
    if columns < 1 or len(values) % columns:
        msg = f"property/global {name}: the number of default values must be a multiple of nCols."
        raise InputError(msg)
    table = values.reshape(-1, columns)
    if kind == "peratomtypepair":
        if columns != types or len(table) != types:
            msg = (
                f"property/global {name}: {len(values)} values for {columns} columns, but "
                f"{types} atom types need {types}x{types}"
            )
            raise InputError(msg)
        if not (table == table.T).all():
            msg = f"property/global {name}: per-atomtype property matrix must be symmetric"
            raise InputError(msg)
    return table
