"""Read the particle dumps that both engines write."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from liggghts_io.errors import CaseError, DamagedFile
from liggghts_io.measure.schedule import read_schedule
from liggghts_io.measure.text_dump.blocks import blocks_of
from liggghts_io.measure.text_dump.head import Head, head_of
from liggghts_io.measure.text_dump.rows import rows_of

FloatArray = npt.NDArray[np.float64]
POST: Final = "post"
SCRIPT: Final = "in.script"

_HEAD: Final = 9  # lines of a dump before its rows
DRAWN: Final = ("id", "x", "y", "z", "vx", "vy", "vz", "radius")
"""Columns from which a picture is drawn."""
_PLACE: Final = ("id", "x", "y", "z")


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


def read_frame(path: Path, needed: Sequence[str] = DRAWN) -> Frame:
    """Read one `dump custom` file that holds one time step.

    Parameters
    ----------
    path : Path
    needed : sequence of str
        Columns that are asked for; a `radius` follows from a `diameter`.

    Raises
    ------
    DamagedFile
        If the file is missing, cut short, no such dump, lacks a column that is drawn or measured,
        or holds values that no run writes.
    """
    block, *more = blocks_of(path)
    head = head_of(block)
    if more:
        msg = f"{path}:{more[0].line}: a second time step; a frame has a file of its own"
        raise DamagedFile(msg)
    _check_names(path, head, needed)
    rows = rows_of([(block, head)])
    table = {name: rows[name].to_numpy() for name in rows.columns}
    order = np.argsort(table["id"])
    columns = {name: values[order] for name, values in table.items()}
    _check_values(path, columns, head)
    if "radius" not in columns and "diameter" in columns:
        columns["radius"] = np.asarray(columns["diameter"] / 2.0)
    return Frame(head.step, columns)


def _check_names(path: Path, head: Head, needed: Sequence[str]) -> None:
    """Refuse a dump without a column that is asked for."""
    there = {*head.names, *(["radius"] if "diameter" in head.names else [])}
    missing = [name for name in dict.fromkeys((*_PLACE, *needed)) if name not in there]
    if missing:
        msg = f"{path}: no column {', '.join(missing)} in the dump; run the case again"
        raise DamagedFile(msg)


def _check_values(path: Path, columns: Mapping[str, FloatArray], head: Head) -> None:
    """Refuse values that no run writes, of grains in the order of their ids."""
    for word in ("radius", "diameter"):
        if word in columns and (columns[word] <= 0.0).any():
            msg = f"{path}: a {word} is not positive"
            raise DamagedFile(msg)
    if (np.diff(columns["id"]) == 0.0).any():
        msg = f"{path}: two grains have one id"
        raise DamagedFile(msg)
    centres = np.stack([columns[name] for name in "xyz"], axis=1)
    # A grain may leave the box between two neighbour lists, never by the size of the box.
    low, high = head.box[:, 0], head.box[:, 1]
    outside = ((centres < 2.0 * low - high) | (centres > 2.0 * high - low)).any(axis=1)
    if outside.any():
        grain = int(np.argmax(outside))
        where = ", ".join(f"{value:g}" for value in centres[grain])
        msg = f"{path}: grain {columns['id'][grain]:g} at ({where}) is far off the box"
        raise DamagedFile(msg)


def frame_paths(folder: Path, name: str = "") -> list[Path]:
    """Return the frames of a dump that are in a folder of an engine's output, in order of steps.

    Parameters
    ----------
    folder : Path
        With `in.script`; without a script that tells of a dump, frames are those in `post/`.
    name : str
        Of the dump; empty for the one that is drawn.
    """
    try:
        pattern = read_schedule(folder / SCRIPT).dump(name).pattern
    except CaseError:
        pattern = f"{POST}/frame_*.dump"
    return list(_frames(folder, pattern).values())


def _frames(folder: Path, pattern: str) -> dict[int, Path]:
    """Return the files of a dump by step, in order of steps."""
    before, _, after = pattern.partition("*")
    wanted = re.compile(rf"{re.escape(before)}(\d+){re.escape(after)}")
    place = (folder / pattern).parent
    found = {}
    for path in place.iterdir() if place.is_dir() else ():
        match = wanted.fullmatch(path.relative_to(folder).as_posix())
        if match:
            found[int(match[1])] = path
    return dict(sorted(found.items()))


def last_frame_step(folder: Path) -> int:
    """Return the step of the last frame that is there, 0 if none is."""
    frames = frame_paths(folder)
    found = re.findall(r"\d+", frames[-1].name) if frames else []
    return int(found[-1]) if found else 0


def all_frames(folder: Path, name: str = "", last: int | None = None) -> list[Path]:
    """Return the frames of a finished run: those that its script asks for, all, whole, no other.

    Parameters
    ----------
    folder : Path
        With `in.script` and what the engine wrote.
    name : str
        Of the dump; empty for the one that is drawn.
    last : int, optional
        Step at which the run ended, where only the run knows it; without it the last frame counts
        as the end.

    Returns
    -------
    list of Path
        In order of their steps. Where neither the script nor `last` tells the steps, those that
        are there.

    Raises
    ------
    DamagedFile
        If a frame is missing, cut or of another step, or there is one too many.
    """
    dump = read_schedule(folder / SCRIPT).dump(name)
    found = _frames(folder, dump.pattern)
    due = dump.due(max(found, default=0) if last is None else last)
    if due is not None:
        _check_complete(folder, dump.pattern, due, found)
    elif not found:
        msg = f"{folder / dump.pattern}: no frame; the run ended early or lost files"
        raise DamagedFile(msg)
    for step, path in found.items():
        _check_whole(path, step)
    return list(found.values())


def check_all_dumps(folder: Path, last: int | None = None) -> None:
    """Check the frames of every dump of a run as `all_frames` does."""
    for dump in read_schedule(folder / SCRIPT).dumps:
        all_frames(folder, dump.name, last)


def _check_complete(
    folder: Path, pattern: str, due: tuple[int, ...], found: Mapping[int, Path]
) -> None:
    """Refuse a run that lacks a frame or has one too many."""
    missing = [step for step in due if step not in found]
    if missing:
        path = folder / pattern.replace("*", str(missing[0]))
        msg = (
            f"{path}: missing; the run has {len(due)} frames from step {due[0]} to "
            f"{due[-1]}, {len(due) - len(missing)} are there; it ended early or lost files"
        )
        raise DamagedFile(msg)
    for step in found.keys() - set(due):
        every = f", which has one every {due[1] - due[0]} steps" if len(due) > 1 else ""
        msg = f"{found[step]}: no frame of this run{every}"
        raise DamagedFile(msg)


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
