"""Largest or smallest value of a column of a table."""

from __future__ import annotations

from typing import Literal

from liggghts_io.measure.extract.base import Extractor, FileName, Part, Word
from liggghts_io.measure.extract.run import Run
from liggghts_io.measure.extract.tables.rows import rows_in


class Extreme(Extractor):
    """Largest or smallest value of a column of a table.

    Attributes
    ----------
    file : str
        What a `fix print` or `fix massflow/mesh` writes, or `log.liggghts`.
    column : str
        Name in its title, or number from "1".
    which : str
        "largest" or "smallest".
    part : (float, float)
        Part of the rows.
    """

    file: FileName
    column: Word
    which: Literal["largest", "smallest"] = "largest"
    part: Part = (0.0, 1.0)

    def read(self, run: Run) -> float:
        """Return the extreme of the rows."""
        values = rows_in(run.column(self.file, self.column), self.part, self.file)
        return float(values.max() if self.which == "largest" else values.min())
