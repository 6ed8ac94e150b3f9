"""Words of the form name=value that options of the command line take."""

from __future__ import annotations

import math
from collections.abc import Sequence

from calibrate.errors import CalibrationError, unknown_name

__all__ = ["numbers_of", "pairs_of"]


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


def pairs_of(option: str, words: Sequence[str]) -> dict[str, object]:
    """Read ``name=text`` words; a name that is given several times has several texts.

    Parameters
    ----------
    option : str
        Option they belong to, for the message.
    words : sequence of str

    Raises
    ------
    CalibrationError
        For a word without ``=``.

    Examples
    --------
    >>> pairs_of("--executor-option", ["queue=short", "setup=a", "setup=b"])
    {'queue': 'short', 'setup': ['a', 'b']}
    """
    texts: dict[str, list[str]] = {}
    for word in words:
        name, equals, text = word.partition("=")
        if not equals:
            msg = f"{option} {word}: write {option} name=value, for example {option} queue=short"
            raise CalibrationError(msg)
        texts.setdefault(name, []).append(text)
    return {name: found if len(found) > 1 else found[0] for name, found in texts.items()}
