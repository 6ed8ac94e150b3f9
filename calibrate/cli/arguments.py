"""Words of the command line that need checking: ``name=value`` pairs and existing paths."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Sequence
from pathlib import Path
from typing import Annotated

import typer

from calibrate.errors import CalibrationError, unknown_name

__all__ = ["AsJson", "existing_case", "names_of", "numbers_of", "one_of"]

AsJson = Annotated[bool, typer.Option("--json", help="Print JSON for a program to read.")]


def numbers_of(option: str, words: Sequence[str], known: Sequence[str] = ()) -> dict[str, float]:
    """Read ``name=value`` words.

    Parameters
    ----------
    option : str
        Option they belong to, for the message.
    words : sequence of str
        For example ``["mu_pp=0.69", "e_pp=0.6"]``.
    known : sequence of str
        Allowed names; empty when somebody else checks them.

    Raises
    ------
    CalibrationError
        With the word, what is wrong with it and what would be right.

    Examples
    --------
    >>> numbers_of("-p", ["mu_pp=0.69"])
    {'mu_pp': 0.69}
    """
    values: dict[str, float] = {}
    for word in words:
        name, equals, text = word.partition("=")
        if not equals:
            msg = f"{option} {word}: write {option} name=value, for example {option} mu_pp=0.69"
            raise CalibrationError(msg)
        if known and name not in known:
            msg = f"{option} {word}: {unknown_name(name, known)}"
            raise CalibrationError(msg)
        if name in values:
            msg = f"{option} {word}: '{name}' is given twice"
            raise CalibrationError(msg)
        try:
            values[name] = float(text)
        except ValueError:
            values[name] = math.nan
        if not math.isfinite(values[name]):
            msg = f"{option} {word}: '{text}' is not a number"
            raise CalibrationError(msg)
    return values


def one_of(what: str, word: str, known: Collection[str]) -> str:
    """Return `word` when it is known, else say the nearest one."""
    if word not in known:
        msg = f"{what}: {unknown_name(word, known)}"
        raise CalibrationError(msg)
    return word


def names_of(known: Iterable[str]) -> str:
    """Return names as a help text lists them.

    Examples
    --------
    >>> names_of(["quick", "lab", "paper"])
    'quick, lab or paper'
    """
    *first, last = known
    return f"{', '.join(first)} or {last}" if first else last


def existing_case(directory: Path) -> Path:
    """Return a directory that holds a case, else say how to make one."""
    if not directory.is_dir():
        msg = f"{directory}: no such directory; make a case with 'bulkcal generate ... --out DIR'"
        raise CalibrationError(msg)
    return directory
