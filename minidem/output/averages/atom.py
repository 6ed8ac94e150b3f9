"""``fix ID GROUP ave/atom EVERY REPEAT PERIOD INPUT ...``: means over time per particle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from minidem.output.averages.sampling import SampledFix, Sampling
from minidem.output.columns import atom_vector
from minidem.record import field, record
from minidem.registry import Head
from minidem.words import Words, variables_in
from minidem.world.fix import FIXES
from minidem.world.state import Floats
from minidem.world.values.by_id import ById
from minidem.world.values.named import need_names
from minidem.world.world import World

__all__ = ["AverageAtom", "column_of"]

_INPUTS: Final = ("x", "y", "z", "vx", "vy", "vz", "fx", "fy", "fz")
_PREFIXES: Final = ("c_", "f_", "v_")


def column_of(word: str, name: str, columns: int) -> int | None:
    """Return the column, from 0, that ``NAME`` or ``NAME[i]`` means; None if it is none."""
    if word in (name, f"{name}[0]") and columns == 1:
        return 0
    if not (word.startswith(f"{name}[") and word.endswith("]")):
        return None
    index = word[len(name) + 1 : -1]
    fits = index.isascii() and index.isdigit() and 1 <= int(index) <= columns
    return int(index) - 1 if fits else None


@FIXES.register("ave/atom")
@record
class AverageAtom(SampledFix):
    """Means over time of values per particle.

    Attributes
    ----------
    names : tuple of str
        What is averaged, see `minidem.output.columns`.
    sums : ById
        Sums of the present samples; after the last their mean.
    """

    names: tuple[str, ...]
    sums: ById = field(default_factory=lambda: ById(()))

    def variables_asked(self) -> tuple[str, ...]:
        """Return the names of the variables that it asks in a run."""
        return variables_in(self.names)

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> AverageAtom:
        """Read intervals and inputs."""
        words.need(4, "fix ID GROUP ave/atom EVERY REPEAT PERIOD INPUT ...")
        sampling, names = Sampling.read(words), list[str]()
        while not words.done():
            named = words.peek()[:2] in _PREFIXES
            names.append(words.take("an input") if named else words.choice(_INPUTS, "input"))
        made = cls(*head, sampling, tuple(names))
        need_names(world, f"fix {head.style}", made.names, per_atom=True)
        made.sums = ById((0.0,) * len(made.names))
        made.sampling.restart(world.step)
        return made

    def per_atom(self, world: World, name: str) -> Floats | None:
        """Return the means of an input."""
        column = column_of(name, self.name, len(self.names))
        return None if column is None else self.sums.rows(world)[:, column]

    def act(self, world: World) -> None:
        """Take a sample."""
        total = self.sums.rows(world)
        if self.sampling.taken == 0:
            total[:] = 0.0
        member = world.member(self.bit)
        for column, name in enumerate(self.names):
            total[member, column] += atom_vector(world, name)[member]
        if self.sampling.done(world.step):
            total /= self.sampling.repeat
        self.sums.keep(world, total)

    def ids_changed(self, new: Mapping[int, int]) -> None:
        """Follow particles that have got new ids."""
        self.sums.ids_changed(new)

    def particles_copied(self, steps: Sequence[int]) -> None:
        """Give copies of particles the same values."""
        self.sums.copied(steps)
