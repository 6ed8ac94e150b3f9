"""A finished run, as extractors look at it; what is read is kept for the next one."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from liggghts_io.measure.arithmetic import evaluate
from liggghts_io.measure.dumps import Frame, all_frames, read_frame
from liggghts_io.measure.series import FloatArray, column_of, read_series


class Run:
    """A finished run.

    Parameters
    ----------
    folder : Path
        With `in.script` and what the engine wrote.
    density : float
        Of the grains [kg/m3].
    names : Mapping[str, float]
        What formulas may hold: the parameters of the experiment and `d32_m`.
    """

    def __init__(self, folder: Path, density: float, names: Mapping[str, float]) -> None:
        self.folder, self.density, self._names = folder, density, names
        self._series: dict[str, dict[str, FloatArray]] = {}
        self._paths: dict[str, list[Path]] = {}

    def amount(self, value: float | str) -> float:
        """Return the value of a number or a formula."""
        return evaluate(value, self._names) if isinstance(value, str) else value

    def column(self, file: str, name: str) -> FloatArray:
        """Return a column of a table that the run wrote, shape (n,)."""
        path = self.folder / file
        if file not in self._series:
            self._series[file] = read_series(path, self.density)
        return column_of(self._series[file], name, path)

    def frames(
        self, dump: str, part: tuple[float, float] | None, needed: tuple[str, ...]
    ) -> list[Frame]:
        """Return the last frame of a dump, or those in a part of its frames."""
        if dump not in self._paths:
            self._paths[dump] = all_frames(self.folder, dump)
        paths = self._paths[dump]
        last = len(paths) - 1
        if part is None or last == 0:
            return [read_frame(paths[-1], needed)]
        low, high = part[0] * last, part[1] * last
        chosen = [path for k, path in enumerate(paths) if low - 1e-9 <= k <= high + 1e-9]
        return [read_frame(path, needed) for path in chosen or paths[-1:]]
