"""Variables of a script that is not executed: what only the simulation knows is guessed."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from minidem.errors import InputError, UnknownNameError
from minidem.script.context import Context
from minidem.script.formula import FormulaError
from minidem.script.paths import CaseFolder
from minidem.script.variables import LISTS, Variables

__all__ = ["GuessingContext", "GuessingVariables"]

_KNOWN = ("step", "dt", "time", "elapsed", "beginstep", "endstep")
_GUESS = 1.0


class GuessingContext:
    """Answers what a rehearsal knows, and notes that the rest is guessed.

    Parameters
    ----------
    real : Context
        The simulation that does not run.
    keywords : collection of str or None
        Thermo keywords there are; None if that is not known.

    Attributes
    ----------
    guessed : bool
        Whether anything was guessed since this was last set to False.
    steps_known : bool
        Whether the time step is that of the script.
    """

    def __init__(self, real: Context, keywords: Collection[str] | None) -> None:
        self.real = real
        self.guessed = False
        self.steps_known = True
        self._keywords = keywords

    def guess(self) -> float:
        """Return a guess and note it."""
        self.guessed = True
        return _GUESS

    def thermo(self, keyword: str) -> float:
        """Return a thermo keyword; UnknownNameError if there is none."""
        known = self._keywords
        if known is not None and keyword in _KNOWN and self.steps_known:
            return self.real.thermo(keyword)
        if known is not None and keyword not in known:
            raise UnknownNameError(keyword)
        return self.guess()

    def group_value(self, function: str, args: tuple[str, ...]) -> float:
        """Return a guess."""
        del function, args
        return self.guess()

    def compute_value(self, id: str, indices: tuple[int, ...]) -> float:
        """Return a guess."""
        del id, indices
        return self.guess()

    def fix_value(self, id: str, indices: tuple[int, ...]) -> float:
        """Return a guess."""
        del id, indices
        return self.guess()

    def elements(self, word: str) -> NDArray[np.float64]:
        """Return a guess."""
        del word
        return np.array([self.guess()])

    def need_map(self) -> None:
        """Ask the simulation."""
        self.real.need_map()

    def atom_vector(self, name: str) -> NDArray[np.float64]:
        """Return a guess for each particle there is."""
        self.guess()
        try:
            count = len(self.real.atom_vector("id"))
        except InputError:
            count = 0
        found = 1.0 + np.arange(count) if name == "id" else np.full(count, _GUESS)
        return found.astype(np.float64)


class GuessingVariables(Variables):
    """Variables of which some are not known.

    Parameters
    ----------
    context : GuessingContext
        What formulas may ask.
    preset : mapping
        Values from the command line.
    folder : CaseFolder
        Folder of the files that variables name.

    Attributes
    ----------
    unknown : set of str
        Names whose value, or whether they exist at all, is decided by the simulation.
    """

    def __init__(
        self, context: GuessingContext, preset: Mapping[str, Sequence[str]], folder: CaseFolder
    ) -> None:
        self.unknown: set[str] = set()
        self._guesses = context
        super().__init__(context, preset, folder)

    def text(self, name: str) -> str:
        """Return what ``${name}`` stands for, or a guess."""
        if name in self.unknown:
            return f"{self._guesses.guess():g}"
        try:
            return super().text(name)
        except FormulaError:
            if self._guesses.guessed:
                return f"{self._guesses.guess():g}"
            raise

    def immediate(self, formula: str) -> str:
        """Return what ``$(formula)`` stands for, or a guess."""
        try:
            return super().immediate(formula)
        except FormulaError:
            if self._guesses.guessed:
                return f"{self._guesses.guess():g}"
            raise

    def value(self, name: str) -> float:
        """Return an equal-style variable, or a guess."""
        return self._guesses.guess() if name in self.unknown else super().value(name)

    def style(self, name: str) -> str:
        """Return the style of a variable."""
        return "equal" if name in self.unknown and name not in self else super().style(name)

    def forget_lists(self) -> None:
        """Count no further: of all lists it is unknown from now on where they stand."""
        self.unknown.update(name for name, one in self._known.items() if one.style in LISTS)
