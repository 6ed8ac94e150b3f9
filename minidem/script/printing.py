"""The ``print`` command."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from minidem.files import append_text
from minidem.script.formula import FormulaError
from minidem.script.paths import CaseFolder, inside

__all__ = ["print_text"]


def print_text(
    text: str, options: tuple[str, ...], root: CaseFolder, emit: Callable[[str], None]
) -> None:
    """Write a text to screen and log, and to a file if asked.

    Parameters
    ----------
    text : str
        Text after substitution.
    options : tuple of str
        ``file NAME``, ``append NAME``, ``screen yes|no``, ``newline yes|no`` in any order.
    root : CaseFolder
        Folder the file must be in.
    emit : callable
        Screen and log.

    Raises
    ------
    FormulaError
        For a wrong option.
    OutputError
        For a file that cannot be written.
    """
    screen, newline = True, True
    target: Path | None = None
    for i in range(0, len(options), 2):
        word = options[i]
        if i + 1 == len(options) or word not in ("file", "append", "screen", "newline"):
            msg = (
                f"print: unexpected '{word[:40]}'; it takes file NAME, append NAME, screen yes|no, "
                "newline yes|no"
            )
            raise FormulaError(msg)
        if word in ("screen", "newline"):
            if options[i + 1] not in ("yes", "no"):
                msg = f"print {word} takes yes or no, got '{options[i + 1][:40]}'"
                raise FormulaError(msg)
            wanted = options[i + 1] == "yes"
            screen, newline = (wanted, newline) if word == "screen" else (screen, wanted)
        else:
            target = inside(root, options[i + 1])
            append_text(target, "", anew=word == "file")
    if screen:
        emit(text)
    if target is not None:
        append_text(target, text + "\n" * newline)
