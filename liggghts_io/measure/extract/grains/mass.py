"""Mass of the grains in a box [kg]."""

from __future__ import annotations

import math

import numpy as np

from liggghts_io.measure.extract.grains.boxes import SIZED, GrainNumber
from liggghts_io.measure.extract.run import Run


class Mass(GrainNumber):
    """Mass of the grains in a box [kg]."""

    def read(self, run: Run) -> float:
        """Return the mean mass over the frames."""
        frames = self.frames_of(run, SIZED)
        cubes = [float((frame.columns["radius"] ** 3).sum()) for frame in frames]
        return run.density * 4.0 / 3.0 * math.pi * float(np.mean(cubes))
