"""``compute ID GROUP reduce sum INPUT ...``: minimum, maximum, sum or mean over particles."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np

from minidem.errors import InputError
from minidem.kernels.columns import POSITION
from minidem.output.columns import COLUMNS, atom_vector, split_indices
from minidem.output.dump_local import local_columns
from minidem.record import field, record
from minidem.registry import Head
from minidem.words import Words, one_of, variables_in
from minidem.world.compute import COMPUTES, Compute
from minidem.world.state import Bools, Floats, Ints
from minidem.world.values.named import need_names
from minidem.world.world import World

__all__ = ["Reduce"]

_MODES: Final[dict[str, Callable[[Any], Any]]] = {
    "sum": np.add.reduce,
    "min": np.minimum.reduce,
    "max": np.maximum.reduce,
    "ave": np.mean,
}
_INPUTS: Final = ("x", "y", "z", "vx", "vy", "vz", "fx", "fy", "fz")
_PREFIXES: Final = ("c_", "f_", "v_")
_OF_NOTHING: Final = {"min": 1.0e20, "max": -1.0e20}  # as LIGGGHTS; the others are 0


@COMPUTES.register("reduce", "reduce/region")
@record
class Reduce(Compute):
    """A number from the values of all particles of the group.

    Attributes
    ----------
    mode : str
        sum, min, max or ave.
    names : tuple of str
        What is reduced, see `minidem.output.columns`.
    region : str
        Only particles in this region; empty for all.
    replaced : dict of int to int
        Inputs of which the value of the extreme particle of another is taken, both from 1.
    """

    mode: str
    names: tuple[str, ...]
    region: str = ""
    replaced: dict[int, int] = field(default_factory=dict)

    def variables_asked(self) -> tuple[str, ...]:
        """Return the names of the variables that it asks in a run."""
        return variables_in(self.names)

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Reduce:
        """Read region, mode and inputs."""
        inside = head.style == "reduce/region"
        where = " REGION" if inside else ""
        words.need(2 + inside, f"compute ID GROUP {head.style}{where} sum INPUT ...")
        region = one_of(words.take("a region"), tuple(world.regions), "region") if inside else ""
        mode = words.choice(tuple(_MODES), "mode")
        names = []
        while not words.done() and words.peek() != "replace":
            names.append(_input(words))
        need_names(world, f"compute {head.style}", names, per_atom=True)
        made = cls(*head, mode, tuple(names), region)
        while not words.done():
            words.expect("replace")
            made.replaced.update([made._replacement(words)])
        return made

    def _replacement(self, words: Words) -> tuple[int, int]:
        """Read the two numbers after ``replace``."""
        first, second = words.integer(), words.integer()
        fits = 1 <= first <= len(self.names) and 1 <= second <= len(self.names) and first != second
        if not fits or self.mode not in _OF_NOTHING:
            msg = "replace: expected two different inputs of 'min' or 'max', by number"
            raise InputError(msg)
        return first, second

    def value(self, world: World, indices: tuple[int, ...]) -> float:
        """Return the reduction of input `indices[0]`, from 1."""
        wanted = indices[0] if indices else 1
        if wanted > len(self.names):
            return super().value(world, indices)
        name = self.names[wanted - 1]
        values = self.values(world, name)
        if not len(values):
            return _OF_NOTHING.get(self.mode, 0.0)
        if wanted in self.replaced:
            other = self.values(world, self.names[self.replaced[wanted] - 1])
            extreme = np.flatnonzero(other == _MODES[self.mode](other))
            if not self.of_contacts(world, name):
                return float(values[extreme[self.places(world)[extreme].argmin()]])
            return float(values[extreme[0]])
        return float(_MODES[self.mode](values))

    def adds_up(self, world: World, indices: tuple[int, ...]) -> bool:
        """Tell whether it sums up."""
        del world, indices
        return self.mode == "sum"

    def of_contacts(self, world: World, name: str) -> Compute | None:
        """Return the compute of contacts that an input names, None if it names another."""
        base, _ = split_indices(name)
        compute: Compute | None = world.computes.get(base[2:]) if base[:2] == "c_" else None
        return compute if compute is not None and compute.per_contact else None

    def values(self, world: World, name: str) -> Floats:
        """Return the values of an input: of particles of the group, or of contacts."""
        _, indices = split_indices(name)
        if (compute := self.of_contacts(world, name)) is not None:
            table = local_columns(world, compute.name)
            at = indices[0] if indices else 1
            column = at - 1
            return table[:, column] if at <= table.shape[1] else compute.per_atom(world, at)
        return atom_vector(world, name)[self.chosen(world)]

    def places(self, world: World) -> Ints:
        """Return the places of the particles in the output, of which the first decides."""
        found: Ints = world.state.rank[: world.state.n][self.chosen(world)]
        return found

    def chosen(self, world: World) -> Bools:
        """Return which particles count, shape (n,)."""
        chosen = world.member(self.bit)
        if self.region:
            points = world.state.row[: world.state.n, POSITION]
            chosen = chosen & world.regions[self.region].match(points)
        return chosen


def _input(words: Words) -> str:
    """Read an input; what else particles have goes by ``compute property/atom``."""
    word = words.peek()
    if word[:2] in _PREFIXES:
        return words.take("an input")
    if word in COLUMNS and word not in _INPUTS:
        msg = (
            f"compute reduce: '{word[:40]}' is no input; give 'compute ID GROUP property/atom "
            f"{word[:40]}' and its c_ID"
        )
        raise InputError(msg)
    return words.choice(_INPUTS, "input")
