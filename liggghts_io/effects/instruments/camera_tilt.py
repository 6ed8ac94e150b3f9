"""The camera is not level, or its line of reference is wrong, and one flank was measured."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from liggghts_io.effects.base import Effect
from liggghts_io.experiments.setup import Observed, Setup


def read(observed: Observed, strength: float, _setup: Setup) -> Observed:
    """Add the tilt to all angles that were read, and to the flank."""
    values = {k: v + strength if k == "angle_deg" else v for k, v in observed.values.items()}
    tables = dict(observed.tables)
    if "flank.csv" in tables:
        flank = tables["flank.csv"]
        fall = np.tan(np.radians(strength)) * (1.0 - flank["distance"])
        tables["flank.csv"] = {**flank, "height": flank["height"] + fall}
    return replace(observed, values=values, tables=tables)


CAMERA_TILT: Final = Effect(
    name="camera_tilt_deg",
    title="Tilted camera",
    unit="deg",
    meaning="by how much the angles that were read are too large",
    scale=0.5,
    low=-5.0,
    high=5.0,
    settled_by="a picture of a spirit level or a plumb line, or both flanks measured",
    settled_se=0.1,
    settled_hours=0.2,
    experiments=("heap",),
    read=read,
)
