"""Percentile of a dump column over the grains in a box."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from pydantic import Field

from liggghts_io.measure.extract.grains.values import OfValues
from liggghts_io.measure.extract.run import Run


class GrainPercentile(OfValues):
    """Percentile of a dump column over the grains in a box.

    Attributes
    ----------
    percent : float
        From 0 to 100; 50 is the median.
    """

    percent: Annotated[float, Field(ge=0.0, le=100.0)] = 50.0

    def read(self, run: Run) -> float:
        """Return the mean over the frames."""
        return float(np.mean([np.percentile(one, self.percent) for one in self.values_of(run)]))
