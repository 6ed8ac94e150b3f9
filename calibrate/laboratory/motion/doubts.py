"""What is doubtful about a measured motion: a sensor at its end, a wrong period, few readings."""

from __future__ import annotations

from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.laboratory.motion.profile import PlateMotion

__all__ = ["doubts_of"]

_MOST_LEFT: Final = 0.2
"""Part of the motion that may remain."""
_LEAST_IN_A_PERIOD: Final = 8.0
"""Readings; a sine of fewer may be one of another period."""
_LEAST_EQUAL: Final = 5
_LEAST_PART: Final = 0.02
"""Of all readings: as many as that equal the largest where a sensor is at its end."""
_SPIKE: Final = 4
"""So many times as many as have the next value: a sine has at most 2.4 times as many in its last
digit."""


def doubts_of(found: PlateMotion) -> list[str]:
    """Return a sentence for each thing that makes a fitted motion doubtful.

    Parameters
    ----------
    found : PlateMotion
    """
    said = []
    for values, name in ((found.measured, "largest"), (-found.measured, "smallest")):
        if _at_its_end(values):
            said.append(
                f"{(values == values.max()).sum()} readings equal the {name} one: the sensor seems "
                "to reach its end there, and amplitudes are too small; measure with a larger range"
            )
    in_a_period = found.period_s / float(np.median(np.diff(found.time_s)))
    if in_a_period < _LEAST_IN_A_PERIOD:
        said.append(
            f"{in_a_period:.1f} readings in a period may be those of a faster motion as well; "
            "record faster, or give the period with --period"
        )
    if found.share > _MOST_LEFT:
        said.append(
            f"{100 * found.share:.0f} % of the motion is not described: look at the picture; the "
            "period may be another one (--period), or the plate does not move periodically"
        )
    return said


def _at_its_end(values: Array) -> bool:
    """Tell whether far more readings have the largest value than the next one."""
    levels, counts = np.unique(values, return_counts=True)
    most = max(_LEAST_EQUAL, _LEAST_PART * len(values))
    return len(levels) > 1 and bool(counts[-1] >= max(most, _SPIKE * counts[-2]))
