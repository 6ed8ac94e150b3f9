"""Mean of a column of a table over a part of its rows."""

from __future__ import annotations

from liggghts_io.measure.extract.base import Extractor, FileName, Part, Word
from liggghts_io.measure.extract.run import Run
from liggghts_io.measure.extract.tables.rows import rows_in


class Mean(Extractor):
    """Mean of a column of a table over a part of its rows.

    Attributes
    ----------
    file : str
        What a `fix print` or `fix massflow/mesh` writes, or `log.liggghts`.
    column : str
        Name in its title, or number from "1".
    part : (float, float)
        Part of the rows, [0.5, 1.0] for the second half.
    """

    file: FileName
    column: Word
    part: Part = (0.0, 1.0)

    def read(self, run: Run) -> float:
        """Return the mean of the rows."""
        values = run.column(self.file, self.column)
        return float(rows_in(values, self.part, self.file).mean())
