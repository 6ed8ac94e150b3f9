"""The front door of the script language: an interpreter for one script."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from minidem.errors import ScriptError
from minidem.script.check.finding import refusal
from minidem.script.check.rehearsal import Rehearsal, Stage
from minidem.script.context import Context
from minidem.script.control import MAX_COMMANDS, ControlFlow, Hooks
from minidem.script.formula import FormulaError
from minidem.script.lexer import Command
from minidem.script.paths import CaseFolder
from minidem.script.substitute import substitute
from minidem.script.variables import Variables

__all__ = ["MAX_COMMANDS", "Hooks", "Interpreter"]


class Interpreter:
    """Reads a script and hands its commands to the engine.

    Parameters
    ----------
    script : Path
        The script file.
    root : Path or CaseFolder
        Folder that the script may read and write.
    variables : mapping of str to sequence of str
        Values given on the command line.
    context : Context
        What formulas may ask.
    known : collection of str
        Command words of the engine.
    hooks : Hooks, optional
        Callbacks for printed and echoed lines and for early checks.
    """

    def __init__(
        self,
        script: Path,
        *,
        root: Path | CaseFolder,
        variables: Mapping[str, Sequence[str]],
        context: Context,
        known: Collection[str] | Mapping[str, object],
        hooks: Hooks | None = None,
    ) -> None:
        self._script = Path(script)
        self._root = root if isinstance(root, CaseFolder) else CaseFolder(root)
        self._known = frozenset(known)
        self._hooks = hooks or Hooks()
        self._context = context
        self._preset = variables
        try:
            self._variables = Variables(context, variables, self._root, self._hooks.warn)
        except FormulaError as err:
            raise ScriptError(str(script), 0, f"-var: {err}") from err
        self._flow = ControlFlow(self._root, self._variables, self._known, self._hooks)

    def check(self) -> None:
        """Go through the script as far as it follows from itself, and refuse unknown words.

        Raises
        ------
        ScriptError
            At the first mistake that will certainly be met; it names the others too.
        """
        stage = Stage(self._root, self._known, self._context, strict=self._hooks.strict)
        rehearsal = Rehearsal(stage, self._preset)
        error = refusal(rehearsal.find(self._script, self._hooks.check_style or _accept))
        if error is not None:
            raise error

    def run(self, execute: Callable[[Command], None]) -> None:
        """Execute the script.

        Parameters
        ----------
        execute : callable
            Called with every command that is not control flow.

        Raises
        ------
        ScriptError
            With file and line.
        """
        self._flow.run(self._script, execute)

    def execute_line(self, text: str) -> None:
        """Parse and execute one line at the present place, as ``run N every M "..."`` needs."""
        self._flow.line(text)

    def substitute(self, text: str) -> str:
        """Replace the variables in a text now, as ``fix print`` needs."""
        try:
            return substitute(text, self._variables)
        except FormulaError as err:
            raise self._flow.error(str(err)) from err

    def value(self, name: str) -> float:
        """Return the value of an equal-style variable now."""
        try:
            return self._variables.value(name)
        except FormulaError as err:
            raise self._flow.error(str(err)) from err

    def atom_values(self, name: str) -> NDArray[np.float64]:
        """Return an atom-style variable now, one value per particle, shape (N,)."""
        try:
            return self._variables.atom_values(name)
        except FormulaError as err:
            raise self._flow.error(str(err)) from err

    def variable_style(self, name: str) -> str | None:
        """Return the style of a variable, None if there is none of that name."""
        return self._variables.style(name) if name in self._variables else None

    def variable_styles(self) -> dict[str, str]:
        """Return the styles of all variables by name, in the order of their definition."""
        return {name: self._variables.style(name) for name in self._variables.names()}


def _accept(command: Command) -> None:
    del command
