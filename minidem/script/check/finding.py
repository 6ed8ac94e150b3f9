"""What a rehearsal finds, and what to say of it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from minidem.errors import (
    InputError,
    MissingValueError,
    MistakeError,
    NoParticlesError,
    ScriptError,
    UnknownWordError,
)
from minidem.script.check.signs import foreign_signs

__all__ = ["Finding", "refusal"]

_OUTPUT = frozenset([
    "compute", "compute_modify", "dump", "dump_modify", "echo", "info", "log", "modify_timing",
    "package", "print", "processors", "restart", "run_style", "shell", "suffix", "thermo",
    "thermo_log", "thermo_modify", "thermo_style", "uncompute", "undump", "write_data",
    "write_dump", "write_restart",
])  # fmt: skip
_OUTPUT_FIXES = ("ave/", "heat/", "store/", "property/atom", "print", "check/timestep")
_LISTED = 20  # further findings that a refusal names


@dataclass(frozen=True)
class Finding:
    """A line that will not be carried out.

    Attributes
    ----------
    error : ScriptError
        File, line and what is wrong.
    text : str
        The line as written.
    command : str
        Its command word.
    style : str
        Of a fix, compute or dump; '' for other commands.
    certain : bool
        False if the line is in a branch that may not be taken.
    skipped : bool
        True if the script runs without it.
    late : bool
        True if steps are made before the script gets there.
    """

    error: ScriptError
    text: str
    command: str
    style: str = ""
    certain: bool = True
    skipped: bool = False
    late: bool = False

    @classmethod
    def of(cls, error: ScriptError, text: str, *, certain: bool, late: bool = False) -> Finding:
        """Return what a mistake in a line is."""
        if hint := foreign_signs(text, error.message):
            cause = error.__cause__
            error = ScriptError(error.file, error.line, f"{error.message}; {hint}")
            error.__cause__ = cause
        words = text.split()
        command = words[0] if words else ""
        styled = command in ("fix", "compute", "dump")
        style = "".join(words[3:4]) if styled else ""
        return cls(error, text.strip(), command, style, certain=certain, late=late)

    @property
    def missing_file(self) -> bool:
        """Whether a file is not there; the script may yet write it."""
        cause: BaseException | None = self.error
        while cause is not None and not isinstance(cause, FileNotFoundError):
            cause = cause.__cause__
        return cause is not None

    @property
    def unknown_word(self) -> bool:
        """Whether minidem lacks a word, whatever else is right or wrong with the script."""
        return isinstance(self.error.__cause__, UnknownWordError)

    @property
    def no_particles(self) -> bool:
        """Whether nothing but particles is missing."""
        return isinstance(self.error.__cause__, NoParticlesError)

    @property
    def missing_value(self) -> bool:
        """Whether a contact model lacks a value of the material."""
        return isinstance(self.error.__cause__, MissingValueError)

    @property
    def moves(self) -> bool:
        """Whether the motion of the particles may depend on the line."""
        if self.command == "fix":
            wear = self.style.startswith("mesh/surface") and "'wear'" in self.error.message
            return not (self.style.startswith(_OUTPUT_FIXES) or wear)
        return self.command not in _OUTPUT

    @property
    def shared(self) -> bool:
        """Whether LIGGGHTS makes the same steps and then stops at the line as well."""
        return self.late and isinstance(self.error.__cause__, MistakeError)

    @property
    def refused(self) -> bool:
        """Whether the script is refused because of it before its first command."""
        return self.certain and not (self.skipped or self.shared)


def refusal(findings: Iterable[Finding]) -> ScriptError | None:
    """Return the error with which a script is refused, None if it is not.

    Parameters
    ----------
    findings : iterable of Finding
        In the order of the script.

    Returns
    -------
    ScriptError or None
        The first, and in its message where the others are.
    """
    refused = [finding.error for finding in findings if finding.refused]
    if not refused:
        return None
    first, others = refused[0], refused[1:]
    more = [f"{one.file}:{one.line}: {one.message}" for one in others[:_LISTED]]
    if len(others) > _LISTED:
        more.append(f"and {len(others) - _LISTED} more lines")
    message = first.message
    if more:
        message += "\nrefused as well, and 'minidem --check' tells more:\n" + "\n".join(more)
    found = ScriptError(first.file, first.line, message)
    found.__cause__ = first.__cause__ if isinstance(first.__cause__, InputError) else None
    return found
