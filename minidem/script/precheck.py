"""Reading a whole script before anything is executed."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass, field
from pathlib import Path

from minidem.errors import InputError, ScriptError, suggest
from minidem.script.lexer import Command, read_lines, split_words, strip_comment
from minidem.script.names import unknown
from minidem.script.paths import CaseFolder, inside

__all__ = ["CONTROL", "check_script"]

CONTROL = ("variable", "next", "label", "jump", "include", "print", "quit", "if", "shell")
"""Command words of the interpreter itself."""


@dataclass
class _Check:
    root: CaseFolder
    known: Collection[str]
    hook: Callable[[Command], None] | None
    seen: set[Path] = field(default_factory=set)
    pending: list[tuple[Path, str, str, int]] = field(default_factory=list)


def check_script(
    script: Path, root: CaseFolder, known: Collection[str], hook: Callable[[Command], None] | None
) -> None:
    """Check every command word of a script and of the files it names.

    Parameters
    ----------
    script : Path
        The script.
    root : CaseFolder
        Folder of included files.
    known : collection of str
        Command words of the engine.
    hook : callable or None
        Called with each engine command, arguments as written.

    Raises
    ------
    ScriptError
        At the first unknown word, missing file or label, or broken quote.

    Notes
    -----
    A command word that is itself a variable cannot be checked here; it is when it is executed.
    Commands after an unconditional ``quit`` are never reached and not checked.
    """
    state = _Check(root, known, hook, pending=[(script, str(script), str(script), 0)])
    while state.pending:
        path, name, by, line = state.pending.pop()
        if path not in state.seen:
            state.seen.add(path)
            _check_file(state, path, name, (by, line))


def _check_file(state: _Check, path: Path, name: str, origin: tuple[str, int]) -> None:
    try:
        lines = read_lines(path)
    except InputError as err:
        raise ScriptError(*origin, str(err)) from err
    labels: set[str] = set()
    wanted: dict[str, int] = {}
    for line in lines:
        words = _words(line.text, name, line.number)
        if not words:
            continue
        command = Command(words[0], tuple(words[1:]), name, line.number)
        _check_command(state, command)
        if command.name == "label" and len(command.args) == 1:
            labels.add(command.args[0])
        if command.name == "jump" and command.args[:1] == ("SELF",) and len(command.args) == 2:
            wanted.setdefault(command.args[1], line.number)
        if command.name == "quit":
            break
    if not any("$" in label for label in labels):
        for label, number in wanted.items():
            if label not in labels and "$" not in label:
                hint = suggest(label, labels)
                raise ScriptError(name, number, f"label '{label[:60]}' is not in the script{hint}")


def _words(text: str, name: str, number: int) -> list[str]:
    try:
        return split_words(strip_comment(text))
    except InputError as err:
        # Substitution may still change what is quoted; only plain lines are certain.
        if "$" in text:
            return []
        raise ScriptError(name, number, str(err)) from err


def _check_command(state: _Check, command: Command, depth: int = 0) -> None:
    word = command.name
    if "$" in word:
        return
    if word == "if":
        _check_branches(state, command, depth)
    elif word in ("include", "jump"):
        _follow(state, command)
    elif word not in CONTROL:
        if word not in state.known:
            msg = unknown("command", word, [*state.known, *CONTROL])
            raise ScriptError(command.file, command.line, msg)
        if state.hook is not None:
            state.hook(command)


def _check_branches(state: _Check, command: Command, depth: int) -> None:
    """Check the command words in the branches of an if."""
    for i, text in enumerate(command.args):
        if i < 2 or text in ("elif", "else") or command.args[i - 1] == "elif" or depth > 20:
            continue
        words = _words(text, command.file, command.line)
        if words and words[0] != "quit":
            inner = Command(words[0], tuple(words[1:]), command.file, command.line)
            _check_command(state, inner, depth + 1)


def _follow(state: _Check, command: Command) -> None:
    """Queue the file that an include or jump names."""
    if not command.args or "$" in command.args[0] or command.args[0] == "SELF":
        return
    try:
        path = inside(state.root, command.args[0])
    except InputError as err:
        raise ScriptError(command.file, command.line, f"{command.name}: {err}") from err
    state.pending.append((path, command.args[0], command.file, command.line))
