"""Profile of a silhouette: height of the upper outline over the horizontal position."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from pydantic import Field

from liggghts_io.errors import CaseError
from liggghts_io.measure.extract.base import CurveExtractor, FloatArray
from liggghts_io.measure.extract.grains.outline import OfOutline, outline_of
from liggghts_io.measure.extract.run import Run


class Profile(OfOutline, CurveExtractor):
    """Height of the outline above the box [m] over the position [m], mean over the frames.

    Attributes
    ----------
    points : int
        Points over the width of the box.
    """

    points: Annotated[int, Field(ge=2, le=10_000)] = 201

    def read(self, run: Run) -> tuple[FloatArray, FloatArray]:
        """Return positions across the box and mean heights there, 0 where no grain is."""
        low, high = self.box.side(self.plane[0], run)
        if not np.isfinite([low, high]).all():
            msg = f"a profile needs a box with {self.plane[0]} = [from, to]"
            raise CaseError(msg)
        at = np.linspace(low, high, self.points)
        heights = []
        for shadow, _ in self.silhouettes(run):
            position, height = outline_of(shadow).T
            heights.append(np.interp(at, position, height, left=0.0, right=0.0))
        return at, np.asarray(np.mean(heights, axis=0), dtype=np.float64)
