"""Base of all computes, and the table of their styles."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Self

from minidem.errors import UnknownNameError
from minidem.record import record
from minidem.registry import Head, Registry
from minidem.words import Words
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["COMPUTES", "Compute"]


@record
class Compute:
    """One ``compute`` command; most have either one value or one per particle.

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

    per_contact: ClassVar[bool] = False
    """Whether it has values per contact."""
    own_lists: ClassVar[bool] = False
    """Whether LIGGGHTS makes neighbour lists for it."""
    looks_inside: ClassVar[bool] = False
    """Whether it asks for contacts as they were inside of a step."""
    extensive: ClassVar[tuple[bool, bool]] = (False, False)
    """Whether its scalar and its elements are sums over particles."""

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Self:
        """Make a compute from the words after its style.

        Raises
        ------
        InputError
            For an unfit word.
        """
        del world, words
        return cls(*head)

    def begin(self, world: World) -> None:
        """Note what counts for a whole run, before particles beyond a fixed face are gone."""

    def start(self, world: World) -> None:
        """Note what counts for a whole run, when lists and forces are made."""

    def variables_asked(self) -> tuple[str, ...]:
        """Return the names of the variables that it asks in a run."""
        return ()

    def value(self, world: World, indices: tuple[int, ...]) -> float:
        """Return the scalar ``c_ID`` or the element ``c_ID[i]``, i from 1.

        Raises
        ------
        UnknownNameError
            If this compute has no such value.
        """
        del world, indices
        msg = f"compute {self.name} has no such value"
        raise UnknownNameError(msg)

    def column(self, world: World, index: int) -> Floats | None:
        """Return all of ``c_ID`` (0) or ``c_ID[index]`` at once, None if that is no faster."""
        del world, index
        return None

    def adds_up(self, world: World, indices: tuple[int, ...]) -> bool:
        """Tell whether a value is a sum over particles, which ``norm yes`` divides by them."""
        del world
        return self.extensive[bool(indices)]

    def per_atom(self, world: World, index: int) -> Floats:
        """Return one value per particle, ``c_ID`` (0) or ``c_ID[index]``, shape (n,).

        Raises
        ------
        UnknownNameError
            If this compute has no such values.
        """
        del world, index
        msg = f"compute {self.name} has no value per particle"
        raise UnknownNameError(msg)

    def local(self, world: World) -> dict[str, Floats]:
        """Return values per contact by name, each of shape (contacts,) or (contacts, 3).

        Raises
        ------
        UnknownNameError
            If this compute has no such values.
        """
        del world
        msg = f"compute {self.name} has no values per contact"
        raise UnknownNameError(msg)

    def ids_changed(self, new: Mapping[int, int]) -> None:
        """Follow particles that have got new ids; those that are not in `new` are gone."""

    def modify(self, key: str, words: Words) -> None:
        """Read the value of a keyword of ``compute_modify``; most concern only temperatures.

        Raises
        ------
        InputError
            If it is not understood.
        """
        del key
        words.take("a value")


COMPUTES: Registry[type[Compute]] = Registry("compute style")
"""Compute style to its class."""
