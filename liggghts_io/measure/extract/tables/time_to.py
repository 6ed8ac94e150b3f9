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
    since : float or str
        Time that is taken off, a number or a formula.
    """

    file: FileName
    column: Word
    reaches: Amount
    time: Word = "time_s"
    since: Amount = 0.0

    def formulas(self) -> tuple[str, ...]:
        """Return what is a formula among the options."""
        return tuple(one for one in (self.reaches, self.since) if isinstance(one, str))

    def read(self, run: Run) -> float:
        """Return the time, linear between rows."""
        time, values = run.column(self.file, self.time), run.column(self.file, self.column)
        target = run.amount(self.reaches)
        side = 1.0 if len(values) == 0 or values[0] <= target else -1.0
        found = float(at_levels(side * values, time, np.array([side * target]))[0])
        if np.isnan(found):
            end = f"it ends at {values[-1]:g}" if len(values) else "there is no row"
            msg = (
                f"{self.file}: {self.column} does not reach {target:g} within the run ({end}); "
                "simulate longer"
            )
            raise CaseError(msg)
        return found - run.amount(self.since)
