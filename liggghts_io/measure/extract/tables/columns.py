"""A column of a table against another."""

from __future__ import annotations

from liggghts_io.measure.extract.base import Amount, CurveExtractor, FileName, FloatArray, Word
from liggghts_io.measure.extract.run import Run


class Columns(CurveExtractor):
    """A column of a table against another.

    Attributes
    ----------
    file : str
        What a `fix print` or `fix massflow/mesh` writes, or `log.liggghts`.
    x, y : str
        Columns: what the levels are levels of, and what is compared there.
    since : float or str
        Taken off the second, a number or a formula: a time that the run begins with.
    """

    file: FileName
    x: Word
    y: Word
    since: Amount = 0.0

    def formulas(self) -> tuple[str, ...]:
        """Return what is taken off, if it is a formula."""
        return (self.since,) if isinstance(self.since, str) else ()

    def read(self, run: Run) -> tuple[FloatArray, FloatArray]:
        """Return both columns."""
        x, y = run.column(self.file, self.x), run.column(self.file, self.y)
        return x, y - run.amount(self.since)
