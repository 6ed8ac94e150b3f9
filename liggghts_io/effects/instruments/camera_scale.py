"""Heights and widths of a picture have not the same scale: oblique camera, stretched picture."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Final

from liggghts_io.effects.base import Effect
from liggghts_io.experiments.setup import Observed, Setup


def read(observed: Observed, strength: float, _setup: Setup) -> Observed:
    """Stretch heights: tangents of angles, and the flank."""
    factor = 1.0 + strength

    def seen(angle: float) -> float:
        return math.degrees(math.atan(factor * math.tan(math.radians(angle))))

    values = {k: seen(v) if k == "angle_deg" else v for k, v in observed.values.items()}
    tables = dict(observed.tables)
    if "flank.csv" in tables:
        flank = tables["flank.csv"]
        tables["flank.csv"] = {**flank, "height": factor * flank["height"]}
    return replace(observed, values=values, tables=tables)


CAMERA_SCALE: Final = Effect(
    name="camera_scale",
    title="Scale of the camera",
    unit="-",
    meaning="scale of heights over that of widths, minus 1",
    scale=0.01,
    low=-0.2,
    high=0.2,
    settled_by="a picture of a ruler upright and lying in the plane of the heap",
    settled_se=0.002,
    settled_hours=0.2,
    experiments=("heap",),
    read=read,
)
