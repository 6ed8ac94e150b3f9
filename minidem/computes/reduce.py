"""``compute ID GROUP reduce sum INPUT ...``: minimum, maximum, sum or mean over particles."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from minidem.output.columns import atom_vector, split_indices
from minidem.output.dump_local import local_columns
from minidem.registry import Head
from minidem.words import Words
from minidem.world.compute import COMPUTES, Compute
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["Reduce"]

_MODES: Final[dict[str, Callable[[Any], Any]]] = {
    "sum": np.add.reduce,
    "min": np.minimum.reduce,
    "max": np.maximum.reduce,
    "ave": np.mean,
}
_OF_NOTHING: Final = {"min": 1.0e20, "max": -1.0e20}  # as LIGGGHTS; the others are 0


@COMPUTES.register("reduce")
@dataclass
class Reduce(Compute):
    """A number from the values of all particles of the group.

    Attributes
    ----------
    mode : str
        sum, min, max or ave.
    names : tuple of str
        What is reduced, see `minidem.output.columns`.
    """

    mode: str
    names: tuple[str, ...]

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Reduce:
        """Read mode and inputs."""
        del world
        words.need(2, f"compute ID GROUP {head.style} sum INPUT ...")
        return cls(*head, words.choice(tuple(_MODES), "mode"), tuple(words.rest()))

    def value(self, world: World, indices: tuple[int, ...]) -> float:
        """Return the reduction of input `indices[0]`, from 1."""
        wanted = indices[0] if indices else 1
        if wanted > len(self.names):
            return super().value(world, indices)
        name = self.names[wanted - 1]
        values = self.values(world, name)
        if not len(values):
            return _OF_NOTHING.get(self.mode, 0.0)
        return float(_MODES[self.mode](values))

    def values(self, world: World, name: str) -> Floats:
        """Return the values of an input: of particles of the group, or of contacts."""
        base, indices = split_indices(name)
        compute = world.computes.get(base.removeprefix("c_")) if base.startswith("c_") else None
        if compute is not None and compute.per_contact:
            table = local_columns(world, compute.name)
            at = indices[0] if indices else 1
            return table[:, at - 1] if at <= table.shape[1] else compute.per_atom(world, at)
        return atom_vector(world, name)[world.member(self.bit)]
