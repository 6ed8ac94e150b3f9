"""Errors of the calibration layer, and the hint that ends their messages."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

__all__ = ["CalibrationError", "suggest"]


class CalibrationError(RuntimeError):
    """Raised when a study, its data or a calibration step cannot be used as given.

    The message names the place, the value and a remedy; the command line shows it without a
    traceback and ends with exit code 2.
    """


def suggest(word: str, known: Iterable[str]) -> str:
    """Return ``; did you mean 'x'?`` for the nearest known word, or an empty string.

    Examples
    --------
    >>> suggest("surfce", ["surface", "scale"])
    "; did you mean 'surface'?"
    """
    near = difflib.get_close_matches(word, list(known), n=1)
    return f"; did you mean '{near[0]}'?" if near else ""
