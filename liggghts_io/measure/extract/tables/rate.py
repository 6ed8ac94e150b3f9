"""Rate at which a column of a table grows from one value to another."""

from __future__ import annotations

import numpy as np

from liggghts_io.errors import CaseError
from liggghts_io.measure.extract.base import Amount, Extractor, FileName, Word
from liggghts_io.measure.extract.run import Run
from liggghts_io.measure.levels import at_levels


class Rate(Extractor):
    """Rate at which a column of a table grows from one value to another.

    Attributes
    ----------
    file : str
        What a `fix print` or `fix massflow/mesh` writes, or `log.liggghts`.
    column : str
        Name in its title, or number from "1".
    between : (float or str, float or str)
        Values between which the rate is taken, numbers or formulas, in the unit of the column.
    time : str
        Column with the time.
    """

    file: FileName
    column: Word
    between: tuple[Amount, Amount]
    time: Word = "time_s"

    def formulas(self) -> tuple[str, ...]:
        """Return what is a formula among the options."""
        return tuple(one for one in self.between if isinstance(one, str))

    def read(self, run: Run) -> float:
        """Return the difference of the values over that of the times when they are reached."""
        time, values = run.column(self.file, self.time), run.column(self.file, self.column)
        low, high = (run.amount(one) for one in self.between)
        if not low < high:
            msg = f"between = [{low:g}, {high:g}]: the smaller value comes first"
            raise CaseError(msg)
        first, last = at_levels(values, time, np.array([low, high]))
        if not first < last:  # not a number where a value is not reached
            end = f"it ends at {values.max():g}" if len(values) else "there is no row"
            msg = (
                f"{self.file}: {self.column} does not grow from {low:g} to {high:g} within the run "
                f"({end}); simulate longer"
            )
            raise CaseError(msg)
        return float((high - low) / (last - first))
