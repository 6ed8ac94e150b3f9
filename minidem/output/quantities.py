"""What formulas and output may ask of a world: thermo keywords, group functions, columns."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial

import numpy as np

from minidem.fixes.body import Post
from minidem.fixes.variable_forces import potential
from minidem.fixes.wall import MassFlow
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["COLUMNS", "THERMO_INTEGERS", "Quantities"]

THERMO_INTEGERS = ("step", "elapsed", "elaplong", "atoms")
"""Thermo keywords that are whole numbers."""

COLUMNS: dict[str, tuple[str, int]] = {
    "x": ("row", 0), "y": ("row", 1), "z": ("row", 2), "radius": ("row", 3), "r": ("row", 3),
    "vx": ("row", 4), "vy": ("row", 5), "vz": ("row", 6), "mass": ("row", 7),
    "fx": ("force", 0), "fy": ("force", 1), "fz": ("force", 2),
    "tqx": ("force", 3), "tqy": ("force", 4), "tqz": ("force", 5),
    "omegax": ("spin", 0), "omegay": ("spin", 1), "omegaz": ("spin", 2),
    "ix": ("image", 0), "iy": ("image", 1), "iz": ("image", 2),
}  # fmt: skip
"""Per-particle quantity to array and column of `State`."""


class Quantities:
    """Answers questions about a world; the context of the script's formulas.

    Parameters
    ----------
    world : World
        What is asked about.
    """

    def __init__(self, world: World) -> None:
        self.world = world
        self._born = time.perf_counter()
        self.run_start = time.perf_counter()
        self._thermo: dict[str, Callable[[], float]] = self._keywords()

    def _keywords(self) -> dict[str, Callable[[], float]]:
        """Return the thermo keywords and how to get them."""
        w = self.world
        table: dict[str, Callable[[], float]] = {
            "step": lambda: w.step,
            "elapsed": lambda: w.step - (w.begin_step or 0),
            "elaplong": lambda: w.step - (w.begin_step or 0),
            "dt": lambda: w.dt,
            "time": w.time,
            "cpu": lambda: time.perf_counter() - self.run_start,
            "cu": lambda: time.perf_counter() - self.run_start,
            "tpcpu": lambda: 0.0,
            "spcpu": lambda: 0.0,
            "atoms": lambda: w.state.n,
            "ke": w.kinetic_energy,
            "vol": lambda: w.need_box().volume,
        }
        for c, axis in enumerate("xyz"):
            table[f"{axis}lo"] = partial(self._face, c, 0)
            table[f"{axis}hi"] = partial(self._face, c, 1)
            table[f"l{axis}"] = partial(self._face, c, 2)
        return table

    def _face(self, c: int, which: int) -> float:
        """Return lower face (0), upper face (1) or length (2) of the box along c."""
        box = self.world.need_box()
        return float((box.lo[c], box.hi[c], box.hi[c] - box.lo[c])[which])

    def knows(self, keyword: str) -> bool:
        """Return True for a thermo keyword."""
        return keyword in self._thermo

    def keywords(self) -> list[str]:
        """Return all thermo keywords."""
        return list(self._thermo)

    def thermo(self, keyword: str) -> float:
        """Return a thermo keyword.

        Raises
        ------
        KeyError
            If it is unknown, or asked outside a run for a step of the run.
        """
        if keyword in ("beginstep", "endstep"):
            value = self.world.begin_step if keyword == "beginstep" else self.world.end_step
            if value is None:
                raise KeyError(keyword)
            return float(value)
        return float(self._thermo[keyword]())

    # -- groups ----------------------------------------------------------------------------------

    def _chosen(self, args: tuple[str, ...]) -> tuple[list[str], Floats]:
        """Split off group and region; return what is left and the particles meant."""
        world = self.world
        rest = list(args)
        group = rest.pop(0) if rest else "all"
        chosen = world.member(world.bit(group))
        if rest and rest[-1] in world.regions:
            region = world.regions[rest.pop()]
            chosen = chosen & region.match(world.state.row[: world.state.n, :3])
        return rest, chosen

    def group_value(self, function: str, args: tuple[str, ...]) -> float:
        """Return a function of a group, ``count(g)``, ``xcm(g,x)``, ``bound(g,xmax,reg)`` ...

        Raises
        ------
        KeyError
            For an unknown function or direction.
        """
        rest, chosen = self._chosen(args)
        row = self.world.state.row[: self.world.state.n][chosen]
        if function == "count":
            return float(len(row))
        if function == "mass":
            return float(row[:, 7].sum())
        if function == "ke":
            return float(0.5 * (row[:, 7] * (row[:, 4:7] ** 2).sum(axis=1)).sum())
        if function == "bound":
            return self._bound(row, rest)
        where = {"x": 0, "y": 1, "z": 2}[rest[0]]
        if function in ("xcm", "vcm"):
            if not len(row):
                return 0.0
            column = where if function == "xcm" else 4 + where
            return float((row[:, 7] * row[:, column]).sum() / row[:, 7].sum())
        if function == "fcm":
            return float(self.world.state.force[: self.world.state.n][chosen][:, where].sum())
        msg = f"{function}()"
        raise KeyError(msg)

    @staticmethod
    def _bound(row: Floats, rest: list[str]) -> float:
        """Return an extreme coordinate."""
        axis = {"x": 0, "y": 1, "z": 2}[rest[0][0]]
        if rest[0][1:] == "max":
            return float(row[:, axis].max()) if len(row) else -1.0e20
        return float(row[:, axis].min()) if len(row) else 1.0e20

    # -- computes, fixes, particles ----------------------------------------------------------------

    def compute_value(self, id: str, indices: tuple[int, ...]) -> float:
        """Return ``c_ID`` or ``c_ID[i]``.

        Raises
        ------
        KeyError
            If there is no such compute.
        """
        if id not in self.world.computes:
            msg = f"c_{id}"
            raise KeyError(msg)
        return float(self.world.computes[id].value(self.world, indices))

    def fix_value(self, id: str, indices: tuple[int, ...]) -> float:
        """Return ``f_ID`` or ``f_ID[i]``.

        Raises
        ------
        KeyError
            If there is no such fix or it has no such value.
        """
        if id not in self.world.fixes:
            msg = f"f_{id}"
            raise KeyError(msg)
        fix = self.world.fixes[id]
        if isinstance(fix, MassFlow):
            fix.access(self.world.step, self.world.dt)
        if isinstance(fix, Post) and not any(fix.variables):
            fix.before[0] = potential(self.world, fix)
        return fix.vector(indices[0] if indices else 0)

    def atom_vector(self, name: str) -> Floats:
        """Return one value per particle, in the internal order.

        Raises
        ------
        KeyError
            For an unknown name.
        """
        state = self.world.state
        n = state.n
        if name in COLUMNS:
            array, column = COLUMNS[name]
            return np.asarray(getattr(state, array)[:n, column], float)
        if name == "id":
            return state.ids[:n].astype(float)
        if name == "type":
            return state.kind[:n].astype(float) + 1.0
        if name == "density":
            return state.density[:n].copy()
        if name == "diameter":
            return 2.0 * state.row[:n, 3]
        return self._derived(name)

    def _derived(self, name: str) -> Floats:
        """Return ``c_ID``, ``c_ID[i]``, ``f_ID`` or ``v_NAME`` per particle."""
        world = self.world
        if name.startswith("v_"):
            values: Floats = world.interpreter.atom_values(name[2:])
            return values
        base, _, index = name.partition("[")
        if base.startswith("c_") and base[2:] in world.computes:
            per_atom: Floats = world.computes[base[2:]].per_atom(
                world, int(index[:-1]) if index else 0
            )
            return per_atom
        if base.startswith("f_massflow_"):
            flows = [flow.name for flow in world.of_kind(MassFlow)]
            if base[11:] in flows:
                at = flows.index(base[11:])
                return world.state.marker[at, : world.state.n].astype(float)
        raise KeyError(name)
