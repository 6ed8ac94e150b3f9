"""Horizontal conveyor: grains poured on an oscillating plate, timed as they fall on a scale.

Similarity of the small scales. Plate length, pour position, poured mass and target mass are all
multiplied by `length_fraction` while plate motion and flow per width stay as they are; the bed
then has the same depth and speed, so that times shrink by `length_fraction`. A slice of
`width_fraction` of the plate, no wider than `slice_width_d` grain diameters, periodic or between
frictionless walls, carries that part of the flow. Free falls do not shrink: their computed duration
is taken out before times are scaled back.

Residents. On a plate laminated with grains some of every test stay for ever. The paper (section
2.5.2) pours grains beforehand and waits until none leaves any more; `resident_mass_kg` does so.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

import numpy as np

from liggghts_io.errors import CaseError
from liggghts_io.experiments.base import Experiment, bundled
from liggghts_io.experiments.common import common_variables
from liggghts_io.experiments.conveyor_parameters import CONVEYOR_PARAMETERS
from liggghts_io.experiments.numbers import Curve, Observable
from liggghts_io.experiments.plate_motion import period_of, plate_motion
from liggghts_io.experiments.setup import Build, Observed, Setup
from liggghts_io.experiments.view import Notes, View
from liggghts_io.materials import GLUED
from liggghts_io.measure.counts import Count, read_count
from liggghts_io.measure.dumps import Frame, all_frames
from liggghts_io.measure.mass_time import MassTime, mass_time, time_to_reach
from liggghts_io.stl import Triangles, rectangle

CURVE: Final = "mass_time.csv"
SCALE: Final = "scale.txt"
LEVELS_G: Final = tuple(float(level) for level in range(10, 101, 10))
"""Masses at which the mass-time curve is compared where nobody asks for others [g]."""


def falls(setup: Setup) -> float:
    """Duration of the free falls from the spout and to the scale [s]."""
    a, d = setup.apparatus, setup.particle.d32_m
    height = (a["pour_height_d"] + 0.5 * a["pour_depth_d"]) * d
    speed = a["pour_speed_m_s"]
    down = (math.sqrt(speed**2 + 2.0 * 9.81 * height) - speed) / 9.81
    return down + math.sqrt(2.0 * a["scale_drop_d"] * d / 9.81)


def flow_field(kind: str) -> str:
    """Return the field of a particle that holds the flow of the funnel used with a plate."""
    return "flow_glued_kg_s" if kind == GLUED else "flow_flat_kg_s"


def head_start(setup: Setup) -> float:
    """Return when the measured pour begins [s], after whole periods of the plate."""
    a = setup.apparatus
    if not setup.glued or a["resident_mass_kg"] == 0.0:
        return 0.0
    period = period_of(a)
    return period * math.ceil(a["resident_duration_s"] * a["length_fraction"] / period)


def slice_part(setup: Setup) -> float:
    """Return which part of the plate's width is simulated."""
    a = setup.apparatus
    widest = a["slice_width_d"] * setup.particle.d32_m / a["plate_width_m"]
    return min(a["width_fraction"], widest) if widest > 0.0 else a["width_fraction"]


def pour(setup: Setup) -> dict[str, float]:
    """Return number and rate of grains for the slice, and the simulated time."""
    a, particle = setup.apparatus, setup.particle
    flow = particle.amount(flow_field(setup.kind))
    real = a["duration_glued_s"] if setup.glued else a["duration_flat_s"]
    part, begin = slice_part(setup) / particle.mass_kg, head_start(setup)
    return {
        "grain_count": a["poured_mass_kg"] * a["length_fraction"] * part,
        "grain_rate": flow * a["mass_flow_factor"] * part,
        "pour_interval": a["pour_interval_s"],
        "pour_speed": a["pour_speed_m_s"],
        "begin": begin,
        "residents": a["resident_mass_kg"] / a["poured_mass_kg"] if begin else 0.0,
        "duration": begin + real * a["length_fraction"] + falls(setup),
    }


def gravity(apparatus: Mapping[str, float]) -> tuple[float, float, float]:
    """Return the direction of gravity over a plate that stays along x and y."""
    along = math.radians(apparatus["tilt_deg"])
    across = math.radians(apparatus["cross_tilt_deg"])
    down = math.cos(along)
    return math.sin(along), down * math.sin(across), -down * math.cos(across)


