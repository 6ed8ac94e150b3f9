"""Reading of binary files that may say anything: never more than there is."""

from __future__ import annotations

import struct
from typing import Final, NoReturn

import numpy as np

from minidem.errors import InputError
from minidem.world.state import Floats

__all__ = ["Reader", "damaged"]

_LONGEST: Final = 1024  # characters of a name


def damaged(why: str) -> NoReturn:
    """Say that a restart file of LIGGGHTS makes no sense, and where; InputError."""
    msg = (
        f"restart file of LIGGGHTS is damaged or of another version than 3.8.0: {why}; use an "
        "earlier one, or let LIGGGHTS write a data file with write_data"
    )
    raise InputError(msg)


class Reader:
    """Takes values off the bytes of a file, never more than there are."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._at = 0

    def raw(self, count: int) -> bytes:
        """Return the next bytes."""
        if not 0 <= count <= len(self._data) - self._at:
            damaged("it ends too early")
        self._at += count
        return self._data[self._at - count : self._at]

    def integer(self, size: int = 4) -> int:
        """Return the next whole number."""
        return int.from_bytes(self.raw(size), "little", signed=True)

    def real(self) -> float:
        """Return the next float64."""
        return float(struct.unpack("<d", self.raw(8))[0])

    def reals(self, count: int) -> Floats:
        """Return the next float64 numbers."""
        return np.frombuffer(self.raw(8 * count), "<f8").astype(np.float64)

    def text(self) -> str:
        """Return the next text, which ends in a zero byte."""
        count = self.integer()
        if not 0 < count <= _LONGEST:
            damaged(f"a text of {count} characters")
        return self.raw(count)[:-1].decode("utf-8", errors="replace")
