"""Variables of a script."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import cast

import numpy as np
from numpy.typing import NDArray

from minidem.errors import suggest
from minidem.record import record, replace
from minidem.script.case.values import atom_sets, atom_values_of, environment, single_values
from minidem.script.context import Context
from minidem.script.evaluate import Evaluator
from minidem.script.formula import WORD, FormulaError, NoValueError, number_of
from minidem.script.operators import Value
from minidem.script.paths import CaseFolder, inside

__all__ = ["Variable", "Variables"]

STYLES = (
    "equal", "atom", "string", "getenv", "index", "loop", "world", "universe", "uloop", "file",
    "atomfile", "delete",
)  # fmt: skip
LISTS = ("index", "loop", "universe", "uloop", "file", "atomfile")
"""Styles of variables that ``next`` moves on."""
_TOGETHER = {"uloop": "universe"}  # styles that one ``next`` may mix
_PER_ATOM = ("atom", "atomfile")
_COUNTED = ("loop", "uloop")
MAX_NESTING = 30
"""How deep variables may refer to variables."""
MAX_LOOP = 2_147_483_647


@record(frozen=True)
class Variable:
    """One variable.

    Attributes
    ----------
    style : str
        ``equal``, ``atom``, ``index``, ``loop`` or another of `STYLES`.
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
        ``index`` definition in the script does not replace them. The style ``getenv`` takes its
        values from here, too.
    folder : CaseFolder, optional
        Folder of the files that the styles ``file`` and ``atomfile`` name; none can be read
        without.
    warn : callable
        Takes a warning.
    """

    def __init__(
        self, context: Context, preset: Mapping[str, Sequence[str]],
        folder: CaseFolder | None = None, warn: Callable[[str], object] = len,
    ) -> None:  # fmt: skip
        self._preset = preset
        self._folder = folder
        self._warn = warn
        self._known: dict[str, Variable] = {}
        self._evaluator = Evaluator(context, self._nested)
        self._context = context
        self._open: list[str] = []
        for name, values in preset.items():
            self.define((name, "index", *values))

    def __contains__(self, name: str) -> bool:
        """Tell whether a variable exists."""
        return name in self._known

    def names(self) -> tuple[str, ...]:
        """Return the names of all variables."""
        return tuple(self._known)

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
        elif style in (*LISTS, "world"):
            # A list is defined once; a preset of the command line wins.
            if old is None:
                self._known[name] = self._list(name, style, values)
        elif style == "getenv" and name in self._preset:
            pass  # what the environment would say is on the command line
        else:
            self._redefine(name, style, values, old)

    def _list(self, name: str, style: str, values: tuple[str, ...]) -> Variable:
        """Return a new variable of a style that has several values."""
        if style in ("loop", "uloop"):
            return _loop(name, style, values)
        if style in ("file", "atomfile"):
            if len(values) != 1 or self._folder is None:
                msg = f"variable {name} {style} needs one file"
                raise FormulaError(msg)
            if style == "atomfile":
                self._context.need_map()
            read = single_values if style == "file" else atom_sets
            return Variable(style, read(inside(self._folder, values[0])))
        if style == "world" and len(values) != 1:
            msg = f"variable {name} world: there is one partition, so it needs one value"
            raise FormulaError(msg)
        return _index(name, style, values)

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
        if style == "getenv":
            values = (environment(self._preset, name, values[0], self._warn),)
        self._known[name] = Variable(style, values)

    def advance(self, names: tuple[str, ...]) -> bool:
        """Carry out a ``next`` command; True if a list is used up (the variable is then gone)."""
        if not names:
            msg = "next needs the name of a variable"
            raise FormulaError(msg)
        styles = {self._find(name).style for name in names}
        together = {_TOGETHER.get(style, style) for style in styles}
        if len(together) > 1 or not styles.issubset(LISTS):
            msg = (
                f"next works on variables of one style, such as index or loop, not {sorted(styles)}"
            )
            raise FormulaError(msg)
        done = False
        for name in names:
            old = self._find(name)
            end = old.last if old.style in _COUNTED else len(old.values) - 1
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
        if variable.style in _PER_ATOM:
            msg = f"variable {name} has one value per particle and cannot be substituted"
            raise FormulaError(msg)
        if variable.style in _COUNTED:
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
        return number_of(name, self.text(name))

    def atom_values(self, name: str) -> NDArray[np.float64]:
        """Return a variable as one value per particle, shape (N,)."""
        variable = self._find(name)
        per_atom = variable.style in _PER_ATOM
        value = self._per_atom(name, variable) if per_atom else self.value(name)
        count = self._context.atom_vector("id").shape[0]
        return np.broadcast_to(np.asarray(value, dtype=np.float64), (count,)).copy()

    def style(self, name: str) -> str:
        """Return the style of a variable."""
        return self._find(name).style

    def _find(self, name: str) -> Variable:
        if name not in self._known:
            msg = f"unknown variable '{name[:40]}'{suggest(name[:80], self._known)}"
            raise NoValueError(msg)
        return self._known[name]

    def _nested(self, name: str, per_atom: bool) -> Value:
        """Return a variable used in a formula.

        LIGGGHTS passes the 15-digit text of an equal-style variable on, not its full value.
        """
        variable = self._find(name)
        if variable.style in _PER_ATOM:
            if not per_atom:
                msg = f"variable {name} has one value per particle; use it in one of style atom"
                raise FormulaError(msg)
            return self._per_atom(name, variable)
        return number_of(name, self.text(name))

    def _per_atom(self, name: str, variable: Variable) -> Value:
        """Return a variable that has one value per particle."""
        if variable.style == "atom":
            return self._number(name, variable, per_atom=True)
        found = atom_values_of(variable.values[variable.at])
        ids = self._context.atom_vector("id").tolist()
        return np.array([found.get(int(number), 0.0) for number in ids], dtype=np.float64)

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
            raise type(err)(msg) from err
        finally:
            self._open.pop()


def _check_definition(name: str, style: str) -> None:
    if not name or not set(name) <= WORD:
        msg = f"variable name '{name[:40]}' may only have letters, digits and underscores"
        raise FormulaError(msg)
    if style not in STYLES:
        msg = f"unknown variable style '{style[:40]}'{suggest(style[:80], STYLES)}"
        raise FormulaError(msg)


def _index(name: str, style: str, values: tuple[str, ...]) -> Variable:
    if not values:
        msg = f"variable {name} {style} needs at least one value"
        raise FormulaError(msg)
    return Variable(style, values)


def _loop(name: str, style: str, values: tuple[str, ...]) -> Variable:
    pad = values[-1:] == ("pad",)
    numbers = values[:-1] if pad else values
    try:
        bounds = [int(number) for number in numbers]
    except ValueError:
        bounds = []
    if len(bounds) == 1:
        bounds = [1, *bounds]
    elif style == "uloop":
        bounds = []
    if len(bounds) != 2 or not -MAX_LOOP <= bounds[0] <= bounds[1] <= MAX_LOOP or bounds[1] < 0:
        msg = f"variable {name} {style} needs N or FIRST LAST [pad], got '{' '.join(values)[:60]}'"
        raise FormulaError(msg)
    digits = len(str(bounds[1])) if pad else 0
    return Variable(style, (), bounds[0], bounds[1], digits)
