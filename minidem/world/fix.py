"""Base of all fixes, and the table of their styles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, Self

from minidem.errors import UnknownNameError
from minidem.record import record
from minidem.registry import Head, Registry
from minidem.words import Words
from minidem.world.event import NEVER
from minidem.world.state import Floats, Ints
from minidem.world.world import World

__all__ = ["FIXES", "Fix", "all_fixes", "largest_inserted"]


@record
class Fix:
    """One ``fix`` command; a style is a subclass that overrides what it needs, see `FIXES`.

    Attributes
    ----------
    name : str
        Its id in the script.
    style : str
        Style as written.
    bit : int
        Group bit.
    """

    name: str
    style: str
    bit: int

    before_box: ClassVar[bool] = False
    """Whether it may stand before ``create_box``."""
    extensive: ClassVar[tuple[bool, bool]] = (False, False)
    """Whether its scalar and its elements are sums over particles."""
    energetic: ClassVar[bool] = False
    """Whether its scalar is a potential energy, which ``fix_modify ID energy yes`` counts."""
    looks_inside: ClassVar[bool] = False
    """Whether it asks for contacts as they were inside of a step."""
    begins_with_run: ClassVar[bool] = False
    """Whether what it does goes from the beginning of a run to its end."""

    # -- the script ------------------------------------------------------------------------------

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Self:
        """Make a fix from the words after its style.

        Raises
        ------
        InputError
            For an unfit word.
        """
        del world, words
        return cls(*head)

    def modify(self, world: World, words: Words) -> None:
        """Read what follows ``fix_modify ID``; InputError for an unfit word."""
        if words.choice(("energy", "virial", "temp", "press")) != "energy":
            words.rest()  # they concern virials that no thermo keyword shows
            return
        counted = words.yes_no()
        if counted and self.energetic:
            world.energies.add(self.name)
        else:
            world.energies.discard(self.name)

    def variables_asked(self) -> tuple[str, ...]:
        """Return the names of the variables that it asks in a run."""
        return ()

    def value(self, world: World, index: int) -> float:
        """Return ``f_ID[index]``, index from 1; 0 is the scalar ``f_ID``.

        Raises
        ------
        UnknownNameError
            If this fix has no such value.
        """
        del world
        msg = f"fix {self.style} has no value [{index}]"
        raise UnknownNameError(msg)

    def element(self, world: World, indices: tuple[int, ...]) -> float:
        """Return ``f_ID[i][j]``, both from 1.

        Raises
        ------
        UnknownNameError
            If this fix has no such value.
        """
        del world
        shown = "".join(f"[{index}]" for index in indices)
        msg = f"fix {self.style} has no value {shown}"
        raise UnknownNameError(msg)

    def adds_up(self, world: World, indices: tuple[int, ...]) -> bool:
        """Tell whether a value is a sum over particles, which ``norm yes`` divides by them."""
        del world
        return self.extensive[bool(indices)]

    def per_atom(self, world: World, name: str) -> Floats | None:
        """Return one value per particle for ``f_name``; None if this fix has none of that name."""
        del world, name
        return None

    def property_of(self, ids: Ints, name: str) -> Floats | None:
        """Return what ``property/atom`` keeps under `name`, a row per id; else None."""
        del ids, name
        return None

    def assign(self, world: World, name: str, who: Ints, words: Words) -> bool:
        """Read new values of property `name` for particles; False if it is not of this fix."""
        del world, name, who, words
        return False

    def meshes_used(self) -> tuple[str, ...]:
        """Return the ids of the meshes that must not be unfixed before this."""
        return ()

    def material_types(self) -> tuple[int, ...]:
        """Return the atom types that it brings into the simulation, as walls and templates do."""
        return ()

    def remove(self, world: World) -> None:
        """Tidy up before ``unfix``; InputError if it must not be taken away now."""

    # -- a run -----------------------------------------------------------------------------------

    def check(self, world: World) -> None:
        """Refuse a run that LIGGGHTS refuses because of it; InputError says why."""

    def setup(self, world: World) -> None:
        """Prepare for a run that begins now."""

    def start(self, world: World) -> None:
        """Act at the start of a run, when its forces are known."""

    def next_step(self, step: int) -> int:
        """Return the first step after `step` at whose end it acts."""
        del step
        return NEVER

    def act(self, world: World) -> None:
        """Act at the end of the present step."""

    def next_insertion(self) -> int:
        """Return the next step in which it adds particles, between the move and the forces."""
        return NEVER

    def insert(self, world: World) -> None:
        """Add particles now."""

    def largest_inserted(self) -> float:
        """Return the largest radius of particles that it may add, 0 for none, m."""
        return 0.0

    def compresses_ids(self) -> bool:
        """Return whether all particles get new ids where it has added some."""
        return False

    def particles_inserted(
        self, world: World, insert: str, rows: slice, passes: Ints, following: int
    ) -> None:
        """Follow a stream that has added particles.

        Parameters
        ----------
        world : World
            With the new particles.
        insert : str
            Name of the fix that has added them.
        rows : slice
            Where they are.
        passes : ndarray of int64, shape (n,)
            Steps in which they will pass the face.
        following : int
            Step of the next particles.
        """

    # -- restart files and renumbering -----------------------------------------------------------

    def state(self) -> dict[str, Any]:
        """Return what a restart file has to keep, as JSON takes it."""
        return {}

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Take a state from a restart file."""

    def ids_changed(self, new: Mapping[int, int]) -> None:
        """Follow particles that have got new ids; those that are not in `new` are gone."""

    def particles_copied(self, steps: Sequence[int]) -> None:
        """Follow particles that got copies: with ids higher by each of `steps`."""

    def steps_shifted(self, world: World, shift: int) -> None:
        """Follow a ``reset_timestep`` by `shift` steps."""


FIXES: Registry[type[Fix]] = Registry("fix")
"""Fix style to its class."""


def all_fixes(world: World) -> list[Fix]:
    """Return all fixes in the order of the script."""
    return world.fixes.of_kind(Fix)


def largest_inserted(world: World) -> float:
    """Return the largest radius of particles that fixes may add, 0 for none, m."""
    return max((fix.largest_inserted() for fix in all_fixes(world)), default=0.0)
