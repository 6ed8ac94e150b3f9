"""Time at which a column of a table first reaches a value."""

from __future__ import annotations

import numpy as np

from liggghts_io.errors import CaseError
from liggghts_io.measure.extract.base import Amount, Extractor, FileName, Word
from liggghts_io.measure.extract.run import Run
from liggghts_io.measure.levels import at_levels


class TimeTo(Extractor):
    """Time at which a column of a table first reaches a value.

    Attributes
    ----------
    file : str
        What a `fix print` or `fix massflow/mesh` writes, or `log.liggghts`.
    column : str
        Name in its title, or number from "1".
    reaches : float or str
        Value that is waited for, a number or a formula, in the unit of the column.
    time : str
        Column with the time.
    """

    file: FileName
    column: Word
    reaches: Amount
    time: Word = "time_s"

    def formulas(self) -> tuple[str, ...]:
        """Return the value that is waited for, if it is a formula."""
        return (self.reaches,) if isinstance(self.reaches, str) else ()

    def read(self, run: Run) -> float:
        """Return the time, linear between rows."""
        time, values = run.column(self.file, self.time), run.column(self.file, self.column)
        target = run.amount(self.reaches)
        if len(values) == 0:
            msg = f"{self.file}: no row; {self.column} never reaches {target:g}"
            raise CaseError(msg)
        if values[0] == target:
            return float(time[0])
        side = 1.0 if values[0] < target else -1.0
        found = at_levels(side * values, time, np.array([side * target]))[0]
        if np.isnan(found):
            msg = (
                f"{self.file}: {self.column} does not reach {target:g} within the run (it ends at "
                f"{values[-1]:g}); simulate longer"
            )
            raise CaseError(msg)
        return float(found)
