"""One dump of somebody else's run: which frames it has, and what stands in them."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from liggghts_io.errors import DamagedFile
from liggghts_io.foreign.columns import SI, in_si
from liggghts_io.foreign.vtk_files import VtkReader
from liggghts_io.measure.dump_rows import rows_of
from liggghts_io.measure.dump_text import Block, Head, blocks_of, head_of, is_cut, missing_rows

TEXT: Final = "text"
VTK: Final = "VTK"
_BATCH: Final = 1 << 20  # bytes of small frames that are read at once
_DIGITS: Final = re.compile(r"\d+")


@dataclass(frozen=True)
class FrameTable:
    """One frame of a dump.

    Attributes
    ----------
    step : int
    grains : DataFrame
        A row for each grain in the order of the file, a column for each quantity, in SI units.
    place : str
        Where it stands: file and, in a text, line.
    """

    step: int
    grains: pd.DataFrame
    place: str


@dataclass(frozen=True)
class Series:
    """Files that one dump wrote.

    Attributes
    ----------
    name : str
        Of the file, or with ``*`` for the number in which several differ.
    kind : str
        "text" or "VTK".
    files : tuple of Path
        In the order of that number.
    """

    name: str
    kind: str
    files: tuple[Path, ...]


@dataclass(frozen=True)
class Dump:
    """Frames of a dump that can be used.

    Attributes
    ----------
    series : Series
    steps : tuple of int
        Of every frame, in the order of the files.
    columns : tuple of str
        As the files name them.
    notes : tuple of str
        What was left out, and what is odd.
    """

    series: Series
    steps: tuple[int, ...]
    columns: tuple[str, ...]
    notes: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """Name of the series."""
        return self.series.name


def index_of(series: Series) -> Dump:
    """Return the frames of a series, without their numbers.

    A frame that was not written to its end, as the last one of a run that was stopped, is left
    out and noted.

    Raises
    ------
    DamagedFile
        If a frame is damaged in another way, or has other columns than the first, with file and
        line; if none is whole.
    """
    found = _vtk_index(series) if series.kind == VTK else _text_index(series)
    back = next((k for k in range(1, len(found.steps)) if found.steps[k] < found.steps[k - 1]), 0)
    if back:
        note = (
            f"{series.name}: steps go back from {found.steps[back - 1]} to {found.steps[back]}; if "
            "these are two runs, name the files of one with --dump"
        )
        return Dump(series, found.steps, found.columns, (*found.notes, note))
    return found


def _text_index(series: Series) -> Dump:
    steps: list[int] = []
    notes: list[str] = []
    columns: tuple[str, ...] = ()
    first = ""
    for path in series.files:
        for block in blocks_of(path):
            head = _whole(block)
            if isinstance(head, str):
                notes.append(f"{head}; this frame is left out")
                continue
            if first and set(head.names) != set(columns):
                raise DamagedFile(_differ(f"{block.path}:{block.line}", head.names, first, columns))
            if not first:
                first, columns = f"{block.path}:{block.line}", head.names
            steps.append(head.step)
    if not steps:
        raise DamagedFile(notes[0])
    return Dump(series, tuple(steps), columns, tuple(notes))


def _whole(block: Block) -> Head | str:
    """Return the head of a frame, or how the frame is cut at the end of its file."""
    try:
        head = head_of(block)
    except DamagedFile as err:
        if is_cut(block, None):
            return str(err)
        raise
    short = missing_rows(block, head)
    if short and not is_cut(block, head):
        msg = f"{short}; the file was changed or written by two runs"
        raise DamagedFile(msg)
    return short or head


def _differ(place: str, names: Collection[str], first: str, columns: Collection[str]) -> str:
    other = sorted(set(names) ^ set(columns))
    return (
        f"{place}: {', '.join(other)} only here or only in {first}: two dumps of different "
        "columns; keep them in files of their own"
    )


def _vtk_index(series: Series) -> Dump:
    """Return the files as frames; only those at the begin and the last one are read."""
    with VtkReader() as reader:
        columns = _vtk_columns(reader, series.files)
        files, notes = list(series.files), []
        try:
            reader.read(files[-1])
        except DamagedFile as err:
            notes.append(f"{err}; this frame is left out")
            files.pop()
    kept = Series(series.name, series.kind, tuple(files))
    return Dump(kept, tuple(map(number_of, files)), columns, tuple(notes))


def _vtk_columns(reader: VtkReader, files: Sequence[Path]) -> tuple[str, ...]:
    """Return the columns of the first frame with grains; one without may not name them."""
    for path in files:
        grains = reader.read(path)
        if len(grains):
            break
    return tuple(map(str, grains.columns))


def number_of(path: Path) -> int:
    """Return the last number in the name of a file, 0 where there is none."""
    found = _DIGITS.findall(path.name)
    return int(found[-1]) if found else 0


def frames_of(
    dump: Dump, units: str = SI, wanted: Collection[int] | None = None
) -> Iterator[FrameTable]:
    """Yield the frames of a dump one by one; only one is in memory.

    Parameters
    ----------
    dump : Dump
    units : str
        System of units of the files.
    wanted : collection of int, optional
        Numbers of the frames that are read, from 0; all where it is not given.

    Raises
    ------
    DamagedFile
        If a row is not one of numbers, with file and line, or VTK cannot read a file.
    """
    last = len(dump.steps) - 1 if wanted is None else max(wanted, default=-1)
    every = _vtk_frames(dump, units, wanted)
    if dump.series.kind == TEXT:
        every = _text_frames(dump, units, wanted)
    for number, frame in every:
        yield frame
        if number == last:
            return


def _text_frames(
    dump: Dump, units: str, wanted: Collection[int] | None
) -> Iterator[tuple[int, FrameTable]]:
    batch: list[tuple[int, Block, Head]] = []
    for number, block, head in _whole_frames(dump, wanted):
        size = sum(len(one.content) for _, one, _ in batch)
        if batch and (size > _BATCH or head.names != batch[0][2].names):
            yield from _split(batch, units)
            batch = []
        batch.append((number, block, head))
    if batch:
        yield from _split(batch, units)


def _whole_frames(dump: Dump, wanted: Collection[int] | None) -> Iterator[tuple[int, Block, Head]]:
    """Yield number, text and head of the frames that are wanted."""
    number = 0
    for path in dump.series.files:
        for block in blocks_of(path):
            head = _whole(block)
            if isinstance(head, str):
                continue
            if wanted is None or number in wanted:
                yield number, block, head
            number += 1


def _split(
    batch: Sequence[tuple[int, Block, Head]], units: str
) -> Iterator[tuple[int, FrameTable]]:
    """Read some frames at once and yield them one by one."""
    rows = rows_of([(block, head) for _, block, head in batch])
    counts = [head.count for _, _, head in batch]
    box = np.repeat(np.array([head.cell for _, _, head in batch]), counts, axis=0)
    grains = in_si(rows, units, box)
    start = 0
    for (number, block, head), count in zip(batch, counts, strict=True):
        part = grains.iloc[start : start + count].reset_index(drop=True)
        yield number, FrameTable(head.step, part, f"{block.path}:{block.line}")
        start += count


def _vtk_frames(
    dump: Dump, units: str, wanted: Collection[int] | None
) -> Iterator[tuple[int, FrameTable]]:
    with VtkReader() as reader:
        for number, path in enumerate(dump.series.files):
            if wanted is not None and number not in wanted:
                continue
            grains = reader.read(path)
            if grains.empty:
                grains = grains.reindex(columns=list(dump.columns))
            if set(grains.columns) != set(dump.columns):
                first = str(dump.series.files[0])
                names = list(map(str, grains.columns))
                raise DamagedFile(_differ(str(path), names, first, dump.columns))
            yield number, FrameTable(number_of(path), in_si(grains, units), str(path))
