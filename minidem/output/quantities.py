"""What formulas and output may ask of a world: thermo keywords, group functions, columns."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from minidem.errors import UnknownNameError, UnknownWordError, suggest
from minidem.output.columns import atom_vector, split_indices
from minidem.output.group_functions import group_value
from minidem.output.thermo_words import OF_RUN, SUMS, THERMO
from minidem.script.formula import NoValueError
from minidem.world.compute import Compute
from minidem.world.fix import Fix
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["Quantities", "check_keywords"]

_PREFIXES = ("c_", "f_", "v_")
_ELEMENTS = 100_000  # of a vector
_REMOVED = {
    "temp": "; use c_thermo_temp",
    "press": "; use c_ID of 'compute ID all pressure thermo_temp'",
    "pe": "; use c_ID of 'compute ID all pe', 0 for granular contacts",
    "etotal": "; contacts have no potential energy, use ke and erotate",
    "epair": "; contacts have no potential energy, use ke and erotate",
    **{
        f"p{axes}": f"; use c_ID[{k}] of 'compute ID all pressure thermo_temp'"
        for k, axes in enumerate(("xx", "yy", "zz", "xy", "xz", "yz"), 1)
    },
}
"""Keywords of LAMMPS that LIGGGHTS 3.8.0 has no more, and what has the number."""


def check_keywords(words: Sequence[str]) -> tuple[str, ...]:
    """Return the columns of ``thermo_style custom`` if all are known.

    Raises
    ------
    InputError
        With the nearest known keyword.
    """
    for word in words:
        if word not in THERMO and word[:2] not in _PREFIXES:
            near = suggest(word, THERMO)
            told = _REMOVED.get(word, near)
            msg = f"Invalid keyword in thermo_style custom command: '{word}'{told}"
            raise UnknownWordError(msg)
    return tuple(words)


class Quantities:
    """Answers questions about a world; the context of the script's formulas.

    Parameters
    ----------
    world : World
        What is asked about.
    """

    def __init__(self, world: World) -> None:
        self.world = world

    def thermo(self, keyword: str) -> float:
        """Return a thermo keyword.

        Raises
        ------
        UnknownNameError
            If it is unknown, or asked outside a run for a step of the run.
        """
        if keyword in ("beginstep", "endstep"):
            first, last = self.world.begin_step, self.world.end_step
            if first is None or last is None:
                raise UnknownNameError(keyword)
            first, last = self.world.series or (first, last)
            return float(first if keyword == "beginstep" else last)
        if keyword not in THERMO:
            raise UnknownNameError(keyword)
        if keyword in OF_RUN and self.world.begin_step is None:
            msg = f"'{keyword}' has a value only during a run; LIGGGHTS stops here as well"
            raise NoValueError(msg)
        found = float(THERMO[keyword](self.world))
        return found / self._share() if keyword in SUMS else found

    def _share(self) -> int:
        """Return by what sums over particles are divided (``thermo_modify norm``)."""
        world = self.world
        norm = world.thermo.norm
        if norm is None:
            norm = world.materials.units == "lj"
        return world.state.n if norm and world.state.n else 1

    def value(self, word: str) -> float:
        """Return ``v_NAME``, ``c_ID``, ``f_ID[i]`` or a thermo keyword."""
        if word in THERMO:
            return self.thermo(word)
        if word.startswith("v_"):
            return float(self.world.interpreter.value(word[2:]))
        base, indices = split_indices(word)
        ask = self.compute_value if base.startswith("c_") else self.fix_value
        return ask(base[2:], indices)

    def thermo_value(self, word: str) -> float:
        """Return a column of the thermo output, where sums may be per particle."""
        found = self.value(word)
        if word in THERMO or word.startswith("v_"):
            return found
        return found / self._share() if self.adds_up(word) else found

    def adds_up(self, word: str, element: tuple[int, ...] = ()) -> bool:
        """Tell whether ``c_ID`` or ``f_ID``, or an element of it, is a sum over particles."""
        base, indices = split_indices(word)
        table = {"c_": self.world.computes, "f_": self.world.fixes}.get(base[:2], {})
        asked: Compute | Fix | None = table.get(base[2:])
        return asked is not None and asked.adds_up(self.world, (*element, *indices))

    def group_value(self, function: str, args: tuple[str, ...]) -> float:
        """Return a function of a group, see `minidem.output.group_functions`."""
        return group_value(self.world, function, args)

    def compute_value(self, id: str, indices: tuple[int, ...]) -> float:
        """Return ``c_ID`` or ``c_ID[i]``.

        Raises
        ------
        UnknownNameError
            If there is no such compute.
        """
        if id not in self.world.computes:
            msg = (
                f"'c_{id[:40]}': there is no compute '{id[:40]}'{suggest(id, self.world.computes)}"
            )
            raise UnknownNameError(msg)
        return float(self.world.computes[id].value(self.world, indices))

    def fix_value(self, id: str, indices: tuple[int, ...]) -> float:
        """Return ``f_ID`` or ``f_ID[i]``.

        Raises
        ------
        UnknownNameError
            If there is no such fix or it has no such value.
        """
        if id not in self.world.fixes:
            msg = f"'f_{id[:40]}': there is no fix '{id[:40]}'{suggest(id, self.world.fixes)}"
            raise UnknownNameError(msg)
        fix: Fix = self.world.fixes[id]
        if len(indices) > 1:
            return float(fix.element(self.world, indices))
        return float(fix.value(self.world, indices[0] if indices else 0))

    def elements(self, word: str) -> Floats:
        """Return all elements of ``c_ID`` or ``f_ID``, or of a column ``c_ID[j]``.

        Raises
        ------
        UnknownNameError
            If there are none.
        """
        base, column = split_indices(word)
        asked: Compute | None = self.world.computes.get(base[2:]) if base[:2] == "c_" else None
        whole = asked.column(self.world, column[0] if column else 0) if asked else None
        if whole is not None:
            return whole
        get = self.compute_value if base.startswith("c_") else self.fix_value
        found: list[float] = []
        while len(found) < _ELEMENTS:
            try:
                found.append(get(base[2:], (len(found) + 1, *column)))
            except UnknownNameError:
                if not found:
                    raise
                break
        return np.array(found)

    def need_map(self) -> None:
        """Raise NoValueError if the script has no atom map, by which ids are looked up."""
        if not self.world.atom_map:
            msg = (
                "to find particles by their ids LIGGGHTS needs an atom map; give "
                "'atom_modify map array' before create_box"
            )
            raise NoValueError(msg)

    def atom_vector(self, name: str) -> Floats:
        """Return one value per particle, see `minidem.output.columns.atom_vector`."""
        return atom_vector(self.world, name)
