"""Number of grains in a box."""

from __future__ import annotations

import numpy as np

from liggghts_io.measure.extract.grains.boxes import GrainNumber
from liggghts_io.measure.extract.run import Run


class Count(GrainNumber):
    """Number of grains in a box."""

    def read(self, run: Run) -> float:
        """Return the mean number over the frames."""
        return float(np.mean([frame.count for frame in self.frames_of(run, ())]))
