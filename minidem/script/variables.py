"""Variables of a script."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import cast

import numpy as np
from numpy.typing import NDArray

from minidem.errors import suggest
from minidem.script.context import Context
from minidem.script.evaluate import Evaluator
from minidem.script.formula import WORD, FormulaError
from minidem.script.operators import Value

__all__ = ["Variable", "Variables"]

STYLES = ("equal", "atom", "string", "index", "loop", "delete")
REFUSED = {
    "getenv": "a script is data and may not read the environment; pass the value with -var",
    "world": "there is only one partition; use style index",
    "universe": "there is only one partition; use style index",
    "uloop": "there is only one partition; use style loop",
    "file": "use style index with the values in the script",
    "atomfile": "use style atom with a formula",
}
MAX_NESTING = 30
"""How deep variables may refer to variables."""
MAX_LOOP = 2_147_483_647


@dataclass(frozen=True)
class Variable:
    """One variable.

    Attributes
    ----------
    style : str
        ``equal``, ``atom``, ``string``, ``index`` or ``loop``.
    values : tuple of str
        Formula, text or list of values; empty for a loop.
    at : int
        Present position: index into `values`, or the present number of a loop.
    last : int
        Last number of a loop.
    pad : int
        Digits a loop number is padded to, 0 for none.
    """

    style: str
    values: tuple[str, ...] = ()
    at: int = 0
    last: int = 0
    pad: int = 0


class Variables:
    """All variables of a run and their evaluation.

    Parameters
    ----------
    context : Context
        The simulation that formulas ask.
    preset : mapping
        Values from the command line; as in LIGGGHTS they are index variables, so that an
        ``index`` definition in the script does not replace them.
    """

    def __init__(self, context: Context, preset: Mapping[str, Sequence[str]]) -> None:
        self._known: dict[str, Variable] = {}
        self._evaluator = Evaluator(context, self._nested)
        self._context = context
        self._open: list[str] = []
        for name, values in preset.items():
            self.define((name, "index", *values))

    def __contains__(self, name: str) -> bool:
        """Tell whether a variable exists."""
        return name in self._known

    def define(self, args: tuple[str, ...]) -> None:
        """Carry out a ``variable`` command.

        Parameters
        ----------
        args : tuple of str
            Name, style and values.

        Raises
        ------
        FormulaError
            With what was expected.
        """
        if len(args) < 2:
            msg = "variable needs a name and a style: variable NAME equal FORMULA"
            raise FormulaError(msg)
        name, style, values = args[0], args[1], args[2:]
        _check_definition(name, style)
        old = self._known.get(name)
        if style == "delete":
            self._known.pop(name, None)
        elif style in ("index", "loop"):
            # A list is defined once; a preset of the command line wins.
            if old is None:
                self._known[name] = (
                    _index(name, values) if style == "index" else _loop(name, values)
                )
        else:
            self._redefine(name, style, values, old)

    def _redefine(
        self, name: str, style: str, values: tuple[str, ...], old: Variable | None
    ) -> None:
        if len(values) != 1:
            msg = f"variable {name} {style} takes one value, got {len(values)}; quote it"
            raise FormulaError(msg)
        if old is not None and old.style != style:
            msg = (
                f"variable {name} has style {old.style} and cannot become {style}; delete it first"
            )
            raise FormulaError(msg)
        self._known[name] = Variable(style, values)

    def advance(self, names: tuple[str, ...]) -> bool:
        """Carry out a ``next`` command; True if a list is used up (the variable is then gone)."""
        if not names:
            msg = "next needs the name of a variable"
            raise FormulaError(msg)
        styles = {self._find(name).style for name in names}
        if len(styles) > 1 or not styles <= {"index", "loop"}:
            msg = f"next works on variables of one style, index or loop, not {sorted(styles)}"
            raise FormulaError(msg)
        done = False
        for name in names:
            old = self._find(name)
            end = old.last if old.style == "loop" else len(old.values) - 1
            if old.at >= end:
                done = True
                del self._known[name]
            else:
                self._known[name] = replace(old, at=old.at + 1)
        return done

    def text(self, name: str) -> str:
        """Return what ``${name}`` stands for; equal-style values have 15 digits."""
        variable = self._find(name)
        if variable.style == "equal":
            return f"{self._number(name, variable, per_atom=False):.15g}"
        if variable.style == "atom":
            msg = f"variable {name} has one value per particle and cannot be substituted"
            raise FormulaError(msg)
        if variable.style == "loop":
            return str(variable.at).zfill(variable.pad)
        return variable.values[variable.at]

    def immediate(self, formula: str) -> str:
        """Return what ``$(formula)`` stands for; it has 20 digits."""
        return f"{self._evaluator.evaluate(formula, nested=bool(self._open)):.20g}"

    def value(self, name: str) -> float:
        """Return an equal-style variable (or the number a list variable stands for) now."""
        variable = self._find(name)
        if variable.style == "equal":
            return float(cast(float, self._number(name, variable, per_atom=False)))
        return _number_of(name, self.text(name))

    def atom_values(self, name: str) -> NDArray[np.float64]:
        """Return a variable as one value per particle, shape (N,)."""
        variable = self._find(name)
        per_atom = variable.style == "atom"
        value = self._number(name, variable, per_atom=True) if per_atom else self.value(name)
        count = self._context.atom_vector("id").shape[0]
        return np.broadcast_to(np.asarray(value, dtype=np.float64), (count,)).copy()

    def style(self, name: str) -> str:
        """Return the style of a variable."""
        return self._find(name).style

    def _find(self, name: str) -> Variable:
        if name not in self._known:
            msg = f"unknown variable '{name[:40]}'{suggest(name[:80], self._known)}"
            raise FormulaError(msg)
        return self._known[name]

    def _nested(self, name: str, per_atom: bool) -> Value:
        """Return a variable used in a formula.

        LIGGGHTS passes the 15-digit text of an equal-style variable on, not its full value.
        """
        variable = self._find(name)
        if variable.style == "atom":
            if not per_atom:
                msg = (
                    f"variable {name} has one value per particle; use it in an atom-style variable"
                )
                raise FormulaError(msg)
            return self._number(name, variable, per_atom=True)
        return _number_of(name, self.text(name))

    def _number(self, name: str, variable: Variable, *, per_atom: bool) -> Value:
        if name in self._open:
            chain = " -> ".join([*self._open, name])
            msg = f"variables refer to each other in a circle: {chain[:200]}"
            raise FormulaError(msg)
        if len(self._open) >= MAX_NESTING:
            msg = f"variables refer to variables more than {MAX_NESTING} levels deep"
            raise FormulaError(msg)
        nested = bool(self._open)
        self._open.append(name)
        try:
            return self._evaluator.evaluate(variable.values[0], per_atom=per_atom, nested=nested)
        except FormulaError as err:
            if nested:
                raise
            msg = f"variable {name}: {err}"
            raise FormulaError(msg) from err
        finally:
            self._open.pop()


def _check_definition(name: str, style: str) -> None:
    if not name or not set(name) <= WORD:
        msg = f"variable name '{name[:40]}' may only have letters, digits and underscores"
        raise FormulaError(msg)
    if style in REFUSED:
        msg = f"variable style '{style}' is refused: {REFUSED[style]}"
        raise FormulaError(msg)
    if style not in STYLES:
        msg = f"unknown variable style '{style[:40]}'{suggest(style[:80], STYLES)}"
        raise FormulaError(msg)


def _index(name: str, values: tuple[str, ...]) -> Variable:
    if not values:
        msg = f"variable {name} index needs at least one value"
        raise FormulaError(msg)
    return Variable("index", values)


def _loop(name: str, values: tuple[str, ...]) -> Variable:
    pad = values[-1:] == ("pad",)
    numbers = values[:-1] if pad else values
    try:
        bounds = [int(number) for number in numbers]
    except ValueError:
        bounds = []
    if len(bounds) == 1:
        bounds = [1, *bounds]
    if len(bounds) != 2 or not -MAX_LOOP <= bounds[0] <= bounds[1] <= MAX_LOOP or bounds[1] < 0:
        msg = f"variable {name} loop needs N or FIRST LAST [pad], got '{' '.join(values)[:60]}'"
        raise FormulaError(msg)
    digits = len(str(bounds[1])) if pad else 0
    return Variable("loop", (), bounds[0], bounds[1], digits)


def _number_of(name: str, text: str) -> float:
    try:
        return float(text.replace("_", "?"))
    except ValueError as err:
        msg = f"variable {name} is '{text[:40]}', which is not a number"
        raise FormulaError(msg) from err
