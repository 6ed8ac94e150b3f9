"""What formulas may ask the running simulation."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from minidem.errors import UnknownNameError

__all__ = ["Context", "EmptyContext"]


class Context(Protocol):
    """The engine as formulas see it.

    Every method raises UnknownNameError for a name it does not know, InputError for a question
    without an answer; the message is shown to the user with file and line.
    """

    def thermo(self, keyword: str) -> float:
        """Return a thermo keyword (step, dt, time, atoms, ke ...).

        Besides those of LIGGGHTS, ``beginstep`` and ``endstep`` are asked for: first and last
        step of the present run, UnknownNameError between runs.
        """

    def group_value(self, function: str, args: tuple[str, ...]) -> float:
        """Return a group function (count, mass, xcm ...) of group[, dim][, region]."""

    def compute_value(self, id: str, indices: tuple[int, ...]) -> float:
        """Return ``c_ID``, ``c_ID[i]`` or ``c_ID[i][j]``."""

    def fix_value(self, id: str, indices: tuple[int, ...]) -> float:
        """Return ``f_ID``, ``f_ID[i]`` or ``f_ID[i][j]``."""

    def elements(self, word: str) -> NDArray[np.float64]:
        """Return all elements of ``c_ID`` or ``f_ID``, or of a column ``c_ID[j]``, shape (n,)."""

    def need_map(self) -> None:
        """Raise NoValueError if the script has no atom map, by which ids are looked up."""

    def atom_vector(self, name: str) -> NDArray[np.float64]:
        """Return one value per particle.

        Parameters
        ----------
        name : str
            A per-particle property (``id``, ``type``, ``mass``, ``x`` ... ``tqz``, ``r``,
            ``density``), a per-particle compute or fix, such as ``c_ID`` or ``f_ID[2]``, or
            ``gmask(GROUP)``, ``rmask(REGION)``, ``grmask(GROUP,REGION)``.
        """


class EmptyContext:
    """A context before there is a simulation box: every question is an error."""

    def thermo(self, keyword: str) -> float:
        """Raise UnknownNameError."""
        raise UnknownNameError(keyword)

    def group_value(self, function: str, args: tuple[str, ...]) -> float:
        """Raise UnknownNameError."""
        del args
        raise UnknownNameError(function)

    def compute_value(self, id: str, indices: tuple[int, ...]) -> float:
        """Raise UnknownNameError."""
        del indices
        raise UnknownNameError(id)

    def fix_value(self, id: str, indices: tuple[int, ...]) -> float:
        """Raise UnknownNameError."""
        del indices
        raise UnknownNameError(id)

    def need_map(self) -> None:
        """Ask for no map."""

    def atom_vector(self, name: str) -> NDArray[np.float64]:
        """Raise UnknownNameError."""
        raise UnknownNameError(name)

    def elements(self, word: str) -> NDArray[np.float64]:
        """Raise UnknownNameError."""
        raise UnknownNameError(word)
