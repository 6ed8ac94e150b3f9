"""What variables of the styles ``file``, ``atomfile`` and ``getenv`` get from outside."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from minidem.errors import InputError
from minidem.script.lexer import MAX_SCRIPT_BYTES, WHITESPACE

__all__ = ["atom_sets", "atom_values_of", "environment", "single_values"]

_SHOWN = 60  # characters of a line or file name that a message shows


def single_values(path: Path) -> tuple[str, ...]:
    """Return the values of a file, one a line; comments and blank lines are passed over.

    As in LIGGGHTS a value ends at the first blank behind its first word.

    Raises
    ------
    InputError
        If the file is missing, too large or has no value.
    """
    found = []
    for line in _lines(path):
        words = line.split()
        if words:
            indent = len(line) - len(line.lstrip(WHITESPACE))
            found.append(line[:indent] + words[0])
    if not found:
        msg = f"'{path.name[:_SHOWN]}' has no value for a variable of style file"
        raise InputError(msg)
    return tuple(found)


def atom_sets(path: Path) -> tuple[str, ...]:
    """Return the sets of values of a file, each a number of lines and so many ``ID VALUE``.

    Returns
    -------
    tuple of str
        Lines ``ID VALUE`` of each set.

    Raises
    ------
    InputError
        If the file is missing, too large, ends within a set or has a line that is none.
    """
    lines = [line for line in _lines(path) if line.strip(WHITESPACE)]
    found, at = [], 0
    while at < len(lines):
        count = lines[at].split()[0]
        if not (count.isascii() and count.isdigit() and int(count[:10]) < len(lines) - at):
            shown = lines[at][:_SHOWN]
            msg = f"'{path.name[:_SHOWN]}': expected a number of lines, found '{shown}'"
            raise InputError(msg)
        rows = lines[at + 1 : at + 1 + int(count)]
        found.append("\n".join(rows))
        atom_values_of(found[-1])
        at += 1 + int(count)
    if not found:
        msg = f"'{path.name[:_SHOWN]}' has no values for a variable of style atomfile"
        raise InputError(msg)
    return tuple(found)


def atom_values_of(rows: str) -> dict[int, float]:
    """Return the values of a set by the id of their particle."""
    found = {}
    for row in rows.splitlines():
        words = row.split()
        try:
            found[int(words[0])] = float(words[1])
        except (ValueError, IndexError) as err:
            msg = f"expected a particle's id and a value, found '{row[:_SHOWN]}'"
            raise InputError(msg) from err
    return found


def environment(
    given: Mapping[str, Sequence[str]], name: str, wanted: str, warn: Callable[[str], object]
) -> str:
    """Return what stands for a variable of the environment, which is never read.

    Parameters
    ----------
    given : mapping of str to sequence of str
        Values of the command line.
    name, wanted : str
        Name in the script; in the environment.
    warn : callable
        Takes a warning.
    """
    if given.get(wanted):
        return given[wanted][0]
    warn(
        f"variable {name} is empty: a script is data and does not read the environment; give the "
        f"value with -var {wanted[:_SHOWN]} VALUE"
    )
    return ""


def _lines(path: Path) -> list[str]:
    """Return the lines of a file without comments."""
    try:
        size = path.stat().st_size
        if path.is_file() and size <= MAX_SCRIPT_BYTES:
            text = path.read_bytes().decode("utf-8", errors="replace")
            return [line.split("#")[0] for line in text.replace("\0", "?").split("\n")]
    except OSError as err:
        msg = f"cannot read '{path.name[:_SHOWN]}': {err.strerror}"
        raise InputError(msg) from err
    msg = f"'{path.name[:_SHOWN]}' is no file of at most {MAX_SCRIPT_BYTES} bytes"
    raise InputError(msg)
