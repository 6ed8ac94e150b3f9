"""Read the lists of counted grains that both engines write."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from liggghts_io.errors import DamagedFile
from liggghts_io.measure.thermo import numbers_in

FloatArray = npt.NDArray[np.float64]

_COUNTED: Final = 8  # numbers of a counted grain after its id
_SHOWN: Final = 80  # characters of a wrong line in a message


def text_of(path: Path) -> str:
    """Return what is in a file that an engine wrote.

    Raises
    ------
    DamagedFile
        If it is missing, a directory or no text.
    """
    try:
        return path.read_bytes().decode("utf-8-sig")
    except FileNotFoundError as err:
        msg = f"{path}: missing; did the engine run to the end?"
        raise DamagedFile(msg) from err
    except OSError as err:
        msg = f"{path}: cannot be read ({err.strerror}); name a file that the engine wrote"
        raise DamagedFile(msg) from err
    except UnicodeDecodeError as err:
        msg = f"{path}: not a text file ({err.reason} at byte {err.start}); run the case again"
        raise DamagedFile(msg) from err


@dataclass(frozen=True)
class Count:
    """Grains that fell through a counting plane.

    Attributes
    ----------
    grain : (n,) int64
        Ids, in order of time.
    time_s, mass_kg : (n,) float64
    position_m, velocity_m_s : (n, 3) float64
        Where and how fast it fell through [m], [m/s], to four digits.
    """

    grain: npt.NDArray[np.int64]
    time_s: FloatArray
    mass_kg: FloatArray
    position_m: FloatArray
    velocity_m_s: FloatArray

    def part(self, chosen: npt.NDArray[np.bool_]) -> Count:
        """Return the chosen grains alone, in their order."""
        return Count(
            self.grain[chosen],
            self.time_s[chosen],
            self.mass_kg[chosen],
            self.position_m[chosen],
            self.velocity_m_s[chosen],
        )


def read_count(path: Path, density: float, since: float = 0.0) -> Count:
    """Read a file of `fix massflow/mesh ... count once ... writeTime`.

    A row is `id [ time diameter x y z vx vy vz ]` with whatever follows.

    Parameters
    ----------
    path : Path
    density : float
    since : float
        Time from which grains count [s]. An engine gives the id of a lost grain to the next one, if
        it was the highest; so a grain of a second pour may have that of one before.

    Raises
    ------
    DamagedFile
        If the file is missing or a row is cut, is no such row or repeats a grain.
    """
    text = text_of(path)
    if not text.endswith("\n"):
        msg = f"{path}: empty or cut short; run the case again"
        raise DamagedFile(msg)
    found: dict[int, list[float]] = {}
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
        if counted[1][0] >= since:
            found[counted[0]] = counted[1]
    order = sorted(found, key=lambda one: (found[one], one))
    rows = np.array([found[one] for one in order], dtype=np.float64).reshape(-1, _COUNTED)
    mass = density * math.pi / 6.0 * rows[:, 1] ** 3
    grains = np.array(order, dtype=np.int64)
    return Count(grains, rows[:, 0], mass, rows[:, 2:5], rows[:, 5:8])


def _counted(line: str) -> tuple[int, list[float]] | None:
    """Return id and numbers (time, diameter, place, velocity) of a counted grain, if it is one."""
    words = line.replace("[", " ").replace("]", " ").split()
    if numbers_in(words) is None:
        return None
    try:
        grain, numbers = int(words[0]), [float(word) for word in words[1:]]
    except (IndexError, ValueError):
        return None
    whole = len(numbers) >= _COUNTED and all(math.isfinite(one) for one in numbers)
    if not whole or min(numbers[:2]) < 0.0:
        return None
    return grain, numbers[:_COUNTED]
