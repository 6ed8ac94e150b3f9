"""Load and call machine code of kernels without importing Numba.

The machine code of a kernel is a shared library, or object code that llvmlite links into the
process. A call writes the addresses and shapes of its arrays and its numbers into a block of 64-bit
words, see `minidem.kernels.machine.build`; what a table (a named tuple of arrays) needs there is
kept for the next call. The lock of the Python interpreter is released while a kernel runs.
"""

from __future__ import annotations

import ctypes
import hashlib
import struct
import threading
from array import array
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from types import FunctionType
from typing import Any, Final, NamedTuple

import numpy as np

from minidem.kernels.machine.cache import LASTING, cache_folder, in_turn, shipped_folder
from minidem.kernels.machine.library import LIBRARY, load_library

__all__ = ["Native"]

MOMENT: Final = 1.0
"""Seconds of silence while code is compiled."""
_FLOAT = struct.Struct("d")
_WHOLE = struct.Struct("q")
_NO_RESULT = array("q", [0, 0])  # room for the result of a kernel without arguments
_MANY = 8
"""How many `LASTING` tables are kept for each argument; of others it is the last."""


class _Kept(NamedTuple):
    """What a table, or a tuple of tables, needs in a block; the table is kept alive by it."""

    table: Any
    code: Any
    words: list[int]


_NOTHING: list[_Kept] = []


class Native:
    """A kernel as machine code, called like the function it was made from.

    Parameters
    ----------
    function : callable
        The kernel, plain Python; its annotation says what it returns.
    build : callable
        ``build(function, codes, path)`` compiles the kernel and writes its machine code, see
        `minidem.kernels.machine.build.build`.
    """

    def __init__(
        self,
        function: Callable[..., Any],
        build: Callable[[Callable[..., Any], tuple[Any, ...], Path], None],
    ) -> None:
        self.__wrapped__ = function
        self._build = build
        self.__doc__ = function.__doc__
        self._result = str(function.__annotations__.get("return", "None"))
        self._entries: dict[tuple[Any, ...], Callable[..., int]] = {}
        self._latest: tuple[list[Any], Callable[..., int] | None] = [], None
        self._kept: dict[tuple[int, ...], list[_Kept]] = {}

    def __call__(self, *args: Any) -> Any:
        """Run the kernel; arrays must be C-contiguous and are passed without a copy."""
        codes, block = self._packed(args)
        block += _NO_RESULT
        latest, entry = self._latest
        if entry is None or codes != latest:
            key = tuple(codes)
            entry = self._entries.get(key) or self._load(key)
            self._entries[key] = entry
            self._latest = codes, entry  # comparing is faster than hashing tables of tables
        unused = array("q", [0, 0])
        place = unused.buffer_info()[0]
        if entry(place, place + 8, block.buffer_info()[0]) != 0:
            msg = f"the kernel {self.__wrapped__.__name__} failed"
            raise RuntimeError(msg)
        if self._result == "int":
            return block[0]
        if self._result == "bool":
            return block[0] != 0
        if self._result == "float":
            return _FLOAT.unpack(_WHOLE.pack(block[0]))[0]
        return (block[0], block[1]) if self._result.startswith("tuple") else None

    def codes(self, *args: Any) -> tuple[Any, ...]:
        """Return what machine code for these arguments is made for, see `build`."""
        return tuple(self._packed(args)[0])

    def is_ready(self, *args: Any) -> bool:
        """Whether there is machine code for these arguments; it is loaded then."""
        key = self.codes(*args)
        if key not in self._entries:
            found = self._there(key)
            if found is None:
                return False
            self._entries[key] = found
        return True

    def make(self, codes: tuple[Any, ...]) -> None:
        """Provide machine code for arguments of these codes."""
        self._entries[codes] = self._load(codes)

    def _packed(self, args: Sequence[Any]) -> tuple[list[Any], array[int]]:
        """Return codes and words of the arguments."""
        codes: list[Any] = []
        words: list[int] = []
        for i, arg in enumerate(args):
            codes.append(self._flatten((i,), arg, words))
        return codes, array("q", words)

    def _flatten(self, place: tuple[int, ...], value: Any, words: list[int]) -> Any:
        """Append the words of an argument and return its code; those of tables are kept.

        A table may hold tables; one that changes does not renew the others.
        """
        if not isinstance(value, tuple):
            return _flatten(value, words)
        known = self._kept.get(place, _NOTHING)
        for kept in known:
            if kept.table is value:
                break
        else:
            if known and _same(value, known[0].table):
                kept = known[0]
            else:
                own: list[int] = []
                codes = [self._flatten((*place, i), part, own) for i, part in enumerate(value)]
                kept = _Kept(value, (type(value), tuple(codes)), own)
                others = known[: _MANY - 1] if type(value) in LASTING else ()
                self._kept[place] = [kept, *others]
        words += kept.words
        return kept.code

    def _load(self, codes: tuple[Any, ...]) -> Callable[..., int]:
        """Return the machine code for arguments of these codes; compile it if it is new."""
        path = cache_folder() / self._file(codes)
        found = self._there(codes)
        if found is None:
            with _patience(), in_turn(path):
                found = _loaded(path)  # another process may have made it meanwhile
                if found is None:
                    self._build(self.__wrapped__, codes, path)
                    found = _loaded(path)
        if found is None:
            msg = f"{path}: written and not readable; is the disk full?"
            raise OSError(msg)
        return found

    def _there(self, codes: tuple[Any, ...]) -> Callable[..., int] | None:
        """Return machine code that came with the package or was compiled earlier, if any."""
        folders = [folder for folder in (shipped_folder(), cache_folder()) if folder is not None]
        tried = (_loaded(folder / self._file(codes)) for folder in folders)
        return next((found for found in tried if found is not None), None)

    def _file(self, codes: tuple[Any, ...]) -> str:
        """Return the name of the file with machine code for arguments of these codes."""
        function = self.__wrapped__
        what = repr((_identity(function), codes))
        return f"{function.__name__}-{hashlib.sha256(what.encode()).hexdigest()[:16]}.bin"


