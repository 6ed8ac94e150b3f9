"""Files that a person wrote: bytes within limits, and the text in them."""

from __future__ import annotations

import codecs
import errno
from pathlib import Path
from typing import Final

from calibrate.errors import CalibrationError
from liggghts_io.files import nearest_file

__all__ = ["bytes_of", "encoding_of", "text_in"]

_LONGEST_SHOWN: Final = 240
_MARKS: Final = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
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
    """Return the text of a table as programs save it.

    UTF-8 with and without a byte order mark, UTF-16 with one, and Windows' western European
    letters (of which Latin-1 is a part) where it is no UTF-8: a table holds few words, and the
    numbers are the same in all of them.

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
    if raw.startswith(_MARKS):
        return _decoded(path, raw, "utf-16")
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = _decoded(path, raw, "cp1252")
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
    if raw.startswith(_MARKS):
        return "utf-16-le" if raw.startswith(codecs.BOM_UTF16_LE) else "utf-16-be"
    try:
        raw.decode("utf-8")
    except UnicodeDecodeError:
        return "cp1252"
    return "utf-8"


def _decoded(path: Path, raw: bytes, encoding: str) -> str:
    try:
        return raw.decode(encoding)
    except UnicodeDecodeError as err:
        line = raw.count(b"\n", 0, err.start) + 1
        msg = (
            f"{path}:{line}: byte {raw[err.start]:#04x} is neither UTF-8 nor {encoding.upper()}; "
            "save the table as UTF-8 (a spreadsheet calls it 'CSV UTF-8')"
        )
        raise CalibrationError(msg) from err
