"""Text to words, by the rules of the LIGGGHTS input parser.

A physical line that ends in ``&`` goes on in the next one; ``#`` starts a comment unless quoted;
words are separated by blanks; text in single or double quotes is one word.
"""

from __future__ import annotations

import codecs
import re
from pathlib import Path

from minidem.errors import InputError
from minidem.record import record

__all__ = [
    "MAX_SCRIPT_BYTES",
    "WHITESPACE",
    "Command",
    "SourceLine",
    "read_lines",
    "split_words",
    "strip_comment",
]

WHITESPACE = " \t\n\v\f\r"
"""What counts as blank: C's isspace, not Unicode's."""

_PLAIN = re.compile(f"[^{WHITESPACE}]+")
"""A word of a line without quotes."""

MAX_SCRIPT_BYTES = 32_000_000
"""Largest script file that is read; a longer one is no script."""
_SHOWN = 80  # characters of a file name that a message shows


@record(frozen=True)
class Command:
    """One command of a script, after substitution of variables.

    Attributes
    ----------
    name : str
        Command word.
    args : tuple of str
        Words after it, quotes removed.
    file : str
        Script file as the user named it.
    line : int
        Line on which the command starts, counted from 1.
    """

    name: str
    args: tuple[str, ...]
    file: str
    line: int


@record(frozen=True)
class SourceLine:
    """A logical line.

    Attributes
    ----------
    text : str
        The line, continuations joined.
    number : int
        Number of its first physical line.
    """

    text: str
    number: int


def read_lines(path: Path) -> tuple[SourceLine, ...]:
    """Read a script file as logical lines.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    tuple of SourceLine
        Continuations joined, trailing blanks removed, comments kept.

    Raises
    ------
    InputError
        If the file is missing, too large or not text.
    """
    shown = (path.name or str(path))[:_SHOWN]
    try:
        size = path.stat().st_size
    except OSError as err:
        reason = "no such file" if isinstance(err, FileNotFoundError) else err.strerror
        msg = f"cannot open input script '{shown}': {reason}"
        raise InputError(msg) from err
    if not path.is_file():
        msg = f"cannot open input script '{shown}': it is a directory or a device, not a file"
        raise InputError(msg)
    if size > MAX_SCRIPT_BYTES:
        msg = f"'{path.name}' has {size} bytes, a script at most {MAX_SCRIPT_BYTES}"
        raise InputError(msg)
    try:
        raw = path.read_bytes()
    except OSError as err:
        msg = f"cannot read input script '{shown}': {err.strerror}"
        raise InputError(msg) from err
    return _join_continuations(_text_of(raw, path.name))


def _text_of(raw: bytes, name: str) -> str:
    """Return the text of a script; what LIGGGHTS cannot read as text is refused."""
    if raw.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        msg = f"'{name}' is text in UTF-16, which LIGGGHTS does not read; save it as UTF-8"
        raise InputError(msg)
    if raw.startswith(codecs.BOM_UTF8):
        msg = (
            f"'{name}' begins with a byte order mark, at which LIGGGHTS stops as well; "
            "save it as UTF-8 without one"
        )
        raise InputError(msg)
    text = raw.decode("utf-8", errors="replace")
    if "\0" in text:
        msg = f"'{name}' contains a zero byte; it is not a text file"
        raise InputError(msg)
    return text


def _join_continuations(text: str) -> tuple[SourceLine, ...]:
    physical = text.split("\n")
    if physical and physical[-1] == "":
        physical.pop()
    lines: list[SourceLine] = []
    parts: list[str] = []
    start = 1
    for number, line in enumerate(physical, start=1):
        if not parts:
            start = number
        stripped = line.rstrip(WHITESPACE)
        if stripped.endswith("&"):
            parts.append(stripped[:-1])
            continue
        lines.append(SourceLine("".join([*parts, stripped]), start))
        parts = []
    if parts:
        lines.append(SourceLine("".join(parts), start))
    return tuple(lines)


def strip_comment(line: str) -> str:
    """Cut an unquoted ``#`` and what follows it.

    A quote sign inside text quoted with the other sign opens a new quote, as in LIGGGHTS.

    Examples
    --------
    >>> strip_comment("run 10 # ten")
    'run 10 '
    >>> strip_comment("print 'a # b'")
    "print 'a # b'"
    """
    if "#" not in line:
        return line
    quote = ""
    for i, char in enumerate(line):
        if char == "#" and not quote:
            return line[:i]
        quote = next_quote(quote, char)
    return line


def next_quote(quote: str, char: str) -> str:
    """Return the open quote sign after `char`, given the one before it ('' for none)."""
    if char == quote:
        return ""
    return char if char in "\"'" else quote


def split_words(line: str) -> list[str]:
    r"""Split a line without comment into words.

    Raises
    ------
    InputError
        If a quote is not closed, or not followed by a blank.

    Examples
    --------
    >>> split_words("if \"1 < 2\" then 'run 10'")
    ['if', '1 < 2', 'then', 'run 10']
    """
    if '"' not in line and "'" not in line:
        return _PLAIN.findall(line)
    words: list[str] = []
    i, n = 0, len(line)
    while True:
        while i < n and line[i] in WHITESPACE:
            i += 1
        if i >= n:
            return words
        if line[i] in "\"'":
            stop = line.find(line[i], i + 1)
            if stop < 0:
                msg = f"quote {line[i]} opened but not closed; close it on the same line"
                raise InputError(msg)
            if stop + 1 < n and line[stop + 1] not in WHITESPACE:
                msg = f"closing quote {line[i]} must be followed by a blank"
                raise InputError(msg)
            words.append(line[i + 1 : stop])
            i = stop + 1
            continue
        start = i
        while i < n and line[i] not in WHITESPACE:
            i += 1
        words.append(line[start:i])
