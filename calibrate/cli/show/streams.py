"""Where the command writes: closed streams, readers that go away, letters a terminal lacks."""

from __future__ import annotations

import codecs
import os
import sys
import unicodedata
from io import TextIOWrapper
from typing import Final

from rich.console import Console

__all__ = ["READER_GONE", "Terminal", "open_streams", "to_nowhere"]

READER_GONE: Final = 141
"""Exit code when nobody reads on, as after ``bulkcal ... | head``: that of SIGPIPE."""

_INSTEAD: Final = "bulkcal.instead"
_IN_ASCII: Final = {
    "±": "+-", "µ": "u", "μ": "u", "°": "deg", "≤": "<=", "≥": ">=", "\xd7": "x", "·": "*",
    "\u2013": "-", "\u2212": "-", "→": "->", "ß": "ss",
}  # fmt: skip


class Terminal(Console):
    """A console that ends the command without a word when its reader goes away."""

    def on_broken_pipe(self) -> None:
        """End the command; called when nobody reads what was written."""
        self.quiet = True
        to_nowhere()
        raise SystemExit(READER_GONE)


def to_nowhere() -> None:
    """Let what is still written, also by Python when it ends, go nowhere."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for number in (1, 2):
        os.dup2(nowhere, number)
    os.close(nowhere)


def open_streams() -> None:
    """Make the standard streams take whatever the command says.

    A stream that was closed (``>&-``) is opened on nothing, so that no file of a result gets its
    number. Where a terminal or pipe has no Unicode, letters that it lacks are written in ASCII.
    """
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        try:
            os.fstat(number)
        except OSError:
            os.set_inheritable(os.open(os.devnull, os.O_RDWR), True)  # the lowest free number
        if getattr(sys, name) is None:
            mode = "r" if number == 0 else "w"
            setattr(sys, name, os.fdopen(number, mode, encoding="utf-8", closefd=False))
    codecs.register_error(_INSTEAD, _instead)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper) and not stream.encoding.lower().startswith("utf"):
            stream.reconfigure(errors=_INSTEAD)


def _instead(error: UnicodeError) -> tuple[str, int]:
    """Return what is written for letters that an encoding lacks, and where to go on."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    letters = error.object[error.start : error.end]
    return "".join(map(_in_ascii, letters)), error.end


def _in_ascii(letter: str) -> str:
    """Return a letter in ASCII: without its accent, or a question mark.

    Examples
    --------
    >>> "".join(map(_in_ascii, "±ü²粒"))
    '+-u2?'
    """
    plain = unicodedata.normalize("NFKD", letter).encode("ascii", "ignore").decode()
    return _IN_ASCII.get(letter) or plain or "?"
