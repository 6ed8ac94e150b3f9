"""One dump of somebody else's run: which frames it has, and what stands in them."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from liggghts_io.errors import DamagedFile
from liggghts_io.foreign.binary_dump import blocks_of
from liggghts_io.foreign.columns import SI, UNITS, check_ids, in_si
from liggghts_io.foreign.vtk_files import TAKE_OUT, VtkReader
from liggghts_io.measure.text_dump.blocks import Block
from liggghts_io.measure.text_dump.head import Head, head_of, is_cut, missing_rows
from liggghts_io.measure.text_dump.rows import rows_of

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
    time_s : float, optional
        Time of the frame [s], where the dump has one.
    """

    step: int
    grains: pd.DataFrame
    place: str
    time_s: float | None = None


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
    return replace(found, notes=(*found.notes, *_notes_of(series.name, found.steps)))


def _notes_of(name: str, steps: Sequence[int]) -> list[str]:
    """Return what is odd about the order of steps: two runs, or one that was continued."""
    back = next((k for k in range(1, len(steps)) if steps[k] < steps[k - 1]), 0)
    if back:
        return [
            f"{name}: steps go back from {steps[back - 1]} to {steps[back]}; if these are two runs "
            "in several files, name the files of one with --dump"
        ]
    twice = [steps[k] for k in range(1, len(steps)) if steps[k] == steps[k - 1]]
    if twice:
        return [
            f"{name}: step {twice[0]} stands there twice, as in a run that was continued "
            f"({len(twice)} such steps); every frame is measured"
        ]
    return []


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
            if block.cut:
                notes.append(f"{path}: {block.cut}; frames behind it are lost")
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
            last = reader.read(files[-1])
            missing = sorted(set(columns) - set(last)) if len(last) and len(files) > 1 else []
            why = f"{files[-1]}: ends before {', '.join(missing)}" if missing else ""
        except DamagedFile as err:
            why = str(err).removesuffix(TAKE_OUT)
        if why:
            notes.append(f"{why}; this frame is left out")
            files.pop()
    kept = Series(series.name, series.kind, tuple(files))
    steps = tuple(number_of(path, series.name) for path in files)
    return Dump(kept, steps, columns, tuple(notes))


def _vtk_columns(reader: VtkReader, files: Sequence[Path]) -> tuple[str, ...]:
    """Return the columns of the first frame with grains; one without may not name them."""
    for path in files:
        grains = reader.read(path)
        if len(grains):
            break
    return tuple(map(str, grains.columns))


def number_of(path: Path, name: str) -> int:
    """Return the number at the ``*`` in the name of its series, else the last one, else 0."""
    before, star, behind = name.rpartition("/")[2].partition("*")
    inner = path.name.removeprefix(before).removesuffix(behind)
    found = [inner] if star and inner.isdecimal() else _DIGITS.findall(path.name)
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
        place = f"{block.path}:{block.line}"
        check_ids(part, f"{place}: step {head.step}")
        time = None if head.time is None else head.time * UNITS[units][-1]
        yield number, FrameTable(head.step, part, place, time)
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
            found = in_si(grains, units)
            check_ids(found, str(path))
            yield number, FrameTable(number_of(path, dump.name), found, str(path))
