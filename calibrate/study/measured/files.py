"""Files that a person wrote: bytes within limits, and the text in them."""

from __future__ import annotations

import codecs
import errno
from pathlib import Path
from typing import Final

from calibrate.errors import CalibrationError
from liggghts_io.files import UTF_16_MARKS, nearest_file, table_text

__all__ = ["bytes_of", "encoding_of", "text_in"]

_LONGEST_SHOWN: Final = 240
_LINE_END: Final = b"\n"
_LAYOUT: Final = "\t\n\r\f\v"
"""Control characters that a table may hold."""


def bytes_of(path: Path, largest: int, what: str) -> bytes:
    """Return the bytes of a regular file that is not too large.

    Parameters
    ----------
    path : Path
    largest : int
        Most bytes that are read.
    what : str
        What it should be, for messages.

    Raises
    ------
    CalibrationError
    """
    try:
        raw = _first_bytes(path, largest + 1)
    except (OSError, ValueError, RuntimeError) as err:  # ValueError: NUL; RuntimeError: link loop
        reason = getattr(err, "strerror", None) or err
        text = str(path)
        shown = text if len(text) <= _LONGEST_SHOWN else text[:_LONGEST_SHOWN] + "..."
        msg = f"{shown!r}" if "\0" in shown else shown
        msg += f": cannot be read ({reason}){nearest_file(path)}; give the path of {what}"
        raise CalibrationError(msg) from err
    if len(raw) > largest:
        msg = f"{path}: larger than {largest / 1e6:g} MB; that is not {what}"
        raise CalibrationError(msg)
    return raw


def _first_bytes(path: Path, count: int) -> bytes:
    """Return the beginning of a file; a pipe or device would be waited for."""
    if path.exists() and not path.is_file():
        raise OSError(errno.EINVAL, "it is a directory" if path.is_dir() else "it is not a file")
    with path.open("rb") as file:
        return file.read(count)


def text_in(path: Path, raw: bytes) -> str:
    """Return the text of a table as programs save it, see `table_text`.

    Parameters
    ----------
    path : Path
        Where the bytes come from.
    raw : bytes

    Raises
    ------
    CalibrationError
        When it is no text; with the line.
    """
    try:
        text = table_text(raw)
    except UnicodeDecodeError as err:
        place = f"{path}:{raw.count(_LINE_END, 0, err.start) + 1}"
        other = "UTF-16" if raw.startswith(UTF_16_MARKS) else "CP1252"
        msg = (
            f"{place}: byte {raw[err.start]:#04x} is neither UTF-8 nor {other}; save the "
            "table as UTF-8 (a spreadsheet calls it 'CSV UTF-8')"
        )
        raise CalibrationError(msg) from err
    if raw.startswith(UTF_16_MARKS):
        return text
    for number, line in enumerate(text.splitlines(), 1):
        odd = next((c for c in line if c < " " and c not in _LAYOUT), None)
        if odd is not None:
            like = "UTF-16 without its mark" if odd == "\0" else "no text"
            msg = (
                f"{path}:{number}: holds the character {ord(odd):#04x}, as {like} does; save the "
                "table as UTF-8 (a spreadsheet calls it 'CSV UTF-8')"
            )
            raise CalibrationError(msg)
    return text


def encoding_of(raw: bytes) -> str:
    """Return how a text that `text_in` reads is to be continued: an encoding without its mark.

    Examples
    --------
    >>> encoding_of("ü".encode("utf-16")), encoding_of("ü".encode("cp1252")), encoding_of(b"u")
    ('utf-16-le', 'cp1252', 'utf-8')
    """
    if raw.startswith(UTF_16_MARKS):
        return "utf-16-le" if raw.startswith(codecs.BOM_UTF16_LE) else "utf-16-be"
    try:
        raw.decode("utf-8")
    except UnicodeDecodeError:
        return "cp1252"
    return "utf-8"
