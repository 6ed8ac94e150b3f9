"""An ordinary LIGGGHTS script whose `variable` lines are the only thing that changes."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from liggghts_io.errors import CaseError, nearest
from liggghts_io.scripts.filters import number

_VARIABLE: Final = re.compile(
    r"^(?P<head>[ \t]*variable[ \t]+(?P<name>\w+)[ \t]+(?:equal|index)[ \t]+)"
    r"(?P<value>[^#\r\n]*?)(?P<tail>[ \t]*(?:#[^\r\n]*)?\r?)$",
    re.MULTILINE,
)


@dataclass(frozen=True)
class Variable:
    """A `variable NAME equal|index VALUE` line.

    Attributes
    ----------
    line : int
        From 1.
    value : float, optional
        None where it is a formula.
    count : int
        How many such lines the script has for this name.
    """

    line: int
    value: float | None
    count: int


def variables_of(script: str) -> dict[str, Variable]:
    """Return the variables that a script defines in lines of its own, by name."""
    found: dict[str, Variable] = {}
    for match in _VARIABLE.finditer(script):
        name = match["name"]
        try:
            value = float(match["value"])
        except ValueError:
            value = None
        line = script.count("\n", 0, match.start()) + 1
        count = found[name].count + 1 if name in found else 1
        found[name] = Variable(line, value, count)
    return found


def rewritten(script: str, values: Mapping[str, float]) -> str:
    """Return a script with these variables at new values, and every other byte as it was.

    Parameters
    ----------
    script : str
    values : Mapping[str, float]
        By the name of the variable.

    Raises
    ------
    CaseError
        For a variable that the script does not define, or in more than one line.
    """
    known = variables_of(script)
    for name in values:
        check_variable(known, name)

    def changed(match: re.Match[str]) -> str:
        if match["name"] not in values:
            return match[0]
        return f"{match['head']}{number(values[match['name']])}{match['tail']}"

    return _VARIABLE.sub(changed, script)


def check_variable(known: Mapping[str, Variable], name: str) -> None:
    """Refuse a variable that cannot be given a value.

    Raises
    ------
    CaseError
        If there is no line for it, or more than one.
    """
    if name not in known:
        hint = nearest(name, list(known)) if known else "; it has no such line at all"
        msg = f"the script has no line 'variable {name} equal VALUE'{hint}"
        raise CaseError(msg)
    if known[name].count > 1:
        msg = (
            f"the script gives {name} a value in {known[name].count} lines, the last is line "
            f"{known[name].line}; keep one"
        )
        raise CaseError(msg)
