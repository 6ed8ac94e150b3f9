"""Read what both engines write: particle dumps and lists of counted grains."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from liggghts_io.errors import CaseError

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Frame:
    """One dump.

    Attributes
    ----------
    step : int
    columns : dict of str to (n,) float64
        Quantities in the order of the dump, sorted by id.
    """

    step: int
    columns: dict[str, FloatArray]

    @property
    def count(self) -> int:
        """Number of grains."""
        return len(self.columns["id"])

    @property
    def positions(self) -> FloatArray:
        """Return centres, shape (n, 3) [m]."""
        return np.stack([self.columns[name] for name in "xyz"], axis=1)

    @property
    def speeds(self) -> FloatArray:
        """Return speeds, shape (n,) [m/s]."""
        velocity = np.stack([self.columns[name] for name in ("vx", "vy", "vz")], axis=1)
        return np.asarray(np.linalg.norm(velocity, axis=1), dtype=np.float64)


def read_frame(path: Path) -> Frame:
    """Read one `dump custom` file that holds one time step.

    Raises
    ------
    CaseError
        If the file is cut short, holds no such dump or values that are not finite.
    """
    lines = path.read_text(encoding="utf-8").splitlines()
    try:
        step, count = int(lines[1]), int(lines[3])
        names = lines[8].split()[2:]
    except (IndexError, ValueError) as err:
        msg = f"{path}: not a particle dump with one time step"
        raise CaseError(msg) from err
    rows = lines[9 : 9 + count]
    if lines[0] != "ITEM: TIMESTEP" or len(rows) != count or len(lines) > 9 + count:
        msg = f"{path}: the head announces {count} grains, the file holds {len(lines) - 9} lines"
        raise CaseError(msg)
    try:
        table = np.array(" ".join(rows).split(), dtype=np.float64).reshape(count, len(names))
    except ValueError as err:
        msg = f"{path}: rows do not have the {len(names)} columns of the head"
        raise CaseError(msg) from err
    if not np.isfinite(table).all():
        msg = f"{path}: a value is not finite"
        raise CaseError(msg)
    if "id" in names:
        table = table[np.argsort(table[:, names.index("id")])]
    return Frame(step, {name: table[:, k] for k, name in enumerate(names)})


def frame_paths(directory: Path) -> list[Path]:
    """Return the frames of a case in order of their steps."""
    found = (directory / "post").glob("frame_*.dump")
    return sorted(found, key=lambda path: int(path.stem.rsplit("_", 1)[1]))


def frames(directory: Path, last: int) -> Iterator[Frame]:
    """Read the last frames of a case.

    Raises
    ------
    CaseError
        If the case has no frame.
    """
    paths = frame_paths(directory)
    if not paths:
        msg = f"{directory / 'post'}: no frame_*.dump; did the engine run?"
        raise CaseError(msg)
    return (read_frame(path) for path in paths[-last:])


@dataclass(frozen=True)
class Count:
    """Grains that fell through a counting plane.

    Attributes
    ----------
    time_s, mass_kg : (n,) float64
        In order of time.
    """

    time_s: FloatArray
    mass_kg: FloatArray


def read_count(path: Path, density: float) -> Count:
    """Read a file of `fix massflow/mesh ... count once ... writeTime`: `id [ time diameter ... ]`.

    Raises
    ------
    CaseError
        If the file is missing or a row has no time or diameter.
    """
    if not path.is_file():
        msg = f"{path}: missing; did the engine run to the end?"
        raise CaseError(msg)
    found: list[tuple[float, float]] = []
    for line_number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        words = line.replace("[", " ").replace("]", " ").split()
        try:
            found.append((float(words[1]), float(words[2])))
        except (IndexError, ValueError) as err:
            msg = f"{path}:{line_number}: expected 'id [ time diameter ... ]', got {line!r}"
            raise CaseError(msg) from err
    pairs = np.array(sorted(found), dtype=np.float64).reshape(-1, 2)
    return Count(pairs[:, 0], density * math.pi / 6.0 * pairs[:, 1] ** 3)
