"""What somebody else's run left in a folder: its dumps, frame by frame, and its log."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import pandas as pd

from liggghts_io.errors import CaseError, nearest
from liggghts_io.foreign.columns import SI, UNITS, checked_units
from liggghts_io.foreign.dump import Dump, FrameTable, Series, frames_of, index_of
from liggghts_io.foreign.files import Files, described, find_files, units_said
from liggghts_io.foreign.log import Log, read_log


@dataclass(frozen=True)
class Output:
    """Output of a run that has no records of this package.

    Attributes
    ----------
    root, place : Path
        Folder, and the folder or file that was named.
    series : tuple of Series
        Its dumps, the one that is measured first.
    log : Log, optional
    units : str
        System of units of the run, of `UNITS`.
    dt : float, optional
        Time step [s].
    remarks : tuple of str
        What was passed over, one sentence each.
    """

    root: Path
    place: Path
    series: tuple[Series, ...]
    log: Log | None
    units: str
    dt: float | None
    remarks: tuple[str, ...]

    def first(self) -> Series:
        """Return the dump that is measured, not read yet.

        Raises
        ------
        CaseError
            If there is none.
        """
        if not self.series:
            why = f"; {described(self.place)}" if self.place.is_file() else ""
            msg = (
                f"{self.place}: no dump of grains (dump custom, custom/vtk, atom/vtk; also .gz)"
                f"{why}; name the folder or file with the dumps"
            )
            raise CaseError(msg)
        return self.series[0]

    @cached_property
    def dump(self) -> Dump:
        """The dump that is measured, its frames counted.

        Raises
        ------
        CaseError
            If there is none, or it is damaged in its midst.
        """
        return index_of(self.first())

    @property
    def notes(self) -> tuple[str, ...]:
        """What was passed over and, in the dump that is measured, left out."""
        return (*self.remarks, *self.dump.notes)

    def frames(self, wanted: Collection[int] | None = None) -> Iterator[FrameTable]:
        """Yield the frames of the dump that is measured, one by one, in SI units.

        Parameters
        ----------
        wanted : collection of int, optional
            Numbers of the frames that are read, from 0; all where it is not given.
        """
        return frames_of(self.dump, self.units, wanted)

    def time_of(self, step: int) -> float | None:
        """Return the time of a step [s], None where the time step is not known."""
        return None if self.dt is None else step * self.dt

    @property
    def thermo(self) -> pd.DataFrame:
        """Thermo table of the log, empty where there is none."""
        return pd.DataFrame() if self.log is None else self.log.thermo


def read_output(place: Path, dump: str = "", units: str = "", dt: float | None = None) -> Output:
    """Look at what a run left, without reading its frames.

    Parameters
    ----------
    place : Path
        A folder, or one file of a dump.
    dump : str
        Name of the dump that is measured, as it is listed or of one file of it; without it, the
        one with sizes and most files.
    units : str
        System of units of the run; without it, that which the dump says, or the log, else "si".
    dt : float, optional
        Time step [s]; without it, that of the log.

    Raises
    ------
    CaseError
        If there is no such place, dump or system of units.
    """
    files = find_files(place)
    series = _chosen(files, dump)
    log, remarks = _log_of(files)
    word, who = (units, "") if units else _units_said(series, log, remarks)
    units = checked_units(word, who)
    if dt is None and log is not None and log.dt is not None:
        dt = log.dt * UNITS[units][-1]
    return Output(files.root, place, series, log, units, dt, (*files.notes, *remarks))


def _chosen(files: Files, dump: str) -> tuple[Series, ...]:
    """Return all dumps, or the one that is named."""
    if not dump:
        return files.series
    series = tuple(one for one in files.series if one.name == dump)
    if not series and (files.root / dump).is_file():
        series = find_files(files.root / dump).series
    if not series:
        hint = nearest(dump, [one.name for one in files.series])
        msg = f"--dump {dump}: no such dump{hint}"
        raise CaseError(msg)
    return series


def _units_said(series: Sequence[Series], log: Log | None, remarks: list[str]) -> tuple[str, str]:
    """Return the word for units that the dump, else the log says, and which of them; else SI."""
    of_dump = units_said(series[0]) if series else ""
    of_log = log.units if log else ""
    if of_dump and of_log and of_dump != of_log:
        remarks.append(f"{series[0].name}: units {of_dump}, not {of_log} as in the log")
    if of_dump:
        return of_dump, series[0].name
    return (of_log, log.name) if log and of_log else (SI, "")


def _log_of(files: Files) -> tuple[Log | None, list[str]]:
    """Return the first log, and what is odd about it."""
    logs = files.logs or files.beside
    if not logs:
        return None, []
    name = logs[0].relative_to(files.root).as_posix() if files.logs else str(logs[0])
    log = read_log(logs[0], name)
    remarks = [] if files.logs else [f"{name}: time step and units are taken from there"]
    if len(logs) > 1:
        remarks.append(f"{len(logs)} logs; {name} is read")
    return log, [*log.notes, *remarks]
