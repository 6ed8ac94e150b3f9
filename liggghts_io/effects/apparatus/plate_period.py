"""The conveyor plate swings slower or faster than it was set to."""

from __future__ import annotations

from typing import Any, Final

from liggghts_io.effects.base import Effect
from liggghts_io.experiments.setup import Setup


def apply(variables: dict[str, Any], strength: float, _setup: Setup) -> dict[str, Any]:
    """Stretch the periods of all harmonics; their amplitudes stay.

    The calibration paper (section 2.5.2) found the real motion a little longer than the one set.
    """
    return variables | {"periods": [p * (1.0 + strength) for p in variables["periods"]]}


PLATE_PERIOD: Final = Effect(
    name="plate_period",
    title="Period of the conveyor plate",
    unit="-",
    meaning="relative deviation of the plate's period from the one that was set",
    scale=0.03,
    low=-0.3,
    high=0.3,
    settled_by="the period of the plate timed over a hundred strokes",
    settled_se=0.002,
    settled_hours=0.1,
    experiments=("conveyor",),
    apply=apply,
)
