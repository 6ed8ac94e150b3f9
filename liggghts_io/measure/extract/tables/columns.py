"""A column of a table against another."""

from __future__ import annotations

from liggghts_io.measure.extract.base import CurveExtractor, FileName, FloatArray, Word
from liggghts_io.measure.extract.run import Run


class Columns(CurveExtractor):
    """A column of a table against another.

    Attributes
    ----------
    file : str
        What a `fix print` or `fix massflow/mesh` writes, or `log.liggghts`.
    x, y : str
        Columns: what the levels are levels of, and what is compared there.
    """

    file: FileName
    x: Word
    y: Word

    def read(self, run: Run) -> tuple[FloatArray, FloatArray]:
        """Return both columns."""
        return run.column(self.file, self.x), run.column(self.file, self.y)
