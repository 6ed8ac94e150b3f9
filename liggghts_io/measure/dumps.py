"""Read what both engines write: particle dumps and lists of counted grains."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from liggghts_io.errors import DamagedFile
from liggghts_io.measure.schedule import read_schedule

FloatArray = npt.NDArray[np.float64]
POST: Final = "post"
SCRIPT: Final = "in.script"

_HEAD: Final = 9  # lines of a dump before its rows
_COLUMNS: Final = ("id", "x", "y", "z", "vx", "vy", "vz", "radius")
_COUNTED: Final = 8  # numbers of a counted grain after its id
_SHOWN: Final = 80  # characters of a wrong line in a message
_FRAME: Final = re.compile(r"frame_(\d+)\.dump")


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
    DamagedFile
        If the file is missing, cut short, no such dump, lacks a column that is drawn or measured,
        or holds values that no run writes.
    """
    lines = _text(path).splitlines()
    step, count, names = _head(path, lines)
    try:
        table = np.array(" ".join(lines[_HEAD:]).split(), dtype=np.float64)
        table = table.reshape(count, len(names))
    except ValueError as err:
        msg = f"{path}: rows do not have the {len(names)} columns of the head"
        raise DamagedFile(msg) from err
    _check_table(path, table, names, lines)
    table = table[np.argsort(table[:, names.index("id")])]
    return Frame(step, {name: table[:, k] for k, name in enumerate(names)})


def _text(path: Path) -> str:
    try:
        return path.read_bytes().decode("ascii")
    except FileNotFoundError as err:
        msg = f"{path}: missing; did the engine run to the end?"
        raise DamagedFile(msg) from err
    except UnicodeDecodeError as err:
        msg = f"{path}: not a text file ({err.reason} at byte {err.start}); run the case again"
        raise DamagedFile(msg) from err


def _head(path: Path, lines: list[str]) -> tuple[int, int, list[str]]:
    """Return step, number of grains and names of the columns; check the number of lines."""
    try:
        step, count = int(lines[1]), int(lines[3])
        names = lines[_HEAD - 1].split()[2:]
    except (IndexError, ValueError) as err:
        msg = f"{path}: not a particle dump with one time step"
        raise DamagedFile(msg) from err
    if lines[0] != "ITEM: TIMESTEP" or len(lines) != _HEAD + count:
        rows = len(lines) - _HEAD
        msg = f"{path}: the head announces {count} grains, the file holds {rows} lines"
        raise DamagedFile(msg)
    missing = [name for name in _COLUMNS if name not in names]
    if missing:
        msg = f"{path}: no column {', '.join(missing)} in the dump; run the case again"
        raise DamagedFile(msg)
    return step, count, names


def _check_table(path: Path, table: FloatArray, names: list[str], lines: list[str]) -> None:
    """Refuse values that no run writes."""
    if not np.isfinite(table).all():
        msg = f"{path}: a value is not finite"
        raise DamagedFile(msg)
    if (table[:, names.index("radius")] <= 0.0).any():
        msg = f"{path}: a radius is not positive"
        raise DamagedFile(msg)
    if len(np.unique(table[:, names.index("id")])) != len(table):
        msg = f"{path}: two grains have one id"
        raise DamagedFile(msg)
    try:
        box = np.array([line.split() for line in lines[5:8]], dtype=np.float64).reshape(3, 2)
    except ValueError as err:
        msg = f"{path}: lines 6 to 8 are no bounds of a box"
        raise DamagedFile(msg) from err
    centres = table[:, [names.index(name) for name in "xyz"]]
    # A grain may leave the box between two neighbour lists, never by the size of the box.
    size = box[:, 1] - box[:, 0]
    outside = ((centres < box[:, 0] - size) | (centres > box[:, 1] + size)).any(axis=1)
    if outside.any():
        grain = int(np.argmax(outside))
        where = ", ".join(f"{value:g}" for value in centres[grain])
        msg = f"{path}: grain {table[grain, names.index('id')]:g} at ({where}) is far off the box"
        raise DamagedFile(msg)


def frame_paths(folder: Path) -> list[Path]:
    """Return the frames that are in a folder of an engine's output, in order of their steps."""
    found = {path: _FRAME.fullmatch(path.name) for path in (folder / POST).glob("frame_*.dump")}
    steps = {path: int(match[1]) for path, match in found.items() if match}
    return sorted(steps, key=lambda path: steps[path])


def all_frames(folder: Path) -> list[Path]:
    """Return the frames of a finished run: those that its script asks for, all, whole, no other.

    Parameters
    ----------
    folder : Path
        With `in.script` and what the engine wrote.

    Raises
    ------
    DamagedFile
        If a frame is missing, cut or of another step, or there is one too many.
    """
    due = read_schedule(folder / SCRIPT).frames
    found = {path.name: path for path in (folder / POST).glob("frame_*")}
    wanted = {f"frame_{step}.dump": step for step in due}
    missing = [name for name in wanted if name not in found]
    if missing:
        msg = (
            f"{folder / POST / missing[0]}: missing; the run has {len(due)} frames from step 0 to "
            f"{due[-1]}, {len(wanted) - len(missing)} are there; it ended early or lost files"
        )
        raise DamagedFile(msg)
    for name in sorted(found.keys() - wanted.keys()):
        msg = f"{found[name]}: no frame of this run, which has one every {due[1] - due[0]} steps"
        raise DamagedFile(msg)
    for name, step in wanted.items():
        _check_whole(found[name], step)
    return [found[name] for name in wanted]


def _check_whole(path: Path, step: int) -> None:
    """Refuse a frame that is cut or of another step, without reading its numbers."""
    content = path.read_bytes()
    head = content.split(b"\n", 4)
    try:
        own, count = int(head[1]), int(head[3])
    except (IndexError, ValueError) as err:
        msg = f"{path}: not a particle dump with one time step"
        raise DamagedFile(msg) from err
    if own != step:
        msg = f"{path}: the file says step {own}"
        raise DamagedFile(msg)
    if content.count(b"\n") != _HEAD + count or not content.endswith(b"\n"):
        rows = content.count(b"\n") - _HEAD
        msg = f"{path}: the head announces {count} grains, the file holds {rows} whole lines"
        raise DamagedFile(msg)


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
    text = _text(path)
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
