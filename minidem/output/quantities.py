"""What formulas and output may ask of a world: thermo keywords, group functions, columns."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from functools import partial

from minidem.errors import InputError, UnknownNameError, UnknownWordError, suggest
from minidem.kernels.columns import FX, MASS, POSITION, VELOCITY, VX, X, Y, Z
from minidem.output.columns import atom_vector, split_indices
from minidem.registry import Registry
from minidem.world.state import Bools, Floats
from minidem.world.world import World

__all__ = ["THERMO", "Quantities", "check_keywords"]

THERMO: Registry[Callable[[World], float]] = Registry("thermo keyword")
"""Thermo keyword to a function of the world; titles and formats: `minidem.output.text.thermo`."""

_AXES = {"x": X, "y": Y, "z": Z}
_PREFIXES = ("c_", "f_", "v_")
_FAR = 1.0e20  # lowest and highest coordinate of no particles


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
            msg = f"Invalid keyword in thermo_style custom command: '{word}'{near}"
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
            value = self.world.begin_step if keyword == "beginstep" else self.world.end_step
            if value is None:
                raise UnknownNameError(keyword)
            return float(value)
        if keyword not in THERMO:
            raise UnknownNameError(keyword)
        return float(THERMO[keyword](self.world))

    def thermo_value(self, word: str) -> float:
        """Return a column of the thermo output: a keyword, ``v_NAME``, ``c_ID`` or ``f_ID[i]``."""
        if word in THERMO:
            return self.thermo(word)
        if word.startswith("v_"):
            return float(self.world.interpreter.value(word[2:]))
        base, indices = split_indices(word)
        ask = self.compute_value if base.startswith("c_") else self.fix_value
        return ask(base[2:], indices)

    def _chosen(self, args: tuple[str, ...]) -> tuple[list[str], Bools]:
        """Split off group and region; return what is left and the particles meant."""
        world = self.world
        rest = list(args)
        group = rest.pop(0) if rest else "all"
        chosen = world.member(world.bit(group))
        if rest and rest[-1] in world.regions:
            region = world.regions[rest.pop()]
            chosen = chosen & region.match(world.state.row[: world.state.n, POSITION])
        return rest, chosen

    def group_value(self, function: str, args: tuple[str, ...]) -> float:
        """Return a function of a group, ``count(g)``, ``xcm(g,x)``, ``bound(g,xmax,reg)`` ...

        Raises
        ------
        UnknownNameError
            For an unknown function or direction.
        """
        rest, chosen = self._chosen(args)
        row = self.world.state.row[: self.world.state.n][chosen]
        if function == "count":
            return float(len(row))
        if function == "mass":
            return float(row[:, MASS].sum())
        if function == "ke":
            return float(0.5 * (row[:, MASS] * (row[:, VELOCITY] ** 2).sum(axis=1)).sum())
        if function == "bound":
            return self._bound(row, rest)
        if not rest or rest[0] not in _AXES:
            msg = f"{function}({','.join(args)}): expected {function}(GROUP,x), y or z"
            raise InputError(msg)
        where = _AXES[rest[0]]
        if function in ("xcm", "vcm"):
            if not len(row):
                return 0.0
            column = where + (X if function == "xcm" else VX)
            return float((row[:, MASS] * row[:, column]).sum() / row[:, MASS].sum())
        if function == "fcm":
            return float(self.world.state.force[: self.world.state.n][chosen][:, FX + where].sum())
        msg = f"{function}()"
        raise UnknownNameError(msg)

    @staticmethod
    def _bound(row: Floats, rest: list[str]) -> float:
        """Return an extreme coordinate."""
        wanted = rest[0] if rest else ""
        if wanted[:1] not in _AXES or wanted[1:] not in ("min", "max"):
            msg = f"bound(): expected bound(GROUP,xmin) .. zmax, found '{wanted[:20]}'"
            raise InputError(msg)
        axis = _AXES[wanted[0]]
        if wanted[1:] == "max":
            return float(row[:, axis].max()) if len(row) else -_FAR
        return float(row[:, axis].min()) if len(row) else _FAR

    def compute_value(self, id: str, indices: tuple[int, ...]) -> float:
        """Return ``c_ID`` or ``c_ID[i]``.

        Raises
        ------
        UnknownNameError
            If there is no such compute.
        """
        if id not in self.world.computes:
            msg = f"c_{id}"
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
            msg = f"f_{id}"
            raise UnknownNameError(msg)
        return float(self.world.fixes[id].value(self.world, indices[0] if indices else 0))

    def atom_vector(self, name: str) -> Floats:
        """Return one value per particle, see `minidem.output.columns.atom_vector`."""
        return atom_vector(self.world, name)


# -- the thermo keywords ---------------------------------------------------------------------------

THERMO.register("step")(lambda world: world.step)
THERMO.register("elapsed", "elaplong")(lambda world: world.step - (world.begin_step or 0))
THERMO.register("dt")(lambda world: world.dt)
THERMO.register("time")(World.time)
THERMO.register("cpu", "cu")(lambda world: time.perf_counter() - world.run_start)
THERMO.register("tpcpu", "spcpu")(lambda world: 0.0)
THERMO.register("atoms")(lambda world: world.state.n)
THERMO.register("ke")(World.kinetic_energy)
THERMO.register("vol")(lambda world: world.need_box().volume)


def _face(c: int, which: int, world: World) -> float:
    """Return lower face (0), upper face (1) or length (2) of the box along c, m."""
    box = world.need_box()
    return float((box.lo[c], box.hi[c], box.hi[c] - box.lo[c])[which])


for _c, _axis in enumerate("xyz"):
    THERMO.register(f"{_axis}lo")(partial(_face, _c, 0))
    THERMO.register(f"{_axis}hi")(partial(_face, _c, 1))
    THERMO.register(f"l{_axis}")(partial(_face, _c, 2))
