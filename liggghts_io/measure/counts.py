"""Read the lists of counted grains that both engines write."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from liggghts_io.errors import DamagedFile

FloatArray = npt.NDArray[np.float64]

_COUNTED: Final = 8  # numbers of a counted grain after its id
_SHOWN: Final = 80  # characters of a wrong line in a message


def text_of(path: Path) -> str:
    """Return what is in a file that an engine wrote.

    Raises
    ------
    DamagedFile
        If it is missing or no text.
    """
    try:
        return path.read_bytes().decode("ascii")
    except FileNotFoundError as err:
        msg = f"{path}: missing; did the engine run to the end?"
        raise DamagedFile(msg) from err
    except UnicodeDecodeError as err:
        msg = f"{path}: not a text file ({err.reason} at byte {err.start}); run the case again"
        raise DamagedFile(msg) from err


@dataclass(frozen=True)
class Count:
    """Grains that fell through a counting plane.

    Attributes
    ----------
    time_s, mass_kg : (n,) float64
        In order of time.
    x_m : (n,) float64
        Where it fell through [m], to four digits.
    """

    time_s: FloatArray
    mass_kg: FloatArray
    x_m: FloatArray


def read_count(path: Path, density: float) -> Count:
    """Read a file of `fix massflow/mesh ... count once ... writeTime`.

    A row is `id [ time diameter x y z vx vy vz ]` with whatever follows.

    Raises
    ------
    DamagedFile
        If the file is missing or a row is cut, is no such row or repeats a grain.
    """
    text = text_of(path)
    if not text.endswith("\n"):
        msg = f"{path}: empty or cut short; run the case again"
        raise DamagedFile(msg)
    found: dict[int, tuple[float, float, float]] = {}
    for line_number, line in enumerate(text.splitlines(), start=1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        counted = _counted(line)
        if counted is None or counted[0] in found:
            msg = (
                f"{path}:{line_number}: expected 'id [ time diameter x y z vx vy vz ... ]', each "
                f"grain once, got {line[:_SHOWN]!r}"
            )
            raise DamagedFile(msg)
        found[counted[0]] = counted[1:]
    rows = np.array(sorted(found.values()), dtype=np.float64).reshape(-1, 3)
    return Count(rows[:, 0], density * math.pi / 6.0 * rows[:, 1] ** 3, rows[:, 2])


def _counted(line: str) -> tuple[int, float, float, float] | None:
    """Return id, time [s], diameter [m] and x [m] of a counted grain, None if a row is none."""
    words = line.replace("[", " ").replace("]", " ").split()
    try:
        grain, numbers = int(words[0]), [float(word) for word in words[1:]]
    except (IndexError, ValueError):
        return None
    whole = len(numbers) >= _COUNTED and all(math.isfinite(one) for one in numbers)
    if not whole or min(numbers[:2]) < 0.0:
        return None
    return grain, numbers[0], numbers[1], numbers[2]
