"""Horizontal conveyor: grains poured on an oscillating plate, timed as they fall on a scale.

Similarity of the small scales. Plate length, pour position, poured mass and target mass are all
multiplied by `length_fraction` while plate motion and flow per width stay as they are; the bed
then has the same depth and speed, so that times shrink by `length_fraction`. A slice of
`width_fraction` of the plate between frictionless walls carries that part of the flow. Free falls
do not shrink: their computed duration is taken out before times are scaled back.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from liggghts_io.errors import CaseError
from liggghts_io.experiments.base import Experiment, bundled
from liggghts_io.experiments.common import common_parameters, common_variables
from liggghts_io.experiments.numbers import Curve, Observable, Parameter, same
from liggghts_io.experiments.setup import Build, Observed, Setup
from liggghts_io.experiments.view import Notes, View
from liggghts_io.materials import GLUED
from liggghts_io.measure.counts import Count, read_count
from liggghts_io.measure.dumps import Frame, all_frames
from liggghts_io.measure.mass_time import MassTime, mass_time, time_to_reach
from liggghts_io.stl import rectangle

CURVE: Final = "mass_time.csv"
SCALE: Final = "scale.txt"
LEVELS_G: Final = tuple(float(level) for level in range(10, 101, 10))
"""Masses at which the mass-time curve is compared where nobody asks for others [g]."""

PARAMETERS: Final = (
    *common_parameters(),
    Parameter(
        "length_fraction",
        "-",
        "similarity factor of lengths, masses and times",
        0.1,
        0.25,
        1.0,
        (0.01, 1.0),
    ),
    Parameter(
        "width_fraction",
        "-",
        "part of the plate width that is simulated",
        0.12,
        0.25,
        1.0,
        (0.01, 1.0),
    ),
    same("plate_length_m", "m", "from the back stop to the end of the plate", 0.4, (0.01, 10.0)),
    same("plate_width_m", "m", "width of the plate", 0.04, (2e-3, 2.0)),
    same(
        "pour_position_m", "m", "middle of the funnel in front of the back stop", 0.08, (1e-3, 10.0)
    ),
    same("poured_mass_kg", "kg", "mass in the funnel", 0.3, (1e-4, 100.0)),
    same(
        "target_mass_kg", "kg", "mass on the scale at which the time is taken", 0.1, (1e-5, 100.0)
    ),
    same("mass_flow_factor", "-", "factor on the measured flow of the funnel", 1.0, (0.01, 100.0)),
    same(
        "amplitude_m", "m", "amplitude of the fundamental of the plate motion", 0.002, (1e-6, 0.1)
    ),
    same(
        "harmonic_2",
        "-",
        "amplitude of the second harmonic as a part of the first",
        0.25,
        (0.0, 10.0),
    ),
    same(
        "harmonic_3",
        "-",
        "amplitude of the third harmonic as a part of the first",
        0.0,
        (0.0, 10.0),
    ),
    same("period_s", "s", "period of the plate", 0.08, (1e-3, 10.0)),
    same("pour_height_d", "d", "lower edge of the spout above the plate", 9.0, (0.5, 1000.0)),
    same("pour_depth_d", "d", "height of the spout", 5.0, (1.5, 100.0)),
    same("pour_half_width_d", "d", "half length of the spout along the plate", 2.0, (0.6, 100.0)),
    same("pour_speed_m_s", "m/s", "downward speed at the spout", 0.1, (0.0, 10.0)),
    same("pour_interval_s", "s", "time between two insertions", 0.005, (1e-4, 1.0)),
    same("scale_drop_d", "d", "height of the plate above the scale", 2.0, (0.5, 100.0)),
    same(
        "duration_flat_s",
        "s",
        "longest time that is simulated, flat plate, real time",
        14.0,
        (0.1, 1e4),
    ),
    same(
        "duration_glued_s",
        "s",
        "longest time that is simulated, glued plate, real time",
        24.0,
        (0.1, 1e4),
    ),
    same("skin_d", "d", "neighbour skin", 0.15, (0.01, 5.0)),
    same("frames", "-", "number of dumps over the run", 12.0, (1.0, 1e4), whole=True),
)


def falls(setup: Setup) -> float:
    """Duration of the free falls from the spout and to the scale [s]."""
    a, d = setup.apparatus, setup.particle.d32_m
    height = (a["pour_height_d"] + 0.5 * a["pour_depth_d"]) * d
    speed = a["pour_speed_m_s"]
    down = (math.sqrt(speed**2 + 2.0 * 9.81 * height) - speed) / 9.81
    return down + math.sqrt(2.0 * a["scale_drop_d"] * d / 9.81)


def motion(setup: Setup) -> dict[str, list[float]]:
    """Return the plate's sum of cosines: a slow way forward and a fast way back."""
    a = setup.apparatus
    ratios = {1: 1.0, 2: a["harmonic_2"], 3: a["harmonic_3"]}
    used = {order: ratio for order, ratio in ratios.items() if ratio > 0.0}
    return {
        "amplitudes": [a["amplitude_m"] * ratio for ratio in used.values()],
        "phases": [0.5 * math.pi] * len(used),
        "periods": [a["period_s"] / order for order in used],
    }


