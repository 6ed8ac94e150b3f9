"""Values of a dump column of the grains in a box."""

from __future__ import annotations

from liggghts_io.errors import CaseError
from liggghts_io.measure.extract.base import FloatArray, Word
from liggghts_io.measure.extract.grains.boxes import GrainNumber
from liggghts_io.measure.extract.run import Run


class OfValues(GrainNumber):
    """A number of one dump column of the grains in a box.

    Attributes
    ----------
    column : str
        Column of the dump, `z` for example, or `speed`.
    """

    column: Word

    def values_of(self, run: Run) -> list[FloatArray]:
        """Return the values in every frame that has a grain in the box, shapes (n,).

        Raises
        ------
        CaseError
            If no frame has one.
        """
        speed = self.column == "speed"
        needed = ("vx", "vy", "vz") if speed else (self.column,)
        frames = [frame for frame in self.frames_of(run, needed) if frame.count]
        if not frames:
            msg = f"no grain in the box, so that {self.column} has no value there"
            raise CaseError(msg)
        return [frame.speeds if speed else frame.columns[self.column] for frame in frames]
