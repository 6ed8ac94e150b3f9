"""``compute``: quantities worked out on demand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from minidem.output.quantities import Quantities
from minidem.registry import COMPUTES, command, compute, need, one_of
from minidem.run.engine import Engine
from minidem.world.state import Floats
from minidem.world.world import World


@dataclass
class Compute:
    """A compute; most have either one value or one per particle."""

    name: str
    bit: int

    def value(self, world: World, indices: tuple[int, ...]) -> float:
        """Return the scalar or a vector element."""
        del world, indices
        msg = f"compute {self.name} has no such value"
        raise KeyError(msg)

    def per_atom(self, world: World, index: int) -> Floats:
        """Return one value per particle."""
        del world, index
        msg = f"compute {self.name} has no value per particle"
        raise KeyError(msg)


@dataclass
class ErotateSphere(Compute):
    """Rotational kinetic energy, J."""

    def value(self, world: World, indices: tuple[int, ...]) -> float:
        """Return the sum of 0.5 * 0.4 m r2 w2."""
        del indices
        who = world.member(self.bit)
        row = world.state.row[: world.state.n][who]
        spin = world.state.spin[: world.state.n][who]
        inertia = 0.4 * row[:, 7] * row[:, 3] ** 2
        return float(0.5 * (inertia * (spin[:, :3] ** 2).sum(axis=1)).sum())


@dataclass
class Kinetic(Compute):
    """Translational kinetic energy, J, of the group."""

    def value(self, world: World, indices: tuple[int, ...]) -> float:
        """Return the sum of 0.5 m v2."""
        del indices
        row = world.state.row[: world.state.n][world.member(self.bit)]
        return float(0.5 * (row[:, 7] * (row[:, 4:7] ** 2).sum(axis=1)).sum())


@dataclass
class KineticAtom(Compute):
    """Translational kinetic energy per particle, J."""

    def per_atom(self, world: World, index: int) -> Floats:
        """Return 0.5 m v2 of particles in the group, 0 for others."""
        del index
        row = world.state.row[: world.state.n]
        found: Floats = 0.5 * row[:, 7] * (row[:, 4:7] ** 2).sum(axis=1)
        return found * world.member(self.bit)


@dataclass
class Centre(Compute):
    """Centre of mass, m."""

    def value(self, world: World, indices: tuple[int, ...]) -> float:
        """Return one coordinate, index from 1."""
        row = world.state.row[: world.state.n][world.member(self.bit)]
        if not len(row):
            return 0.0
        return float((row[:, 7] * row[:, indices[0] - 1]).sum() / row[:, 7].sum())


@dataclass
class PropertyAtom(Compute):
    """Particle properties, one column each."""

    names: tuple[str, ...] = ()

    def per_atom(self, world: World, index: int) -> Floats:
        """Return a column, index from 1; 0 if there is only one."""
        found = Quantities(world).atom_vector(self.names[max(index, 1) - 1])
        return found * world.member(self.bit)


@dataclass
class Reduce(Compute):
    """Minimum, maximum, sum or average of per-particle values."""

    mode: str = "sum"
    names: tuple[str, ...] = ()

    def value(self, world: World, indices: tuple[int, ...]) -> float:
        """Return the reduction of input `indices[0]`, from 1."""
        name = self.names[(indices[0] if indices else 1) - 1]
        values = Quantities(world).atom_vector(name)[world.member(self.bit)]
        if not len(values):
            return {"min": 1.0e20, "max": -1.0e20}.get(self.mode, 0.0)
        if self.mode == "ave":
            return float(values.mean())
        ways = {"min": np.minimum, "max": np.maximum, "sum": np.add}
        return float(ways[self.mode].reduce(values))


_PLAIN: dict[str, type[Compute]] = {
    "erotate/sphere": ErotateSphere,
    "ke": Kinetic,
    "ke/atom": KineticAtom,
    "com": Centre,
}


@compute(*_PLAIN)
def _plain(engine: Engine, name: str, style: str, group: str, words: Sequence[str]) -> Compute:
    del words
    return _PLAIN[style](name, engine.world.bit(group))


@compute("property/atom")
def _property(engine: Engine, name: str, style: str, group: str, words: Sequence[str]) -> Compute:
    need(words, 1, f"compute ID GROUP {style} COLUMN ...")
    return PropertyAtom(name, engine.world.bit(group), tuple(words))


@compute("reduce")
def _reduce(engine: Engine, name: str, style: str, group: str, words: Sequence[str]) -> Compute:
    need(words, 2, f"compute ID GROUP {style} sum INPUT ...")
    mode = one_of(words[0], ("sum", "min", "max", "ave"), "reduce mode")
    return Reduce(name, engine.world.bit(group), mode, tuple(words[1:]))


@command("compute")
def _compute(engine: Engine, words: Sequence[str]) -> None:
    need(words, 3, "compute ID GROUP STYLE")
    name, group, style = words[:3]
    one_of(style, tuple(COMPUTES), "compute style")
    if name in engine.world.computes:
        msg = f"compute ID '{name}' is in use already; 'uncompute {name}' first"
        raise ValueError(msg)
    engine.world.computes[name] = COMPUTES[style](engine, name, style, group, words[3:])


@command("uncompute")
def _uncompute(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "uncompute ID")
    one_of(words[0], tuple(engine.world.computes), "compute")
    del engine.world.computes[words[0]]


@command("compute_modify")
def _compute_modify(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "compute_modify ID KEYWORD VALUE")
    one_of(words[0], tuple(engine.world.computes), "compute")