def flow_field(kind: str) -> str:
    """Return the field of a particle that holds the flow of the funnel used with a plate."""
    return "flow_glued_kg_s" if kind == GLUED else "flow_flat_kg_s"


def pour(setup: Setup) -> dict[str, float]:
    """Return number and rate of grains for the slice, and the simulated time."""
    a, particle = setup.apparatus, setup.particle
    flow = particle.amount(flow_field(setup.kind))
    real = a["duration_glued_s"] if setup.glued else a["duration_flat_s"]
    part = a["width_fraction"] / particle.mass_kg
    return {
        "grain_count": a["poured_mass_kg"] * a["length_fraction"] * part,
        "grain_rate": flow * a["mass_flow_factor"] * part,
        "pour_interval": a["pour_interval_s"],
        "pour_speed": a["pour_speed_m_s"],
        "duration": real * a["length_fraction"] + falls(setup),
    }


def build(setup: Setup) -> Build:
    """Return template variables, the plate and the counting plane of the scale."""
    a, d = setup.apparatus, setup.particle.d32_m
    length = a["plate_length_m"] * a["length_fraction"]
    position = a["pour_position_m"] * a["length_fraction"]
    half = 0.5 * a["plate_width_m"] * a["width_fraction"]
    moving = motion(setup)
    stroke = 2.0 * sum(moving["amplitudes"])
    low, high = a["pour_height_d"] * d, (a["pour_height_d"] + a["pour_depth_d"]) * d
    spout, reach, drop = (
        a["pour_half_width_d"] * d,
        length + stroke + 12.0 * d,
        a["scale_drop_d"] * d,
    )
    x, y = (-2.0 * stroke - 2.0 * d, reach), (-half - d, half + d)
    variables = {
        **common_variables(setup),
        **moving,
        **pour(setup),
        "domain": (*x, *y, -drop - 4.0 * d, high + 14.0 * d),
        "plate_length": length,
        "pour_position": position,
        "slice": (-half, half),
        "spout": (position - spout, position + spout, -half, half, low, high),
    }
    across = (-half - 0.5 * d, half + 0.5 * d)
    plate = rectangle((-stroke - d, length), across, 0.0)
    scale = rectangle((length - stroke - 6.0 * d, reach - d), across, -drop)
    return Build(variables, {"plate": plate, "scale": scale})


def curve(count: Count, setup: Setup) -> MassTime:
    """Mass on the scale over time, both as the full apparatus would show them."""
    a = setup.apparatus
    part = a["length_fraction"] * a["width_fraction"]
    fall = falls(setup)
    real = (count.time_s - fall) / a["length_fraction"] + fall
    smooth = a["period_s"] / a["length_fraction"]
    return mass_time(real, count.mass_kg / part, smooth)


def arrivals(folder: Path, setup: Setup) -> MassTime:
    """Return the mass-time curve of a finished run.

    Raises
    ------
    CaseError
        If fewer than two grains reached the scale; DamagedFile if the run is not whole.
    """
    all_frames(folder)
    count = read_count(folder / SCALE, setup.particle.density)
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
    parameters=PARAMETERS,
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
