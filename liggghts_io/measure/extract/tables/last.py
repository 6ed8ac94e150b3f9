"""Last value of a column of a table."""

from __future__ import annotations

from liggghts_io.measure.extract.base import Extractor, FileName, Word
from liggghts_io.measure.extract.run import Run
from liggghts_io.measure.extract.tables.rows import last_of


class Last(Extractor):
    """Last value of a column of a table.

    Attributes
    ----------
    file : str
        What a `fix print` or `fix massflow/mesh` writes, or `log.liggghts`.
    column : str
        Name in its title, or number from "1".
    """

    file: FileName
    column: Word

    def read(self, run: Run) -> float:
        """Return the value in the last row."""
        return last_of(run.column(self.file, self.column), self.file)
