"""Rehearsal: a script is gone through as it will be executed, as far as that can be known."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

from minidem.errors import DemError, InputError, ScriptError
from minidem.files import nothing_written
from minidem.record import record
from minidem.script.case.shell import Shell
from minidem.script.check.finding import Finding
from minidem.script.check.guessing import GuessingContext, GuessingVariables
from minidem.script.check.notes import Notes
from minidem.script.conditions import condition_holds
from minidem.script.context import Context
from minidem.script.control import ControlFlow, Hooks
from minidem.script.lexer import Command
from minidem.script.paths import CaseFolder
from minidem.script.substitute import substitute

__all__ = ["Rehearsal", "Stage"]

MOST_COMMANDS = 100_000
"""Commands that are rehearsed; what comes later is found when it is reached."""
MOST_JUMPS = 30
"""How often a line jumps before its loop is taken as one of unknown length."""


@record(frozen=True)
class Stage:
    """Where a script is rehearsed.

    Attributes
    ----------
    root : CaseFolder
        Folder of the case; nothing in it is changed.
    known : frozenset of str
        Command words of the engine.
    context : Context
        Answers the questions of formulas that do not depend on a run.
    keywords : collection of str or None
        Thermo keywords there are; None if that is not known.
    strict : bool
        Refuse ``shell`` lines that would be skipped.
    """

    root: CaseFolder
    known: frozenset[str]
    context: Context
    keywords: Collection[str] | None = None
    strict: bool = False


class Rehearsal(ControlFlow):
    """Goes through a script without running it and without writing anything.

    Conditions, loops and file names that follow from the script alone are followed; where a
    condition depends on the simulation all branches are looked at. Values that depend on it are
    guessed, and of lines with a guess only unknown words are reported.

    Parameters
    ----------
    stage : Stage
        Where it is rehearsed.
    preset : mapping of str to sequence of str
        Values from the command line.

    Attributes
    ----------
    root : CaseFolder
        Where the script stands.
    variables : GuessingVariables
        The variables of the rehearsal.

    Raises
    ------
    FormulaError
        If a value of the command line is no variable.
    """

    def __init__(self, stage: Stage, preset: Mapping[str, Sequence[str]]) -> None:
        self._context = GuessingContext(stage.context, stage.keywords)
        self._notes = Notes()
        self.root = root = CaseFolder(stage.root.top, stage.root.here)
        self.variables = GuessingVariables(self._context, preset, root)
        super().__init__(root, self.variables, stage.known, Hooks())
        self._shell = Shell(root, self._skipped, stage.strict, idle=True)

    def find(self, script: Path, execute: Callable[[Command], None]) -> list[Finding]:
        """Rehearse a script; `execute` tries the engine's commands. Return what was found."""
        try:
            with nothing_written():
                self.run(script, execute)
        except ScriptError as err:
            self._notes.add(err, "", guessed=False)
        return self._notes.findings

    def line(self, text: str) -> None:
        """Rehearse one line; mistakes are noted."""
        self._context.guessed = False
        self._notes.words = ()
        try:
            super().line(text)
        except ScriptError as err:
            self._note(err, text)
        except DemError as err:
            fault = self.error(str(err))
            fault.__cause__ = err
            self._note(fault, text)

    def _note(self, error: ScriptError, text: str) -> None:
        lost = self._notes.add(error, text, guessed=self._context.guessed)
        if lost:
            self.variables.unknown.add(lost)

    def _command(self, name: str, args: tuple[str, ...]) -> None:
        self._notes.follow((name, *args))
        self._context.steps_known = self._notes.steps_known
        super()._command(name, args)

    def _skipped(self, text: str) -> None:
        found = Finding(self.error(text), text, "shell", certain=self._notes.certain, skipped=True)
        self._notes.findings.append(found)

    # -- control flow ----------------------------------------------------------------------------

    def _count(self) -> None:
        self._state.commands += 1
        if self._state.commands > MOST_COMMANDS:
            self._state.quit = True

    def _variable(self, args: tuple[str, ...]) -> None:
        super()._variable(args)
        if self._context.guessed or not self._notes.certain:
            self.variables.unknown.update(args[:1])
        else:
            self.variables.unknown.difference_update(args[:1])

    def _next(self, args: tuple[str, ...]) -> None:
        if self._notes.certain and not set(args) & self.variables.unknown:
            super()._next(args)

    def _jump(self, args: tuple[str, ...]) -> None:
        notes, place = self._notes, (self._state.file, self._state.line)
        if not notes.certain or self._context.guessed:
            self._state.skip_jump = False
            notes.ahead.update(label for label in args[1:] if self._is_ahead(label))
            return
        if notes.texts.intersection(args[:1]):
            notes.blind = True
            return
        if not self._state.skip_jump:
            notes.jumps[place] = notes.jumps.get(place, 0) + 1
            if notes.jumps[place] == MOST_JUMPS:
                notes.steps_known = False
                self.variables.forget_lists()
            elif notes.jumps[place] > MOST_JUMPS:
                return
        super()._jump(args)

    def _is_ahead(self, label: str) -> bool:
        """Tell whether a label stands below the present line."""
        frame = self._state.frames[-1]
        return any(one.text.split() == ["label", label] for one in frame.lines[frame.at :])

    def _label(self, args: tuple[str, ...]) -> None:
        super()._label(args)
        self._notes.ahead.difference_update(args)

    def _end_of_file(self) -> None:
        self._notes.ahead.clear()
        super()._end_of_file()

    def _quit(self, args: tuple[str, ...]) -> None:
        if self._notes.certain:
            super()._quit(args)

    def _include(self, args: tuple[str, ...]) -> None:
        if self._context.guessed or self._notes.texts.intersection(args):
            self._notes.blind = True  # nobody knows what will be in this file
        else:
            super()._include(args)

    def _if(self, args: tuple[str, ...]) -> None:
        before, self._notes.doubtful = self._notes.doubtful, False
        try:
            super()._if(args)
        finally:
            self._notes.doubtful = before

    def _take(self, condition: str | None, commands: tuple[str, ...]) -> bool:
        notes = self._notes
        self._context.guessed = False
        if condition is not None and not self._may_hold(condition):
            return False
        notes.doubtful = notes.doubtful or self._context.guessed
        if not notes.doubtful:
            self._branch(commands)
            return True
        with self._doubting():
            self._branch(commands)
        return False

    def _may_hold(self, condition: str) -> bool:
        try:
            holds = condition_holds(substitute(condition, self.variables))
        except InputError:
            if not self._context.guessed:
                raise
            return True
        return holds or self._context.guessed

    @contextmanager
    def _doubting(self) -> Iterator[None]:
        """Look at commands that may not be executed."""
        self._notes.doubt += 1
        label = self._state.label
        try:
            yield
        finally:
            self._notes.doubt -= 1
            self._state.label = label
            self._state.skip_jump = False
