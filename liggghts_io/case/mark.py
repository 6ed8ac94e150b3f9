"""The completion mark: the last line of a script, by which a log proves that the run completed."""

from __future__ import annotations

import re
from typing import Final

from liggghts_io.files import sha256_text

_SHORT: Final = 16  # digits of the case id in the mark
_PRINTED: Final = re.compile(r"bulkcal: case ([0-9a-f]{16}) complete at step (\d+)")
COMMAND: Final = 'print "bulkcal: case '
_THERMO: Final = re.compile(r"\s*(\d+)\s+\d+\s+\S+\s*")


def mark(identity: str) -> str:
    """Return the command that prints the mark of a case; both engines understand it."""
    return f'{COMMAND}{identity[:_SHORT]} complete at step $(step)"'


def with_mark(script: str, identity: str) -> str:
    """Return a script that ends with the mark of its case."""
    return f"{script.rstrip()}\n\n# Read by 'bulkcal post'.\n{mark(identity)}\n"


def ends_with_mark(script: str, identity: str) -> bool:
    """Return whether the mark is the last line of a script, and the only one."""
    lines = [line for line in script.splitlines() if line.startswith(COMMAND)]
    return lines == [mark(identity)] and script.rstrip().endswith(mark(identity))


def script_digest(script: str) -> str:
    """Return the sha256 of what an engine executes: no comments, no blank lines, no mark."""
    lines = [
        line
        for line in script.splitlines()
        if line.strip() and not line.lstrip().startswith("#") and not line.startswith(COMMAND)
    ]
    return sha256_text("\n".join(lines))


def completed_step(log: str, identity: str) -> int | None:
    """Return the step at which a log says that the case completed, or None."""
    for line in reversed(log.splitlines()):
        found = _PRINTED.fullmatch(line.strip())
        if found and found[1] == identity[:_SHORT]:
            return int(found[2])
    return None


def thermo_step(line: str) -> int | None:
    """Return the step of a line of the thermo table (step, atoms, energy), or None."""
    found = _THERMO.fullmatch(line)
    return int(found[1]) if found else None


def last_step(log: str) -> int:
    """Return the last step that a log shows, 0 if none."""
    steps = (thermo_step(line) for line in reversed(log.splitlines()))
    return next((step for step in steps if step is not None), 0)
