"""Writing of files that are complete or not there, with errors that name the file."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from io import BufferedRandom, BytesIO, StringIO
from pathlib import Path
from typing import Any, TextIO

from minidem.errors import OutputError

__all__ = [
    "append_bytes", "append_text", "nothing_is_written", "nothing_written", "open_text",
    "whole_file", "writing",
]  # fmt: skip

_REHEARSING: ContextVar[bool] = ContextVar("rehearsing", default=False)
_PART = ".part"  # ending of a file that is being written


@contextmanager
def nothing_written() -> Iterator[None]:
    """Let all functions of this module write nothing, while a script is rehearsed."""
    before = _REHEARSING.set(True)
    try:
        yield
    finally:
        _REHEARSING.reset(before)


def nothing_is_written() -> bool:
    """Whether a script is rehearsed."""
    return _REHEARSING.get()


class writing:  # noqa: N801 - read as the function that it could be
    """Turn what the operating system says about a file into an error that names it.

    Parameters
    ----------
    name : str
        The file as the user knows it.

    Raises
    ------
    OutputError
        For any OSError; a full disk among them.
    """

    __slots__ = ("name",)

    def __init__(self, name: str) -> None:
        self.name = name  # no generator: it would take longer than many a line

    def __enter__(self) -> None:
        """Begin."""

    def __exit__(self, kind: Any, err: Any, trace: Any) -> None:
        """Turn an OSError into an OutputError."""
        if isinstance(err, OSError):
            raise OutputError(self.name, err) from err


@contextmanager
def whole_file(target: Path, *, durable: bool = False) -> Iterator[BufferedRandom | BytesIO]:
    """Write a file under another name and rename it at the end, so that nobody sees half of it.

    Parameters
    ----------
    target : Path
        The file; its folder is made.
    durable : bool
        Wait until the disk has it, so that it outlives a power failure.

    Raises
    ------
    OutputError
        If it cannot be written; what was there before stays, and no part is left behind.
    """
    if _REHEARSING.get():
        yield BytesIO()
        return
    part = target.with_name(target.name + _PART)
    with writing(target.name):
        target.parent.mkdir(parents=True, exist_ok=True)
        try:
            with part.open("w+b") as file:
                yield file
                if durable:
                    file.flush()
                    os.fsync(file.fileno())
            part.replace(target)
        except BaseException:
            part.unlink(missing_ok=True)
            raise


def append_text(target: Path, text: str, *, anew: bool = False) -> None:
    """Write a text at the end of a file; see `append_bytes`."""
    append_bytes(target, text.encode("utf-8", errors="surrogateescape"), anew=anew)


def append_bytes(target: Path, content: bytes, *, anew: bool = False) -> None:
    """Write at the end of a file, all of it or nothing.

    Parameters
    ----------
    target : Path
        The file; its folder is made.
    content : bytes
        What is added.
    anew : bool
        Whether the file begins with it.

    Raises
    ------
    OutputError
        If it cannot be written; the file then ends where it ended before.
    """
    if _REHEARSING.get():
        return
    with writing(target.name):
        target.parent.mkdir(parents=True, exist_ok=True)
        with target.open("wb" if anew else "ab", buffering=0) as file:
            before = file.tell()
            data = memoryview(content)
            try:
                while data:
                    data = data[file.write(data) :]
            except OSError:
                file.truncate(before)
                raise


def open_text(target: Path, *, append: bool = False) -> TextIO:
    """Open a text file for writing line by line; its folder is made.

    Raises
    ------
    OutputError
        If it cannot be opened.
    """
    if _REHEARSING.get():
        return StringIO()
    with writing(target.name):
        target.parent.mkdir(parents=True, exist_ok=True)
        return target.open(
            "a" if append else "w", buffering=1, encoding="utf-8", errors="surrogateescape"
        )
