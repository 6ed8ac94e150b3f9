"""A run without records, as extractors look at it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from liggghts_io.errors import CaseError, nearest
from liggghts_io.foreign.columns import missing_of, sizes_of
from liggghts_io.foreign.dump import FrameTable
from liggghts_io.foreign.output import Output
from liggghts_io.measure.dumps import Frame
from liggghts_io.measure.extract import Run
from liggghts_io.measure.extract.grains.boxes import SIZED
from liggghts_io.measure.series import THERMO

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Grains:
    """What a dump may not say of its grains.

    Attributes
    ----------
    density : float, optional
        [kg/m3]; without it, the mean one of the grains where the dump has their mass or density.
    diameter : float, optional
        [m], of all grains.
    """

    density: float | None = None
    diameter: float | None = None


def as_frame(table: FrameTable, needed: Iterable[str], grains: Grains) -> Frame:
    """Return a frame as extractors take it.

    Parameters
    ----------
    table : FrameTable
    needed : iterable of str
        Columns that are asked for.
    grains : Grains

    Raises
    ------
    CaseError
        If a column is missing, with the nearest one that is there.
    """
    wanted = dict.fromkeys((*"xyz", *needed))
    columns = {str(name): np.asarray(table.grains[name], dtype=np.float64) for name in table.grains}
    if "radius" in wanted:
        radius = sizes_of(table.grains, grains.diameter, table.place)
        columns["radius"] = np.asarray(radius, dtype=np.float64)
    missing = missing_of(table.grains, [name for name in wanted if name not in SIZED])
    if missing:
        hint = nearest(missing[0], [str(name) for name in table.grains])
        msg = f"{table.place}: no column {missing[0]}{hint}"
        raise CaseError(msg)
    columns.setdefault("id", np.arange(1.0, len(table.grains) + 1.0))
    return Frame(table.step, columns)


def density_of(table: FrameTable, grains: Grains) -> float:
    """Return the density of the grains [kg/m3], NaN where nobody says it."""
    if grains.density is not None:
        return grains.density
    if "density" in table.grains:
        return float(table.grains["density"].mean())
    if "mass" not in table.grains:
        return math.nan
    volumes = 4.0 / 3.0 * math.pi * sizes_of(table.grains, grains.diameter, table.place) ** 3
    return float(table.grains["mass"].sum() / volumes.sum()) if len(volumes) else math.nan


class ForeignRun(Run):
    """A run without records, as extractors look at it.

    Parameters
    ----------
    output : Output
    grains : Grains
    names : Mapping[str, float]
        What formulas may hold.
    frame : FrameTable
        The only frame, or the last one where `whole` is asked for.
    whole : bool
        Whether other frames are read when an extractor asks for them.
    """

    def __init__(
        self,
        output: Output,
        grains: Grains,
        names: Mapping[str, float],
        frame: FrameTable,
        *,
        whole: bool,
    ) -> None:
        super().__init__(output.root, density_of(frame, grains), names)
        self._output, self._grains, self._frame, self._whole = output, grains, frame, whole

    def column(self, file: str, name: str) -> FloatArray:
        """Return a column of the log's thermo table, or of another table in the folder."""
        if file != THERMO or self._output.log is None:
            return super().column(file, name)
        thermo = self._output.thermo
        if name not in thermo:
            hint = nearest(name, list(map(str, thermo)))
            msg = f"{self._output.log.name}: no column {name!r}{hint}"
            raise CaseError(msg)
        return np.asarray(thermo[name], dtype=np.float64)

    def frames(
        self, dump: str, part: tuple[float, float] | None, needed: tuple[str, ...]
    ) -> list[Frame]:
        """Return the only frame, or the last one, or those in a part of the frames."""
        if part is None or not self._whole:
            return [as_frame(self._frame, needed, self._grains)]
        wanted = part_of(len(self._output.dump.steps), part)
        return [as_frame(one, needed, self._grains) for one in self._output.frames(wanted)]


def part_of(count: int, part: tuple[float, float] | None) -> range:
    """Return the numbers of the frames in a part of them, the last one where no part is given."""
    last = count - 1
    if part is None or last == 0:
        return range(last, count)
    low, high = math.ceil(part[0] * last - 1e-9), math.floor(part[1] * last + 1e-9)
    return range(low, high + 1) if low <= high else range(last, count)