def build(setup: Setup) -> Build:
    """Return template variables, the plate and the counting plane of the scale."""
    a, d = setup.apparatus, setup.particle.d32_m
    length = a["plate_length_m"] * a["length_fraction"]
    position = (a["pour_position_m"] + a["pour_offset_m"]) * a["length_fraction"]
    half = 0.5 * a["plate_width_m"] * slice_part(setup)
    periodic = bool(a["periodic_slice"])
    moving = plate_motion(a)
    stroke = 2.0 * sum(moving["amplitudes"])
    low, high = a["pour_height_d"] * d, (a["pour_height_d"] + a["pour_depth_d"]) * d
    spout, reach, drop = (
        a["pour_half_width_d"] * d,
        length + stroke + 12.0 * d,
        a["scale_drop_d"] * d,
    )
    # A periodic box is the slice itself; walls need room behind them.
    behind = 0.0 if periodic else d
    x, y = (-2.0 * stroke - 2.0 * d, reach), (-half - behind, half + behind)
    variables = {
        **common_variables(setup),
        **moving,
        **pour(setup),
        "gravity": gravity(a),
        "periodic": periodic,
        "domain": (*x, *y, -drop - 4.0 * d, high + 14.0 * d),
        "plate_length": length,
        "pour_position": position,
        "slice": (-half, half),
        "spout": (position - spout, position + spout, -half, half, low, high),
    }
    across = (-half - 0.5 * behind, half + 0.5 * behind)
    flat = _strip if periodic else rectangle
    plate = flat((-stroke - d, length), across, 0.0)
    scale = flat((length - stroke - 6.0 * d, reach - d), across, -drop)
    return Build(variables, {"plate": plate, "scale": scale})


def _strip(x: tuple[float, float], y: tuple[float, float], z: float) -> Triangles:
    """Horizontal rectangle made of squares: LIGGGHTS fails on triangles longer than the period."""
    count = math.ceil((x[1] - x[0]) / (y[1] - y[0]))
    ends = [x[0] + (x[1] - x[0]) * k / count for k in range(count + 1)]
    return np.concatenate([rectangle(pair, y, z) for pair in pairwise(ends)])


def curve(count: Count, setup: Setup) -> MassTime:
    """Mass on the scale over time, both as the full apparatus would show them."""
    a = setup.apparatus
    part = a["length_fraction"] * slice_part(setup)
    fall = falls(setup)
    real = (count.time_s - head_start(setup) - fall) / a["length_fraction"] + fall
    smooth = period_of(a) / a["length_fraction"]
    return mass_time(real, count.mass_kg / part, smooth)


def arrivals(folder: Path, setup: Setup) -> MassTime:
    """Return the mass-time curve of a finished run.

    Raises
    ------
    CaseError
        If fewer than two grains reached the scale; DamagedFile if the run is not whole.
    """
    all_frames(folder)
    count = read_count(folder / SCALE, setup.particle.density, since=head_start(setup))
    if len(count.time_s) < 2:
        msg = f"{len(count.time_s)} grains reached the scale; simulate longer (duration_*_s)"
        raise CaseError(msg)
    return curve(count, setup)


def observe(folder: Path, setup: Setup) -> Observed:
    """Return t100 and the mass-time curve (time_s, mass_g)."""
    line = arrivals(folder, setup)
    table = {"time_s": line.time_s, "mass_g": line.mass_kg * 1e3}
    target = setup.apparatus["target_mass_kg"]
    return Observed({"t100_s": time_to_reach(line, target)}, {CURVE: table})


def chart(folder: Path, setup: Setup, observables: Mapping[str, float], axes: Any) -> None:
    """Draw the mass-time curve and the time at the target mass."""
    line = arrivals(folder, setup)
    target = setup.apparatus["target_mass_kg"] * 1e3
    axes.plot(line.time_s, line.mass_kg * 1e3, linewidth=2.0)
    time = observables["t100_s"]
    axes.plot(time, target, "o", label=f"{target:g} g after {time:.2f} s")
    axes.axhline(target, color="0.6", linewidth=0.8, linestyle="--")
    axes.set(xlabel="time (s)", ylabel="mass on the scale (g)")
    axes.legend(loc="upper left")


def notes(_frame: Frame, setup: Setup, observables: Mapping[str, float]) -> Notes:
    """Return the time at the target mass."""
    if "t100_s" not in observables:
        return Notes()
    target = setup.apparatus["target_mass_kg"] * 1e3
    return Notes(f"{target:g} g on the scale after {observables['t100_s']:.2f} s")


CONVEYOR: Final = Experiment(
    name="conveyor",
    title="Horizontal conveyor",
    caption="Oscillating conveyor plate",
    parameters=CONVEYOR_PARAMETERS,
    observables=(
        Observable(
            "t100_s",
            "s",
            "time until the target mass lies on the scale",
            high=1e5,
            part_of="mass_time",
        ),
    ),
    build=build,
    write=bundled("conveyor.in.j2"),
    observe=observe,
    chart=chart,
    view=View(solid={"plate": 1.0}, at=lambda _setup: 0.75, notes=notes),
    needs=lambda kind: (flow_field(kind),),
    curves=(
        Curve(
            name="mass_time",
            unit="s",
            meaning="time until a mass lies on the scale",
            x_name="mass on the scale",
            x_unit="g",
            levels=LEVELS_G,
            file=CURVE,
            x_column="mass_g",
            y_column="time_s",
            scale="log",
            high=1e5,
        ),
    ),
)
