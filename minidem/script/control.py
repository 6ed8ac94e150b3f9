"""Execution of a script, line by line: control flow here, everything else by the engine.

Handled here are ``variable``, ``if``, ``jump``, ``label``, ``next``, ``include``, ``print`` and
``quit``; ``shell`` does what needs no program. All other commands go to the engine.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NoReturn

from minidem.errors import InputError, ScriptError, UnknownWordError
from minidem.record import field, record
from minidem.script.case.shell import Shell
from minidem.script.conditions import condition_holds
from minidem.script.lexer import Command, SourceLine, read_lines, split_words, strip_comment
from minidem.script.names import unknown
from minidem.script.paths import CaseFolder, inside
from minidem.script.printing import print_text
from minidem.script.substitute import refuse_template, substitute
from minidem.script.variables import Variables

__all__ = ["CONTROL", "MAX_COMMANDS", "ControlFlow", "Hooks"]

MAX_COMMANDS = 1_000_000
"""Commands one run of a script may execute; a loop that never ends stops there."""
MAX_INCLUDES = 50
"""How deep files may include files."""


def _ignore(text: str) -> None:
    del text


@record(frozen=True)
class Hooks:
    """Optional callbacks of the interpreter.

    Attributes
    ----------
    emit : callable
        Receives a line that ``print`` writes to screen and log.
    echo : callable
        Receives every line as read, and again after each substitution, as LIGGGHTS logs it.
    warn : callable
        Receives a warning.
    strict : bool
        Refuse ``shell`` lines that would be skipped.
    check_style : callable or None
        Called by `Interpreter.check` with every engine command that will be executed, so that
        unknown styles are refused before the first step. It raises ScriptError.
    """

    emit: Callable[[str], None] = _ignore
    echo: Callable[[str], None] = _ignore
    warn: Callable[[str], None] = _ignore
    strict: bool = False
    check_style: Callable[[Command], None] | None = None


@record
class _Frame:
    """A file being read."""

    path: Path
    name: str
    lines: tuple[SourceLine, ...]
    at: int = 0


@record
class _State:
    """Where the interpreter stands."""

    frames: list[_Frame] = field(default_factory=list)
    label: str | None = None
    asked: tuple[str, int] = ("", 0)
    skip_jump: bool = False
    if_depth: int = 0
    commands: int = 0
    quit: bool = False
    file: str = ""
    line: int = 0


class ControlFlow:
    """Executes the lines of a script and of the files it includes.

    Parameters
    ----------
    root : CaseFolder
        Folder that the script may read and write.
    variables : Variables
        The variables of the run.
    known : frozenset of str
        Command words of the engine.
    hooks : Hooks
        Where printed and echoed lines go.
    """

    def __init__(
        self, root: CaseFolder, variables: Variables, known: frozenset[str], hooks: Hooks
    ) -> None:
        self._root = root
        self._shell = Shell(root, hooks.warn, hooks.strict)
        self._known = known
        self._hooks = hooks
        self._variables = variables
        self._state = _State()
        self._files: dict[Path, tuple[SourceLine, ...]] = {}
        self._execute: Callable[[Command], None] | None = None

    def run(self, script: Path, execute: Callable[[Command], None]) -> None:
        """Execute a script from its first line; `execute` receives the engine's commands."""
        self._execute = execute
        self._state = state = _State(file=str(script))
        try:
            state.frames.append(self._open(script, str(script)))
        except InputError as err:
            raise self.error(str(err)) from err
        while state.frames and not state.quit:
            frame = state.frames[-1]
            state.file = frame.name
            if frame.at >= len(frame.lines):
                self._end_of_file()
                continue
            line = frame.lines[frame.at]
            frame.at += 1
            state.line = line.number
            self.line(line.text)

    def error(self, message: str) -> ScriptError:
        """Return an error at the present place."""
        return ScriptError(self._state.file, self._state.line, message)

    def _fail(self, message: str) -> NoReturn:
        raise self.error(message)

    def _open(self, path: Path, name: str) -> _Frame:
        if path not in self._files:
            self._files[path] = read_lines(path)
        return _Frame(path, name, self._files[path])

    def _end_of_file(self) -> None:
        state = self._state
        if state.label is not None:
            msg = f"label '{state.label[:60]}' is not in the script"
            raise ScriptError(*state.asked, msg)
        state.frames.pop()

    def line(self, text: str) -> None:
        """Parse and execute one line."""
        state = self._state
        if state.label is None:
            self._hooks.echo(text)
        try:
            line = strip_comment(text)
            if state.label is None:
                refuse_template(line)
                line = substitute(line, self._variables, self._hooks.echo)
            words = split_words(line)
            if not words or (state.label is not None and words[0] != "label"):
                return
            self._count()
            self._command(words[0], tuple(words[1:]))
        except InputError as err:
            raise self.error(str(err)) from err

    def _count(self) -> None:
        self._state.commands += 1
        if self._state.commands > MAX_COMMANDS:
            msg = f"more than {MAX_COMMANDS} commands executed; does a loop of jumps ever end?"
            self._fail(msg)

    def _command(self, name: str, args: tuple[str, ...]) -> None:
        handler = CONTROL_HANDLERS.get(name)
        if handler is not None:
            getattr(self, handler)(args)
            return
        if name not in self._known:
            raise UnknownWordError(unknown("command", name, [*self._known, *CONTROL]))
        if self._execute is not None:
            self._execute(Command(name, args, self._state.file, self._state.line))

    def _variable(self, args: tuple[str, ...]) -> None:
        self._variables.define(args)

    def _next(self, args: tuple[str, ...]) -> None:
        if self._variables.advance(args):
            self._state.skip_jump = True

    def _label(self, args: tuple[str, ...]) -> None:
        if len(args) != 1:
            self._fail("label needs one name")
        if self._state.label == args[0]:
            self._state.label = None

    def _jump(self, args: tuple[str, ...]) -> None:
        state = self._state
        if not 1 <= len(args) <= 2:
            self._fail("jump needs a file (or SELF) and perhaps a label")
        if state.skip_jump:
            state.skip_jump = False
            return
        if not state.frames:
            self._fail("jump is not possible here")
        if args[0] == "SELF":
            state.frames[-1].at = 0
        else:
            state.frames[-1] = self._open(inside(self._root, args[0]), args[0])
        # A loop of jumps without commands between must end too.
        self._count()
        state.label = args[1] if len(args) == 2 else None
        state.asked = (state.file, state.line)

    def _include(self, args: tuple[str, ...]) -> None:
        if len(args) != 1:
            self._fail("include needs one file")
        if self._state.if_depth:
            self._fail("include cannot be used within an if command")
        if len(self._state.frames) >= MAX_INCLUDES:
            self._fail(f"files include files more than {MAX_INCLUDES} levels deep")
        self._state.frames.append(self._open(inside(self._root, args[0]), args[0]))

    def _print(self, args: tuple[str, ...]) -> None:
        if not args:
            self._fail("print needs a text")
        text = substitute(args[0], self._variables)
        print_text(text, args[1:], self._root, self._hooks.emit)

    def _quit(self, args: tuple[str, ...]) -> None:
        if args:
            self._fail("quit takes no argument")
        self._state.quit = True

    def _run_shell(self, args: tuple[str, ...]) -> None:
        self._shell.run(args)

    def _if(self, args: tuple[str, ...]) -> None:
        """Find the first branch whose condition holds and execute its commands."""
        if len(args) < 3 or args[1] != "then":
            self._fail('if needs: if "CONDITION" then "COMMAND" ... [elif ...] [else ...]')
        if self._state.if_depth >= MAX_INCLUDES:
            self._fail(f"if commands are nested more than {MAX_INCLUDES} levels deep")
        condition: str | None = args[0]
        at = 2
        while True:
            stop = at
            while stop < len(args) and args[stop] not in ("elif", "else"):
                stop += 1
            if self._take(condition, args[at:stop]):
                return
            if stop == len(args):
                return
            if stop + 2 > len(args):
                self._fail(f"'{args[stop]}' needs a condition or a command after it")
            is_elif = args[stop] == "elif"
            condition = args[stop + 1] if is_elif else None
            at = stop + 2 if is_elif else stop + 1

    def _take(self, condition: str | None, commands: tuple[str, ...]) -> bool:
        """Execute a branch if its condition holds; tell whether it did."""
        if condition is not None and not condition_holds(substitute(condition, self._variables)):
            return False
        self._branch(commands)
        return True

    def _branch(self, commands: tuple[str, ...]) -> None:
        if not commands or "" in commands:
            self._fail("a branch of if needs at least one command, quoted")
        self._state.if_depth += 1
        try:
            for command in commands:
                self.line(command)
                if self._state.quit:
                    return
        finally:
            self._state.if_depth -= 1


CONTROL_HANDLERS = {
    "variable": "_variable",
    "next": "_next",
    "label": "_label",
    "jump": "_jump",
    "include": "_include",
    "print": "_print",
    "quit": "_quit",
    "shell": "_run_shell",
    "if": "_if",
}
CONTROL = tuple(CONTROL_HANDLERS)
"""Command words of the interpreter itself."""
