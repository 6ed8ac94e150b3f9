"""Angle of a silhouette: the flanks of a heap, or a slope such as the surface in a drum."""

from __future__ import annotations

from typing import Final, Literal

import numpy as np

from liggghts_io.errors import CaseError
from liggghts_io.measure.extract.base import Extractor, Part
from liggghts_io.measure.extract.grains.outline import OfOutline, outline_of
from liggghts_io.measure.extract.run import Run
from liggghts_io.measure.flanks import FlankFit, FloatArray, fit_line
from liggghts_io.measure.silhouette import Silhouette, angle_of_repose

_LEAST_COLUMNS: Final = 5


class Angle(OfOutline, Extractor):
    """Angle of a silhouette above the horizontal, mean over the frames [deg].

    Attributes
    ----------
    shape : str
        "heap": mean of both flanks; "slope": one line through the outline within the box.
    flank : (float, float)
        Ends of the fitted flank of a heap as parts of its height.
    signed : bool
        Whether a slope that falls to the right is negative.
    """

    shape: Literal["heap", "slope"] = "heap"
    flank: Part = (0.2, 0.8)
    signed: bool = False

    def read(self, run: Run) -> float:
        """Return the mean angle over the frames."""
        return float(np.mean([self.fit(shadow)[0] for shadow, _ in self.silhouettes(run)]))

    def fit(self, shadow: Silhouette) -> tuple[float, FloatArray]:
        """Return the angle of one silhouette and the fitted lines.

        Returns
        -------
        (float, (k, 2, 2) float64)
            Angle [deg]; end points of each line: position and height above the border [m].

        Raises
        ------
        CaseError
            If there is too little to fit.
        """
        if self.shape == "heap":
            fit = FlankFit(*self.flank)
            found = angle_of_repose(shadow.image, shadow.metres_per_pixel, dark_heap=True, fit=fit)
            return found.angle_deg, found.shifted(shadow.left_m).lines
        outline = outline_of(shadow)
        if len(outline) < _LEAST_COLUMNS:
            msg = f"{len(outline)} columns of a slope in the box; make it wider"
            raise CaseError(msg)
        line, angle = fit_line(outline)
        falls = (line[1, 0] - line[0, 0]) * (line[1, 1] - line[0, 1]) < 0.0
        return (-angle if self.signed and falls else angle), line[None]
