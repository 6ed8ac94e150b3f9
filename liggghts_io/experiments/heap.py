"""Angle of repose: grains poured between two side walls on the plate under test."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np

from liggghts_io.dumps import Frame, frames
from liggghts_io.errors import CaseError
from liggghts_io.experiments.base import (
    COMMON_PARAMETERS,
    Build,
    Experiment,
    Parameter,
    Setup,
    common_variables,
    same,
)
from liggghts_io.silhouette import FlankFit, Repose, angle_of_repose, draw_silhouette
from liggghts_io.stl import rectangle

_PIXELS_PER_DIAMETER: Final = 16.0

PARAMETERS: Final = (
    *COMMON_PARAMETERS,
    Parameter(
        "plate_half_length_d",
        "d",
        "half length of the plate; what rolls off it is lost",
        16.0,
        30.0,
        60.0,
    ),
    Parameter("slice_width_d", "d", "distance of the smooth side walls", 5.0, 8.0, 120.0),
    Parameter("pour_half_width_d", "d", "half side of the square spout", 2.0, 2.0, 3.0),
    Parameter("pour_height_d", "d", "lower edge of the spout above the plate", 17.0, 30.0, 55.0),
    Parameter("pour_depth_d", "d", "height of the spout", 4.0, 5.0, 6.0),
    same("pour_speed_m_s", "m/s", "downward speed at the spout", 0.05),
    Parameter("pour_grains", "-", "number of grains poured", 1000.0, 4000.0, 60000.0),
    Parameter("pour_rate_1_s", "1/s", "grains poured per second", 900.0, 900.0, 3000.0),
    same("pour_interval_s", "s", "time between two insertions", 0.005),
    same("settle_s", "s", "time without pouring at the end", 0.3),
    same("skin_d", "d", "neighbour skin", 0.15),
    same("frames", "-", "number of dumps over the run", 20.0),
    same("measured_frames", "-", "how many of the last dumps are averaged", 1.0),
    same("flank_low", "-", "lower end of the fitted flank as a part of the height", 0.2),
    same("flank_high", "-", "upper end of the fitted flank as a part of the height", 0.8),
)


def build(setup: Setup) -> Build:
    """Return template variables and the plate."""
    a, d = setup.apparatus, setup.particle.d32_m
    half, slice_half = a["plate_half_length_d"] * d, 0.5 * a["slice_width_d"] * d
    low, high = a["pour_height_d"] * d, (a["pour_height_d"] + a["pour_depth_d"]) * d
    spout_half = a["pour_half_width_d"] * d
    spout_y = min(spout_half, slice_half)
    margin = 4.0 * d
    variables = {
        **common_variables(setup),
        "domain": (
            -half - margin,
            half + margin,
            -slice_half - d,
            slice_half + d,
            -margin,
            high + margin,
        ),
        "plate_half_length": half,
        "pour_half_width": spout_half,
        "slice": (-slice_half, slice_half),
        "spout": (-spout_half, spout_half, -spout_y, spout_y, low, high),
        "grain_count": a["pour_grains"],
        "grain_rate": a["pour_rate_1_s"],
        "pour_interval": a["pour_interval_s"],
        "pour_speed": a["pour_speed_m_s"],
        "duration": a["pour_grains"] / a["pour_rate_1_s"] + a["settle_s"],
    }
    plate = rectangle((-half, half), (-slice_half - 0.5 * d, slice_half + 0.5 * d), 0.0)
    return Build(variables, {"plate": plate})


def measure(frame: Frame, setup: Setup) -> Repose:
    """Measure the heap of one frame on its silhouette; grains in the air are left out."""
    c, a, d = frame.columns, setup.apparatus, setup.particle.d32_m
    # Falling grains are faster than any in the heap: a free fall over one diameter.
    resting = frame.speeds < np.sqrt(2.0 * 9.81 * d)
    image = draw_silhouette(
        c["x"][resting], c["z"][resting], c["radius"][resting], d / _PIXELS_PER_DIAMETER
    )
    fit = FlankFit(a["flank_low"], a["flank_high"])
    return angle_of_repose(image, d / _PIXELS_PER_DIAMETER, dark_heap=True, fit=fit)


def observe(directory: Path, setup: Setup) -> dict[str, float]:
    """Average the angle over the last frames."""
    last = int(setup.apparatus["measured_frames"])
    angles = [measure(frame, setup).angle_deg for frame in frames(directory, last)]
    if len(angles) < last:
        msg = f"{directory}: {len(angles)} frames, {last} are to be averaged"
        raise CaseError(msg)
    return {"angle_deg": float(np.mean(angles))}


HEAP: Final = Experiment(
    name="heap",
    title="Angle of repose",
    template="heap.in.j2",
    parameters=PARAMETERS,
    observables=("angle_deg",),
    build=build,
    observe=observe,
)
