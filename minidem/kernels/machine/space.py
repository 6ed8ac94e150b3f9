"""What kernels need of the machine and Python has not: working space, words that threads share.

These are the plain functions, for kernels that run interpreted. The compiler takes those of
`minidem.kernels.machine.intrinsics` instead.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from minidem.kernels.machine.cache import CHECKED, COMPILED

__all__ = [
    "add_four",
    "add_two",
    "claim",
    "collect",
    "columns",
    "fetch",
    "give_way",
    "indices",
    "look",
    "matrix",
    "publish",
    "put_four",
    "spread",
    "vector",
]


def vector(count: int) -> NDArray[np.float64]:
    """Return working space for `count` numbers; in machine code it lies on the stack."""
    return np.full(count, np.nan)


def matrix(rows: int, columns: int) -> NDArray[np.float64]:
    """Return working space of `rows` by `columns` numbers, as `vector` does."""
    return np.full((rows, columns), np.nan)


def indices(count: int) -> NDArray[np.uint64]:
    """Return working space for `count` indices, as `vector` does."""
    return np.full(count, 2**63, np.uint64)


def claim(words: NDArray[np.int64], at: int, old: int, new: int) -> bool:
    """Replace a word if it is `old`, in one act that no other thread can split."""
    if words[at] != old:
        return False
    words[at] = new
    return True


def publish(words: NDArray[np.int64], at: int, value: int) -> None:
    """Write a word so that threads that see it also see what was written before."""
    words[at] = value


def look(words: NDArray[np.int64], at: int) -> Any:
    """Read a word that another thread writes with `publish`."""
    return words[at]


def columns(table: NDArray[np.float64], count: int) -> Any:
    """Return a table of which it is known here that its rows have `count` numbers."""
    del count
    return table


def fetch(table: NDArray[np.float64], row: int) -> None:
    """Ask the processor for a row of a table that will soon be needed."""


def spread(
    table: NDArray[np.float64], column: int, rows: NDArray[np.uint64], c: int,
    block: NDArray[np.float64], first: int, size: int,
) -> None:  # fmt: skip
    """Write four columns of four rows into four fields of a block, a field every `size` numbers."""
    for k in range(c, c + 4):
        for f in range(4):
            block[first + f * size + k] = table[int(rows[k]), column + f]


def collect(
    block: NDArray[np.float64], first: int, size: int, c: int, lines: NDArray[np.float64],
    place: int,
) -> None:  # fmt: skip
    """Write four numbers of four fields of a block to lines of four, the way back of `spread`."""
    for k in range(4):
        for f in range(4):
            lines[place + 4 * k + f] = block[first + f * size + c + k]


def add_four(
    table: NDArray[np.float64], row: int, column: int, line: NDArray[np.float64], at: int
) -> None:
    """Add four neighbouring numbers to a row of a table."""
    for f in range(4):
        table[int(row), column + f] += line[at + f]


def add_two(
    table: NDArray[np.float64], row: int, column: int, line: NDArray[np.float64], at: int
) -> None:
    """Add two neighbouring numbers to a row of a table."""
    for f in range(2):
        table[int(row), column + f] += line[at + f]


def put_four(
    table: NDArray[np.float64], row: int, column: int, line: NDArray[np.float64], at: int
) -> None:
    """Write four neighbouring numbers to a row of a table."""
    for f in range(4):
        table[int(row), column + f] = line[at + f]


def give_way() -> None:
    """Let other threads of the machine run."""
    time.sleep(0)


if COMPILED and CHECKED:
    # every kernel is then compiled at its import, with the functions that it imports from here
    from minidem.kernels.machine.intrinsics import REPLACED

    globals().update(REPLACED)
