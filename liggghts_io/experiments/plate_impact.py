"""Plate impact: grains fall through a pipe on a 45 degree plate and into four boxes or beside.

A part of the real mass is poured at the real flow rate; masses are scaled back to the real mass.
Grains leave the simulation below the boxes: they count where they pass the mouth of a box.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

import numpy as np

from liggghts_io.errors import CaseError
from liggghts_io.experiments.base import Experiment, bundled
from liggghts_io.experiments.common import common_parameters, common_variables
from liggghts_io.experiments.numbers import Curve, Observable, Parameter, same
from liggghts_io.experiments.setup import Build, Observed, Setup
from liggghts_io.experiments.view import Notes, View
from liggghts_io.measure.counts import Count, read_count
from liggghts_io.measure.dumps import FloatArray, Frame, all_frames, read_frame
from liggghts_io.stl import open_box, quad, rectangle, tube

BOXES: Final = (1, 2, 3, 4)
FLOW: Final = "flow_flat_kg_s"
POURED: Final = "impact_mass_kg"
"""Fields of the particle: flow of the funnel, and the mass that is poured in reality."""

LANDING: Final = "landing.csv"
LEVELS_MM: Final = (40.0, 45.0, 50.0, 56.5, 62.0, 70.0, 76.0, 82.0, 90.5, 100.0, 110.0, 120.0)
"""Distances at which the landing distribution is compared; the far walls of the boxes are among
them."""

# In the picture [m]: room around it, the end of the pipe, and room for two lines below the boxes.
_MARGIN_M: Final = 0.008
_PIPE_SHOWN_M: Final = 0.03
_LABEL_ROOM_M: Final = 0.012

PARAMETERS: Final = (
    *common_parameters(mu_side=0.3, mu_roll_side=0.1),
    Parameter(
        "mass_fraction", "-", "part of the real mass that is poured", 0.2, 0.5, 1.0, (1e-3, 1.0)
    ),
    same("flow_factor", "-", "factor on the flow of the funnel", 1.0, (0.01, 100.0)),
    same("spout_radius_m", "m", "radius of the funnel outlet", 0.00375, (1e-4, 0.1)),
    same("pour_speed_m_s", "m/s", "speed at the funnel outlet", 0.5, (0.0, 20.0)),
    same("pour_depth_m", "m", "height of the cylinder in which grains appear", 0.006, (1e-4, 1.0)),
    same("pour_interval_s", "s", "time between two insertions", 0.002, (1e-4, 1.0)),
    same("pipe_radius_m", "m", "inner radius of the pipe", 0.008, (1e-4, 0.5)),
    same("pipe_length_m", "m", "length of the pipe", 0.12, (1e-3, 10.0)),
    same(
        "pipe_gap_m", "m", "from the pipe's end down to the plate, on the axis", 0.03, (1e-3, 10.0)
    ),
    same(
        "plate_height_m",
        "m",
        "where the pipe axis meets the plate, above the box mouths",
        0.06,
        (1e-3, 10.0),
    ),
    same(
        "plate_up_m", "m", "length of the plate above the axis, along the slope", 0.02, (1e-3, 1.0)
    ),
    same(
        "plate_down_m",
        "m",
        "length of the plate below the axis, along the slope",
        0.01,
        (1e-3, 1.0),
    ),
    same("plate_width_m", "m", "width of the plate", 0.06, (1e-3, 1.0)),
    same("box_depth_m", "m", "depth of the boxes below their mouths", 0.02, (1e-3, 1.0)),
    same("box_width_m", "m", "width of the boxes across the plate", 0.06, (1e-3, 1.0)),
    same("box_1_near_m", "m", "near wall of box 1 from the pipe axis", 0.036, (1e-3, 10.0)),
    same("box_1_far_m", "m", "far wall of box 1", 0.0565, (1e-3, 10.0)),
    same("box_2_near_m", "m", "near wall of box 2", 0.0585, (1e-3, 10.0)),
    same("box_2_far_m", "m", "far wall of box 2", 0.07, (1e-3, 10.0)),
    same("box_3_near_m", "m", "near wall of box 3", 0.072, (1e-3, 10.0)),
    same("box_3_far_m", "m", "far wall of box 3", 0.0905, (1e-3, 10.0)),
    same("box_4_near_m", "m", "near wall of box 4", 0.0925, (1e-3, 10.0)),
    same("box_4_far_m", "m", "far wall of box 4", 0.12, (1e-3, 10.0)),
    same("flight_s", "s", "time for the last grain to come down", 0.35, (0.01, 100.0)),
    same("skin_d", "d", "neighbour skin", 1.0, (0.01, 5.0)),
    same("frames", "-", "number of dumps over the run", 12.0, (1.0, 1e4), whole=True),
)


def box_edges(setup: Setup, box: int) -> tuple[float, float]:
    """Return near and far wall of a box from the pipe axis [m]."""
    a = setup.apparatus
    return a[f"box_{box}_near_m"], a[f"box_{box}_far_m"]


def domain_bottom(setup: Setup) -> float:
    """Return where grains leave the simulation, below the boxes [m]."""
    return -setup.apparatus["box_depth_m"] - 0.004


def _check(setup: Setup) -> None:
    """Refuse boxes that overlap or have no mouth, and a funnel wider than the pipe."""
    a = setup.apparatus
    walls = [name for box in BOXES for name in (f"box_{box}_near_m", f"box_{box}_far_m")]
    for left, right in pairwise(walls):
        if a[left] >= a[right]:
            msg = (
                f"plate_impact: {right} = {a[right]:g} is not beyond {left} = {a[left]:g}; the "
                "walls of the boxes follow each other away from the pipe"
            )
            raise CaseError(msg)
    if a["spout_radius_m"] > a["pipe_radius_m"]:
        msg = (
            f"plate_impact: spout_radius_m = {a['spout_radius_m']:g} is more than pipe_radius_m = "
            f"{a['pipe_radius_m']:g}; grains would appear inside the wall of the pipe"
        )
        raise CaseError(msg)


def _meshes(setup: Setup) -> dict[str, np.ndarray]:
    a = setup.apparatus
    slope = np.sqrt(0.5)
    height, half = a["plate_height_m"], 0.5 * a["plate_width_m"]
    up, down = a["plate_up_m"] * slope, a["plate_down_m"] * slope
    plate = quad(
        (-up, -half, height + up),
        (down, -half, height - down),
        (down, half, height - down),
        (-up, half, height + up),
    )
    bottom = height + a["pipe_gap_m"]
    radius, y = a["pipe_radius_m"], (-0.5 * a["box_width_m"], 0.5 * a["box_width_m"])
    pipe = tube((radius, radius), (bottom, bottom + a["pipe_length_m"]))
    depth = (-a["box_depth_m"], 0.0)
    edges = [box_edges(setup, box) for box in BOXES]
    boxes = np.concatenate([open_box(x, y, depth, floor=False) for x in edges])
    # Half way down, where a grain that bounced off a wall stays in.
    mouths = {
        f"mouth{box}": rectangle(x, y, -0.5 * a["box_depth_m"])
        for box, x in zip(BOXES, edges, strict=True)
    }
    return {"plate": plate, "pipe": pipe, "boxes": boxes, **mouths}


def build(setup: Setup) -> Build:
    """Return template variables, plate, pipe, boxes and their mouths."""
    _check(setup)
    a, particle = setup.apparatus, setup.particle
    bottom = a["plate_height_m"] + a["pipe_gap_m"]
    top = bottom + a["pipe_length_m"]
    count = a["mass_fraction"] * particle.amount(POURED) / particle.mass_kg
    rate = a["flow_factor"] * particle.amount(FLOW) / particle.mass_kg
    half = 0.5 * max(a["box_width_m"], a["plate_width_m"]) + 0.01
    variables = {
        **common_variables(setup),
        "domain": (
            -0.04,
            a["box_4_far_m"] + 0.03,
            -half,
            half,
            domain_bottom(setup),
            top + 0.005,
        ),
        "plate_height": a["plate_height_m"],
        "pipe_bottom": bottom,
        "spout_radius": a["spout_radius_m"],
        "spout": (top - a["pour_depth_m"], top),
        "grain_count": count,
        "grain_rate": rate,
        "pour_interval": a["pour_interval_s"],
        "pour_speed": a["pour_speed_m_s"],
        "duration": count / rate + a["flight_s"],
    }
    return Build(variables, _meshes(setup))


def landing(counts: Sequence[Count], scale: float) -> dict[str, FloatArray]:
    """Return the mass that fell into boxes nearer than `LEVELS_MM`, as the full apparatus gives it.

    Parameters
    ----------
    counts : sequence of Count
        Of all boxes.
    scale : float
        Real mass over simulated mass, in grams per kilogram.
    """
    x_mm = np.concatenate([count.x_m for count in counts]) * 1e3
    mass = np.concatenate([count.mass_kg for count in counts]) * scale
    nearer = [float(mass[x_mm <= level].sum()) for level in LEVELS_MM]
    return {"distance_mm": np.array(LEVELS_MM), "mass_g": np.array(nearer)}


def observe(folder: Path, setup: Setup) -> Observed:
    """Return the masses in and beside the boxes as grams of the real initial mass."""
    density, total = setup.particle.density, setup.particle.amount(POURED) * 1e3
    poured = setup.apparatus["mass_fraction"] * setup.particle.amount(POURED)
    grains_poured = max(1, round(poured / setup.particle.mass_kg)) * setup.particle.mass_kg
    scale = total / grains_poured
    counts = [read_count(folder / f"box{box}.txt", density) for box in BOXES]
    masses = {
        f"m{box}_g": float(count.mass_kg.sum()) * scale
        for box, count in zip(BOXES, counts, strict=True)
    }
    shots = [read_frame(path) for path in all_frames(folder)]
    if not any(shot.count for shot in shots) and not any(masses.values()):
        msg = "no grain was poured: no frame holds one, and none fell into a box"
        raise CaseError(msg)
    last = shots[-1]
    in_air = float((density * np.pi / 6.0 * (2.0 * last.columns["radius"]) ** 3).sum()) * scale
    beside = max(0.0, total - sum(masses.values()) - in_air)
    return Observed({**masses, "beside_g": beside}, {LANDING: landing(counts, scale)})


def _words(observable: str) -> str:
    """Return "box 1" for m1_g, "beside" for beside_g."""
    return observable.removesuffix("_g").replace("m", "box ", 1)


def chart(_folder: Path, _setup: Setup, observables: Mapping[str, float], axes: Any) -> None:
    """Draw the masses in and beside the boxes."""
    names = [_words(name) for name in observables]
    bars = axes.bar(names, list(observables.values()))
    axes.bar_label(bars, fmt="%.2f g")
    axes.set(ylabel="mass (g)", ylim=(0.0, 1.15 * max(observables.values())))


def window(setup: Setup) -> tuple[float, float, float, float]:
    """Return plate, boxes and the end of the pipe; grains fall straight in the rest of it."""
    a = setup.apparatus
    up = a["plate_up_m"] * np.sqrt(0.5)
    left = -max(up, a["pipe_radius_m"]) - _MARGIN_M
    top = a["plate_height_m"] + a["pipe_gap_m"] + _PIPE_SHOWN_M
    low = domain_bottom(setup) - _LABEL_ROOM_M
    return left, a["box_4_far_m"] + _MARGIN_M, low, top


def notes(_frame: Frame, setup: Setup, observables: Mapping[str, float]) -> Notes:
    """Return the number of each box, and the masses in and beside the boxes."""
    low = domain_bottom(setup) - 0.5 * _LABEL_ROOM_M
    labels = []
    for box in BOXES:
        mass = observables.get(f"m{box}_g")
        text = f"box {box}" if mass is None else f"box {box}\n{mass:.2f} g"
        labels.append((float(np.mean(box_edges(setup, box))), low, text))
    beside = observables.get("beside_g")
    title = "" if beside is None else f"masses at the end; {beside:.2f} g fell beside the boxes"
    return Notes(title, labels=tuple(labels))


PLATE_IMPACT: Final = Experiment(
    name="plate_impact",
    title="Plate impact",
    caption="Impact on an inclined plate",
    parameters=PARAMETERS,
    observables=(
        *(
            Observable(f"m{box}_g", "g", f"mass in box {box}", high=1e5, part_of="landing")
            for box in BOXES
        ),
        Observable("beside_g", "g", "mass that falls beside all boxes", high=1e5),
    ),
    build=build,
    write=bundled("plate_impact.in.j2"),
    observe=observe,
    chart=chart,
    view=View(
        solid={"plate": 1.0, "pipe": 0.25, "boxes": 0.35},
        at=lambda _setup: 0.45,
        window=window,
        notes=notes,
    ),
    needs=lambda _kind: (FLOW, POURED),
    curves=(
        Curve(
            name="landing",
            unit="g",
            meaning="mass that fell into boxes nearer to the pipe axis than a distance",
            x_name="distance from the pipe axis",
            x_unit="mm",
            levels=LEVELS_MM,
            file=LANDING,
            x_column="distance_mm",
            y_column="mass_g",
            high=1e5,
        ),
    ),
)
