"""``fix ID all property/global NAME peratomtype VALUES``: material values."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from minidem.errors import InputError
from minidem.record import record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.fix import FIXES, Fix
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["PropertyGlobal", "check_counts"]

_LISTS = ("scalar", "vector", "peratomtype")
_TABLES = ("matrix", "peratomtypepair")
_SHORT = {"atomtype": "peratomtype", "atomtypepair": "peratomtypepair"}
"""Other names of the same."""


@FIXES.register("property/global", "custom_property/global")
@record
class PropertyGlobal(Fix):
    """A material property; its values are in the world's `Materials`.

    Attributes
    ----------
    property : str
        Its name.
    wanted : int
        Power of the number of atom types that its values must be: 1, 2 for pairs, 0 for any.
    """

    before_box: ClassVar[bool] = True
    property: str = ""
    wanted: int = 0

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> PropertyGlobal:
        """Read the values of a property and hand them to the materials."""
        words.need(3, "fix ID all property/global NAME peratomtype VALUES")
        name = words.take("a name")
        kind = words.choice((*_LISTS, *_TABLES, *_SHORT), "style")
        kind = _SHORT.get(kind, kind)
        other = next((fix for fix in world.of_kind(PropertyGlobal) if fix.property == name), None)
        if other is not None and other.name != head.name:
            msg = f"'{name[:40]}' is given by fix {other.name} already; unfix {other.name} first"
            raise InputError(msg)
        columns = words.integer() if kind in _TABLES else 0
        values = []
        while not words.done():
            values.append(words.number())
        found = np.array(values)
        if kind in _TABLES:
            found = _table(name, kind, found, columns)
        world.materials.values[name], world.materials.styles[name] = found, kind
        return cls(*head, name, {"peratomtype": 1, "peratomtypepair": 2}.get(kind, 0))

    def check(self, world: World) -> None:
        """Refuse a number of values that is not that of the atom types, as LIGGGHTS does."""
        count, wanted = world.materials.values[self.property].size, world.types**self.wanted
        if self.wanted and count != wanted:
            msg = (
                f"Fix property/global: Length not correct for variable {self.property}, length "
                f"should be equal to {wanted} for {world.types} atom types, found {count}"
            )
            raise InputError(msg)


def _table(name: str, kind: str, values: Floats, columns: int) -> Floats:
    """Return values as rows and columns; those of pairs of types must be symmetric."""
    if columns < 1 or len(values) % columns:
        msg = f"property/global {name}: the number of default values must be a multiple of nCols."
        raise InputError(msg)
    table = values.reshape(-1, columns)
    if kind == "peratomtypepair":
        if len(table) != columns:
            msg = (
                f"property/global {name}: {len(values)} values for {columns} columns, but N atom "
                "types need NxN"
            )
            raise InputError(msg)
        if not (table == table.T).all():
            msg = f"property/global {name}: per-atomtype property matrix must be symmetric"
            raise InputError(msg)
    return table


def check_counts(world: World) -> None:
    """Refuse properties whose number of values is not that of the atom types.

    Raises
    ------
    InputError
        In the words of LIGGGHTS.
    """
    for fix in world.of_kind(PropertyGlobal):
        fix.check(world)
