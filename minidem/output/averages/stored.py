"""``fix store/state`` and ``property/atom``: values that stay with their particles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from minidem.errors import InputError
from minidem.kernels.columns import MASS
from minidem.output.averages.atom import column_of
from minidem.output.columns import atom_vector, check_columns
from minidem.record import field, record
from minidem.registry import Head
from minidem.words import Words, number, variables_in
from minidem.world.event import NEVER, next_multiple
from minidem.world.fix import FIXES, Fix
from minidem.world.momentum import centre_of_mass
from minidem.world.state import Floats, Ints
from minidem.world.values.by_id import ById
from minidem.world.values.named import need_names
from minidem.world.world import World

__all__ = ["PropertyFix", "StoreState", "StoredFix"]

_WHAT = ("c_", "f_", "v_")
_OTHERS = ("density", "diameter", "xsu", "ysu", "zsu")  # columns of dumps only
_UNWRAPPED = ("xu", "yu", "zu")


@record
class StoredFix(Fix):
    """Values per particle.

    Attributes
    ----------
    kept : ById
        The values.
    """

    kept: ById = field(default_factory=lambda: ById(()))

    def per_atom(self, world: World, name: str) -> Floats | None:
        """Return a column."""
        column = column_of(name, self.name, len(self.kept.usual))
        return None if column is None else self.kept.rows(world)[:, column]

    def ids_changed(self, new: Mapping[int, int]) -> None:
        """Follow particles that have got new ids."""
        self.kept.ids_changed(new)

    def particles_copied(self, steps: Sequence[int]) -> None:
        """Give copies of particles the same values."""
        self.kept.copied(steps)

    def state(self) -> dict[str, Any]:
        """Return the values."""
        return self.kept.state()

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Take the values from a restart file."""
        self.kept.restore(saved)


@FIXES.register("store/state")
@record
class StoreState(StoredFix):
    """What particle values were at one time, or every so many steps.

    Attributes
    ----------
    every : int
        Interval in steps; 0 for once.
    names : tuple of str
        What is stored, see `minidem.output.columns`.
    from_centre : bool
        ``com yes``: positions ``xu``, ``yu`` and ``zu`` are from the group's centre of mass.
    begun : bool
        Whether a run has begun: computes, fixes and variables are stored then, other values at
        once.
    """

    every: int = 0
    names: tuple[str, ...] = ()
    from_centre: bool = False
    begun: bool = False

    def variables_asked(self) -> tuple[str, ...]:
        """Return the names of the variables that it asks in a run."""
        return variables_in(self.names)

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> StoreState:
        """Read interval and inputs, and store what there is."""
        words.need(2, "fix ID GROUP store/state N INPUT ...")
        every = words.interval(least=0)
        given = words.rest()
        at = given.index("com") if "com" in given else len(given)
        options = Words(given[at:], head.style)
        names = check_columns(given[:at], without=_OTHERS, what="input")
        need_names(world, f"fix {head.style}", names, per_atom=True)
        made = cls(*head, ById((0.0,) * len(names)), every, names)
        while not options.done():
            options.expect("com")
            made.from_centre = options.yes_no()
        made.store(world, [name[:2] not in _WHAT for name in names])
        return made

    def store(self, world: World, which: list[bool]) -> None:
        """Store some of the values."""
        rows = self.kept.rows(world)
        member = world.member(self.bit)
        centre = np.zeros(len(_UNWRAPPED))
        if self.from_centre:
            weight = world.state.row[: world.state.n][member, MASS, None]
            centre = centre_of_mass(weight, world.unwrapped()[member])
        for column, (name, wanted) in enumerate(zip(self.names, which, strict=True)):
            if wanted:
                values = atom_vector(world, name)
                if name in _UNWRAPPED:
                    values = values - centre[_UNWRAPPED.index(name)]
                rows[:, column] = np.where(member, values, 0.0)
        self.kept.keep(world, rows)

    def start(self, world: World) -> None:
        """Store what needs a run."""
        if not self.begun:
            self.begun = True
            self.store(world, [name[:2] in _WHAT for name in self.names])

    def next_step(self, step: int) -> int:
        """Return the next multiple of the interval."""
        return next_multiple(step, self.every) if self.every else NEVER

    def act(self, world: World) -> None:
        """Store all values anew."""
        self.store(world, [True] * len(self.names))

    def state(self) -> dict[str, Any]:
        """Return the values and whether all are stored."""
        return super().state() | {"begun": self.begun}

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Take the values from a restart file."""
        super().restore(saved)
        self.begun = bool(saved.get("begun", False))


@FIXES.register("property/atom")
@record
class PropertyFix(StoredFix):
    """A property of the particles that the script alone uses.

    Attributes
    ----------
    variable : str
        Its name, as ``set ... property/atom NAME`` has it.
    lasts : bool
        Whether restart files keep it.
    """

    variable: str = ""
    lasts: bool = False

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> PropertyFix:
        """Read name, kind and default values."""
        usage = "fix ID GROUP property/atom NAME scalar|vector yes|no yes|no yes|no VALUE ..."
        words.need(6, usage)
        name = words.take("a name")
        kind = words.choice(("scalar", "vector", "vector_one_entry"), "kind")
        lasts, _, _ = words.yes_no(), words.yes_no(), words.yes_no()
        given = words.rest()
        usual = tuple(0.0 if word == "none" else number(word, head.style) for word in given)
        if (len(usual) == 1) == (kind == "vector"):
            msg = f"fix property/atom: {len(usual)} default values do not fit '{kind}'"
            raise InputError(msg)
        if any(other.variable == name for other in world.of_kind(PropertyFix)):
            msg = f"fix property/atom: there is already a fix for '{name[:40]}'"
            raise InputError(msg)
        return cls(*head, ById(usual), name, lasts)

    def property_of(self, ids: Ints, name: str) -> Floats | None:
        """Return the values of some particles if the property is this one."""
        return self.kept.of(ids) if name == self.variable else None

    def assign(self, world: World, name: str, who: Ints, words: Words) -> bool:
        """Read new values for some particles if the property is this one."""
        if name != self.variable:
            return False
        rows = self.kept.rows(world)
        rows[who] = words.numbers(len(self.kept.usual))
        self.kept.keep(world, rows)
        return True

    def state(self) -> dict[str, Any]:
        """Return the values if restart files keep them."""
        return super().state() if self.lasts else {}
