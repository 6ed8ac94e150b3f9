"""Replacement of ``${name}``, ``$x`` and ``$(formula)`` in a line."""

from __future__ import annotations

import re
from collections.abc import Callable

from minidem.errors import InputError
from minidem.script.formula import FormulaError
from minidem.script.variables import Variables

__all__ = ["MAX_LINE", "refuse_template", "substitute"]

MAX_LINE = 65_536
"""Longest line after substitution, so that self-repeating strings cannot fill the memory."""

_PLACE = re.compile(r"\{\{.*?\}\}|\{%.*?%\}")
"""What a template leaves open."""


def refuse_template(line: str) -> None:
    """Refuse a line that is still to be filled in.

    Quotes may hold anything, so a line with some is let through.

    Raises
    ------
    InputError
    """
    found = None if '"' in line or "'" in line else _PLACE.search(line)
    if found:
        msg = (
            f"'{found[0][:40]}' is a place of a template (Jinja): fill it in first, then run the "
            "script that comes out"
        )
        raise InputError(msg)


def substitute(line: str, variables: Variables, echo: Callable[[str], None] | None = None) -> str:
    """Replace variables outside quotes.

    Parameters
    ----------
    line : str
        Text without comment.
    variables : Variables
        Where values come from.
    echo : callable, optional
        Called with the whole line after every replacement, as LIGGGHTS logs it.

    Returns
    -------
    str

    Raises
    ------
    FormulaError
        If a variable is unknown, a bracket is missing or the line grows too long.
    """
    if "$" not in line:
        return line
    done: list[str] = []
    length, i, quote = 0, 0, ""
    while i < len(line):
        if line[i] == "$" and not quote:
            value, i = _value(line, i, variables)
            done.append(value)
            length += len(value)
            if length > MAX_LINE:
                msg = f"the line is longer than {MAX_LINE} characters after substitution"
                raise FormulaError(msg)
            if echo is not None:
                echo("".join(done) + line[i:])
            continue
        if not quote and line[i] in "\"'":
            quote = line[i]
        elif line[i] == quote:
            quote = ""
        done.append(line[i])
        length += 1
        i += 1
    return "".join(done)


def _value(line: str, at: int, variables: Variables) -> tuple[str, int]:
    """Return the replacement of the ``$`` at `at` and where the line goes on."""
    following = line[at + 1 : at + 2]
    if following == "{":
        stop = line.find("}", at)
        if stop < 0:
            msg = f"'{line[at : at + 20]}': closing brace is missing"
            raise FormulaError(msg)
        return variables.text(line[at + 2 : stop]), stop + 1
    if following == "(":
        stop = _closing(line, at + 1)
        return variables.immediate(line[at + 2 : stop]), stop + 1
    if not following:
        msg = "'$' at the end of the line; a variable name must follow"
        raise FormulaError(msg)
    return variables.text(following), at + 2


def _closing(line: str, at: int) -> int:
    depth = 0
    for i in range(at, len(line)):
        depth += (line[i] == "(") - (line[i] == ")")
        if depth == 0:
            return i
    msg = f"'{line[at - 1 : at + 20]}': closing parenthesis is missing"
    raise FormulaError(msg)