@contextmanager
def _patience() -> Iterator[None]:
    """Say what happens when it takes more than a moment."""
    timer = threading.Timer(MOMENT, _say_that_it_compiles)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


@cache
def _say_that_it_compiles() -> None:
    """Say it, the first time that it is called."""
    import logging

    line = "minidem: compiling for this processor; this takes half a minute, and that once"
    logging.getLogger("minidem").warning(line)


def _identity(value: Any) -> Any:
    """Return what tells a kernel from others: its name and the constants it was made with."""
    if not isinstance(value, FunctionType):
        return value
    cells = [_identity(cell.cell_contents) for cell in value.__closure__ or ()]
    return value.__module__, value.__qualname__, cells


def _same(new: Any, old: Any) -> bool:
    """Return True if two tables hold the same arrays, if need be in new tuples."""
    if not isinstance(new, tuple) or len(new) != len(old):
        return False
    # a loop, because most parts are the same and a call for each costs more than the comparison
    for a, b in zip(new, old, strict=True):  # noqa: SIM110
        if a is not b and not _same(a, b):
            return False
    return True


def _flatten(value: Any, words: list[int]) -> Any:
    """Append what a kernel needs of an array or number to `words`, and return its code."""
    if isinstance(value, np.ndarray):
        if not value.flags.c_contiguous:
            msg = "a kernel takes C-contiguous arrays only"
            raise ValueError(msg)
        words.append(_address(value))
        words += value.shape
        return _code_of(value.dtype, value.ndim)
    if isinstance(value, bool | np.bool_):
        words.append(int(value))
        return ("b",)
    if isinstance(value, int | np.integer):
        words.append(int(value))
        return ("i",)
    words.append(_WHOLE.unpack(_FLOAT.pack(value))[0])
    return ("f",)


def _address(value: Any) -> int:
    """Return where the numbers of an array begin."""
    try:
        # a sixth of the time that the interface of an array takes, which calls are full of
        return ctypes.addressof(ctypes.c_char.from_buffer(value))
    except (TypeError, ValueError):  # read only, or empty
        return int(value.__array_interface__["data"][0])


@cache
def _code_of(dtype: np.dtype[Any], ndim: int) -> tuple[str, str, int]:
    """Return the code of an array; kept, because asking for the name of a type takes its time."""
    return "a", dtype.str, ndim


def _loaded(path: Path) -> Callable[..., int] | None:
    """Load machine code that `build` wrote; None if it is not there or damaged."""
    found = load_library(path.with_suffix(LIBRARY))
    if found is None and path.is_file():
        from minidem.kernels.machine.objects import load_object  # which imports llvmlite

        found = load_object(path)
    return found
