"""What somebody else's run left in a folder: its dumps, frame by frame, and its log."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import pandas as pd

from liggghts_io.errors import CaseError, nearest
from liggghts_io.foreign.columns import SI, UNITS, checked_units
from liggghts_io.foreign.dump import Dump, FrameTable, Series, frames_of, index_of
from liggghts_io.foreign.files import find_files
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
            msg = (
                f"{self.place}: no dump of grains (dump custom, custom/vtk, atom/vtk; also .gz); "
                "name the folder or file with the dumps"
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
        System of units of the run; without it, that of the log, else "si".
    dt : float, optional
        Time step [s]; without it, that of the log.

    Raises
    ------
    CaseError
        If there is no such place, dump or system of units.
    """
    files = find_files(place)
    series = files.series
    if dump:
        series = tuple(one for one in series if one.name == dump)
        if not series and (files.root / dump).is_file():
            series = find_files(files.root / dump).series
        if not series:
            hint = nearest(dump, [one.name for one in files.series])
            msg = f"--dump {dump}: no such dump{hint}"
            raise CaseError(msg)
    logs = [(path, path.relative_to(files.root).as_posix()) for path in files.logs]
    log = read_log(*logs[0]) if logs else None
    remarks = [*files.notes, *(log.notes if log else ())]
    if len(logs) > 1:
        remarks.append(f"{len(logs)} logs; {logs[0][1]} is read")
    units = checked_units(units or (log.units if log else "") or SI)
    if dt is None and log is not None and log.dt is not None:
        dt = log.dt * UNITS[units][-1]
    return Output(files.root, place, series, log, units, dt, tuple(remarks))
