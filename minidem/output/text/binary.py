"""``dump custom`` into a file whose name ends in ``.bin``: numbers as the machine has them."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

__all__ = ["binary_frame"]

_FACES: Final = "pfsm"
"""Letters of a boundary, in the order of their numbers."""
_NOT_TILTED: Final = 0
_PARTS: Final = 1  # processes that write, each a part


def binary_frame(
    step: int,
    box: NDArray[np.float64],
    boundary: tuple[str, str, str],
    columns: Sequence[NDArray[Any]],
) -> bytes:
    """Return one frame, byte for byte as LIGGGHTS 3.8.0 writes it; names of columns are not in it.

    Parameters
    ----------
    step : int
        Time step.
    box : (2, 3) ndarray
        Lower and upper corner of the simulation box, m.
    boundary : tuple of str
        Per axis one letter, or two for lower and upper face: p, f, s or m.
    columns : sequence of (N,) ndarray
        Numbers in the order of the dump command.
    """
    count = len(columns[0])
    faces = [_FACES.index(face) for one in boundary for face in (one * 2)[:2]]
    head = struct.pack("<qq7i6d", step, count, _NOT_TILTED, *faces, *box.T.ravel())
    sizes = struct.pack("<3i", len(columns), _PARTS, count * len(columns))
    return head + sizes + np.stack(columns, axis=1).astype("<f8").tobytes()
