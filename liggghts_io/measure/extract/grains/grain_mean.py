"""Mean of a dump column over the grains in a box."""

from __future__ import annotations

import numpy as np

from liggghts_io.measure.extract.grains.values import OfValues
from liggghts_io.measure.extract.run import Run


class GrainMean(OfValues):
    """Mean of a dump column over the grains in a box."""

    def read(self, run: Run) -> float:
        """Return the mean over the frames."""
        return float(np.mean([one.mean() for one in self.values_of(run)]))
