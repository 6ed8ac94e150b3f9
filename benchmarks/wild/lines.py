"""Lines of a script: made harmless, made comparable, taken out."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Final

_SHELL: Final = re.compile(r"(?:^|[\"'])\s*shell\b")
_NAME: Final = re.compile(r"(?!.*\.\.)[\w$][\w.${}/+-]*$")
_WORDS: Final = re.compile(r"[^\s\"']*/[^\s\"']*")
_OUTPUT: Final = (
    "dump",
    "restart",
    "write_restart",
    "log",
    "fix",
    "print",
    "write_data",
    "thermo_log",
)
_BOX: Final = ("create_box", "read_data", "read_restart")
_LEADING: Final = re.compile(r"\s*(\S*)")
EVERY: Final = 100
"""Steps between lines of thermo output when engines are compared."""


def statements(text: str) -> Iterator[tuple[int, str]]:
    """Yield first line, counted from 1, and text of each statement, continued lines joined.

    A joined text keeps its breaks.
    """
    held: list[str] = []
    start = 1
    for number, line in enumerate(text.split("\n"), start=1):
        start = start if held else number
        held.append(line)
        if not line.rstrip().endswith("&"):
            yield start, "\n".join(held)
            held = []
    if held:
        yield start, "\n".join(held)


def first_word(statement: str) -> str:
    """Return the command of a statement, '' for a comment."""
    found = _LEADING.match(statement)
    word = found[1] if found else ""
    return "" if word.startswith("#") else word


def _changed(text: str, change: Callable[[str], str]) -> str:
    return "\n".join(change(statement) for _, statement in statements(text))


def _commented(statement: str) -> str:
    return "\n".join(f"#{line.rstrip().rstrip('&')}" for line in statement.split("\n"))


def harmless(text: str) -> str:
    """Return a script without shell commands, but for mkdir of plain names below the folder.

    Examples
    --------
    >>> harmless("shell mkdir post")
    'shell mkdir post'
    >>> harmless("shell rm -r ..")
    '#shell rm -r ..'
    >>> harmless("fix shell all mesh/surface file shell.stl type 1")
    'fix shell all mesh/surface file shell.stl type 1'
    """

    def change(statement: str) -> str:
        body = statement.split("#")[0]
        words = body.replace("&", " ").split()
        plain = words[:2] == ["shell", "mkdir"] and all(map(_NAME.match, words[2:]))
        if not _SHELL.search(body) or (plain and len(words) > 2):
            return statement
        return _commented(statement)

    return _changed(text, change)


def comparable(text: str) -> str:
    """Return a script that prints step, particles and kinetic energy, and prints them often."""
    seen = False

    def change(statement: str) -> str:
        nonlocal seen
        word = first_word(statement)
        if word in ("thermo", "thermo_style"):
            return _commented(statement)
        if word in _BOX and not seen:
            seen = True
            return f"{statement}\nthermo_style custom step atoms ke\nthermo {EVERY}"
        return statement

    return _changed(text, change)


def on_one_process(text: str) -> str:
    """Return a script without the wish for several processes."""
    return _changed(text, lambda s: _commented(s) if first_word(s) == "processors" else s)


def without_runs(text: str) -> str:
    """Return a script that is read to its end at once."""
    return _changed(text, lambda s: _commented(s) if first_word(s) == "run" else s)


def without_jumps(text: str) -> str:
    """Return a script whose loops are read once, also those of a jump behind an if."""
    return _changed(text, lambda s: _commented(s) if "jump" in s.split("#")[0] else s)


def without(text: str, number: int) -> str:
    """Return a script without the statement that has a line, counted from 1."""
    kept = []
    for start, statement in statements(text):
        inside = start <= number < start + 1 + statement.count("\n")
        kept.append(_commented(statement) if inside else statement)
    return "\n".join(kept)


def statement_at(text: str, number: int) -> str:
    """Return the statement that has a line, in one line."""
    for start, statement in statements(text):
        if start <= number < start + 1 + statement.count("\n"):
            return " ".join(line.rstrip().rstrip("&") for line in statement.split("\n"))
    return ""


def output_folders(text: str) -> list[Path]:
    """Return the folders into which a script writes, as its author would have made them."""
    found = set()
    for _, statement in statements(text):
        if first_word(statement) in _OUTPUT:
            for word in _WORDS.findall(statement.split("#")[0]):
                folder = Path(word).parent
                if "$" not in str(folder) and not folder.is_absolute() and folder.name:
                    found.add(folder)
    return sorted(found)
