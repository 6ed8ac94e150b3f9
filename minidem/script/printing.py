"""The ``print`` command."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from minidem.script.formula import FormulaError
from minidem.script.paths import inside

__all__ = ["print_text"]


def print_text(
    text: str, options: tuple[str, ...], root: Path, emit: Callable[[str], None]
) -> None:
    """Write a text to screen and log, and to a file if asked.

    Parameters
    ----------
    text : str
        Text after substitution.
    options : tuple of str
        ``file NAME``, ``append NAME``, ``screen yes|no`` in any order.
    root : Path
        Folder the file must be in.
    emit : callable
        Screen and log.

    Raises
    ------
    FormulaError
        For a wrong option or a file that cannot be written.
    """
    screen = True
    target: tuple[str, Path] | None = None
    for i in range(0, len(options), 2):
        word = options[i]
        if i + 1 == len(options) or word not in ("file", "append", "screen"):
            msg = f"print: unexpected '{word[:40]}'; it takes file NAME, append NAME, screen yes|no"
            raise FormulaError(msg)
        if word == "screen":
            if options[i + 1] not in ("yes", "no"):
                msg = f"print screen takes yes or no, got '{options[i + 1][:40]}'"
                raise FormulaError(msg)
            screen = options[i + 1] == "yes"
        else:
            target = ("w" if word == "file" else "a", inside(root, options[i + 1]))
            _write(target, "")
    if screen:
        emit(text)
    if target is not None:
        _write(("a", target[1]), text + "\n")


def _write(target: tuple[str, Path], text: str) -> None:
    mode, path = target
    try:
        with path.open(mode, encoding="utf-8", newline="") as file:
            file.write(text)
    except OSError as err:
        msg = f"print cannot write '{path.name}': {err.strerror}"
        raise FormulaError(msg) from err
