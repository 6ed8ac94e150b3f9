"""Errors of the engine.

Every message names the place, the value and a remedy, so that a person can act on it without
reading the program. The command line shows it without a traceback and ends with exit code 2.
"""

from __future__ import annotations

import errno
from collections.abc import Iterable
from typing import Final

_NO_ROOM: Final = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
_FULL: Final = "free some space, then run again or go on from the last restart file"
_SHOWN = 120  # characters of a file name that a message shows


class DemError(RuntimeError):
    """Root of all errors that the engine raises on purpose.

    Anything else that comes out of the engine is a fault of the engine, never the user's.
    """


class InputError(DemError, ValueError):
    """Raised where something that a user has written does not fit.

    Whoever executes the command makes it a `ScriptError` with file and line.
    """


class UnknownNameError(InputError):
    """Raised for a name of which the simulation knows nothing, or no such value."""


class MistakeError(InputError):
    """Raised for a mistake at which LIGGGHTS stops as well, such as a name that nothing has."""


class NoParticlesError(InputError):
    """Raised where particles are needed and there are none, which before the steps nobody knows."""


class UnknownWordError(InputError):
    """Raised for a word of a script that the engine does not have, mistyped or not."""


class MissingValueError(InputError):
    """Raised where a contact model needs a value of the material that the script does not give.

    Parameters
    ----------
    message : str
        What is missing and how to give it.
    name : str
        Name of the value.
    """

    def __init__(self, message: str, name: str) -> None:
        super().__init__(message)
        self.name = name


class OutputError(DemError):
    """Raised when a file cannot be written; ``__cause__`` is the OSError with its ``errno``.

    Parameters
    ----------
    name : str
        The file as the user knows it.
    err : OSError
        What the operating system said.
    """

    def __init__(self, name: str, err: OSError) -> None:
        full = f" ({_FULL})" if err.errno in _NO_ROOM else ""
        super().__init__(f"cannot write '{name[:_SHOWN]}': {err.strerror or err}{full}")
        self.name = name


class ResourceError(DemError):
    """Raised when the machine has not enough memory; the message has the numbers."""


class ScriptError(DemError):
    """Raised before the first step when a script cannot be understood.

    Parameters
    ----------
    file : str
        Script file as the user named it.
    line : int
        Line number, counted from 1; 0 for the file as a whole.
    message : str
        What is wrong and what would be right.
    """

    def __init__(self, file: str, line: int, message: str) -> None:
        super().__init__(f"{file}:{line}: {message}" if line else f"{file}: {message}")
        self.file = file
        self.line = line
        self.message = message


class SimulationError(DemError):
    """Raised when a running simulation cannot go on (NaN, lost particle, too fast a particle).

    Parameters
    ----------
    step : int
        Time step at which it was noticed.
    particle : int or None
        Id of the particle concerned, None if there is no single one.
    cause : str
        What happened and the likely cause.
    """

    def __init__(self, step: int, particle: int | None, cause: str) -> None:
        who = "" if particle is None else f", particle {particle}"
        super().__init__(f"step {step}{who}: {cause}")
        self.step = step
        self.particle = particle
        self.cause = cause


class RunInterrupted(KeyboardInterrupt):
    """Raised between two steps after a run was asked to stop; its files are complete.

    Parameters
    ----------
    step : int
        The last step made.
    restart : str
        Restart file that was written, empty if there was nothing to keep.
    """

    def __init__(self, step: int, restart: str = "") -> None:
        super().__init__(f"interrupted after step {step}")
        self.step = step
        self.restart = restart


def suggest(word: str, known: Iterable[str], likeness: float = 0.6) -> str:
    """Return ``; did you mean 'x'?`` for the nearest known word, or an empty string.

    Parameters
    ----------
    word : str
        The unknown word.
    known : iterable of str
        Words that it may be meant for.
    likeness : float
        How like it must be, from 0 to 1.

    Examples
    --------
    >>> suggest("wall/grann", ["wall/gran", "gravity"])
    "; did you mean 'wall/gran'?"
    """
    import difflib  # four milliseconds that only a mistake costs

    near = difflib.get_close_matches(word, list(known), n=1, cutoff=likeness)
    return f"; did you mean '{near[0]}'?" if near else ""
