"""Rolling friction acts as a constant torque (CDT) and not as a spring that holds (EPSD2)."""

from __future__ import annotations

from typing import Any, Final

from liggghts_io.effects.base import Effect
from liggghts_io.experiments.setup import Setup


def apply(variables: dict[str, Any], _strength: float, setup: Setup) -> dict[str, Any]:
    """Take the model of a constant directional torque.

    Glued grains go on to hold by a spring: a constant torque as large as theirs turns a grain the
    other way within a step, faster each time.
    """
    plate = "epsd2" if setup.glued else "cdt"
    return variables | {"rolling_model": "cdt", "plate_rolling_model": plate}


CONSTANT_ROLLING_TORQUE: Final = Effect(
    name="constant_rolling_torque",
    title="Constant rolling torque",
    unit="-",
    meaning="rolling friction by a constant torque (cdt) instead of a spring (epsd2)",
    scale=1.0,
    low=0.0,
    high=1.0,
    settled_by="a single grain on a slope: by a spring it rests, by a constant torque it creeps",
    settled_se=0.1,
    settled_hours=0.5,
    apply=apply,
    switch=True,
)
