"""Apparatus of the plate impact: pipe, plate, boxes, and the planes that count."""

from __future__ import annotations

from itertools import pairwise
from typing import Final

import numpy as np

from liggghts_io.errors import CaseError
from liggghts_io.experiments.common import common_variables, leaning
from liggghts_io.experiments.setup import Build, Meshes, Setup
from liggghts_io.measure.landings import Opening
from liggghts_io.sizes import extra_radius, simulated_sizes
from liggghts_io.stl import open_box, quad, rectangle, tube

BOXES: Final = (1, 2, 3, 4)
FLOW: Final = "flow_flat_kg_s"
POURED: Final = "impact_mass_kg"
"""Fields of the particle: flow of the funnel, and the mass that is poured in reality."""

_ANGLE_DEG: Final = 45.0
_BELOW_M: Final = 0.004  # from the boxes down to where grains leave the simulation
_BESIDE_M: Final = (0.04, 0.03)  # room in front of the pipe's axis and behind the last box


def box_edges(setup: Setup, box: int) -> tuple[float, float]:
    """Return near and far wall of a box from the pipe axis [m]."""
    a = setup.apparatus
    shift = a["box_shift_x_m"]
    return a[f"box_{box}_near_m"] + shift, a[f"box_{box}_far_m"] + shift


def opening(setup: Setup, box: int) -> Opening:
    """Return the mouth of a box."""
    a = setup.apparatus
    return Opening(*box_edges(setup, box), a["box_width_m"], a["box_shift_z_m"])


def domain_bottom(setup: Setup) -> float:
    """Return where grains leave the simulation, below the boxes [m]."""
    a = setup.apparatus
    return a["box_shift_z_m"] - a["box_depth_m"] - _BELOW_M


def domain_x(setup: Setup) -> tuple[float, float]:
    """Return between which distances from the pipe axis grains are followed [m]."""
    a = setup.apparatus
    return -_BESIDE_M[0], a["box_4_far_m"] + max(0.0, a["box_shift_x_m"]) + _BESIDE_M[1]


def _across(setup: Setup) -> tuple[float, float]:
    a = setup.apparatus
    half = 0.5 * max(a["box_width_m"], a["plate_width_m"]) + 0.01
    return -half, half


def landing_height(setup: Setup) -> float:
    """Return the height of the plane at which landings are recorded [m].

    It lies a diameter of the largest grain above the mouths of the boxes, so that no grain has
    touched a rim before.
    """
    largest = max(diameter for diameter, _ in simulated_sizes(setup.particle))
    return setup.apparatus["box_shift_z_m"] + largest


def _slope(setup: Setup) -> tuple[float, float]:
    """Return cosine and sine of the plate's slope."""
    angle = np.radians(_ANGLE_DEG + setup.apparatus["plate_angle_error_deg"])
    return float(np.cos(angle)), float(np.sin(angle))


def _check(setup: Setup) -> None:
    """Refuse parts that overlap or have no mouth, and a funnel that is not over the pipe."""
    a = setup.apparatus
    walls = [name for box in BOXES for name in (f"box_{box}_near_m", f"box_{box}_far_m")]
    for left, right in pairwise(walls):
        if a[left] >= a[right]:
            msg = (
                f"plate_impact: {right} = {a[right]:g} is not beyond {left} = {a[left]:g}; the "
                "walls of the boxes follow each other away from the pipe"
            )
            raise CaseError(msg)
    spout = a["spout_radius_m"] + extra_radius(setup.particle)
    reach = spout + np.hypot(a["pour_offset_x_m"], a["pour_offset_y_m"])
    if reach > a["pipe_radius_m"]:
        msg = (
            f"plate_impact: the funnel outlet reaches {reach:g} m from the axis (spout_radius_m, "
            "pour_offset and the size of the grains), more than pipe_radius_m = "
            f"{a['pipe_radius_m']:g}; grains would appear inside the wall of the pipe"
        )
        raise CaseError(msg)
    low = a["plate_height_m"] - a["plate_down_m"] * _slope(setup)[1]
    if low <= landing_height(setup):
        msg = (
            f"plate_impact: the lower edge of the plate, {low:.4g} m high, is not above the mouths "
            f"of the boxes with a grain between ({landing_height(setup):.4g} m); raise "
            "plate_height_m or lower box_shift_z_m"
        )
        raise CaseError(msg)


def _meshes(setup: Setup) -> Meshes:
    a = setup.apparatus
    cosine, sine = _slope(setup)
    height, half = a["plate_height_m"], 0.5 * a["plate_width_m"]
    up, down = a["plate_up_m"], a["plate_down_m"]
    plate = quad(
        (-up * cosine, -half, height + up * sine),
        (down * cosine, -half, height - down * sine),
        (down * cosine, half, height - down * sine),
        (-up * cosine, half, height + up * sine),
    )
    bottom = height + a["pipe_gap_m"]
    radius, y = a["pipe_radius_m"], (-0.5 * a["box_width_m"], 0.5 * a["box_width_m"])
    top = bottom + a["pipe_length_m"]
    pipe = tube((radius, radius), (bottom, top))
    mouth = a["box_shift_z_m"]
    depth = (mouth - a["box_depth_m"], mouth)
    edges = [box_edges(setup, box) for box in BOXES]
    boxes = np.concatenate([open_box(x, y, depth, floor=False) for x in edges])
    # Half way down, where a grain that bounced off a wall stays in.
    mouths = {
        f"mouth{box}": rectangle(x, y, mouth - 0.5 * a["box_depth_m"])
        for box, x in zip(BOXES, edges, strict=True)
    }
    outlet_z = top - a["pour_depth_m"] - 2.0 * extra_radius(setup.particle)
    outlet = rectangle((-radius, radius), (-radius, radius), outlet_z)
    landing = rectangle(domain_x(setup), _across(setup), landing_height(setup))
    return {
        "plate": plate, "pipe": pipe, "boxes": boxes, **mouths, "outlet": outlet,
        "landing": landing,
    }  # fmt: skip


def build(setup: Setup) -> Build:
    """Return template variables, plate, pipe, boxes and the planes that count."""
    _check(setup)
    a, particle = setup.apparatus, setup.particle
    bottom = a["plate_height_m"] + a["pipe_gap_m"]
    top = bottom + a["pipe_length_m"]
    count = a["mass_fraction"] * particle.amount(POURED) / particle.mass_kg
    rate = a["flow_factor"] * particle.amount(FLOW) / particle.mass_kg
    variables = {
        **common_variables(setup),
        "gravity": leaning(a["tilt_x_deg"], a["tilt_y_deg"]),
        "domain": (*domain_x(setup), *_across(setup), domain_bottom(setup), top + 0.005),
        "plate_height": a["plate_height_m"],
        "pipe_bottom": bottom,
        "spout_radius": a["spout_radius_m"] + extra_radius(particle),
        "spout_axis": (a["pour_offset_x_m"], a["pour_offset_y_m"]),
        "spout": (top - a["pour_depth_m"] - 2.0 * extra_radius(particle), top),
        "grain_count": count,
        "grain_rate": rate,
        "pour_interval": a["pour_interval_s"],
        "pour_speed": a["pour_speed_m_s"],
        "duration": count / rate + a["flight_s"],
    }
    return Build(variables, _meshes(setup))
