"""Numbers of the plate impact's apparatus: funnel, pipe, plate, boxes, and what may be off."""

from __future__ import annotations

from typing import Final

from liggghts_io.experiments.common import FLOW_NUISANCE, NUISANCE, ROOM, SPEED, common_parameters
from liggghts_io.experiments.numbers import Parameter, same

_NEAR: Final = (-0.05, 0.05)  # limits of shifts [m]
_CHOSEN: Final = "ours: docs/apparatus.md, plate impact"
_BOXES: Final = (
    "ours: where HSP13 on steel gives the measured masses (docs/apparatus.md, plate impact)"
)

PARAMETERS: Final = (
    *common_parameters(mu_side=0.3, mu_roll_side=0.1),
    Parameter(
        "mass_fraction",
        "-",
        "part of the real mass that is poured",
        0.2,
        0.5,
        1.0,
        (1e-3, 1.0),
        source="paper: all of the measured mass (table B.6); quick and lab: ours, for fewer grains",
    ),
    same(
        "flow_factor",
        "-",
        "factor on the flow of the funnel",
        1.0,
        (0.01, 100.0),
        source=FLOW_NUISANCE,
    ),
    same(
        "spout_radius_m",
        "m",
        "radius of the funnel outlet",
        0.00375,
        (1e-4, 0.1),
        source="Grobbel et al. 2019, appendix B: nominal size of all funnels",
    ),
    same("pour_speed_m_s", "m/s", "speed at the funnel outlet", 0.5, (0.0, 20.0), source=_CHOSEN),
    same(
        "pour_offset_x_m",
        "m",
        "funnel outlet off the pipe's axis, to the boxes",
        0.0,
        _NEAR,
        source=NUISANCE,
    ),
    same(
        "pour_offset_y_m",
        "m",
        "funnel outlet off the pipe's axis, across",
        0.0,
        _NEAR,
        source=NUISANCE,
    ),
    same(
        "pour_depth_m",
        "m",
        "height of the cylinder in which grains appear",
        0.006,
        (1e-4, 1.0),
        source="ours; with more room the flow is larger (docs/apparatus.md, plate impact)",
    ),
    same("pour_interval_s", "s", "time between two insertions", 0.002, (1e-4, 1.0), source=ROOM),
    same("pipe_radius_m", "m", "inner radius of the pipe", 0.008, (1e-4, 0.5), source=_CHOSEN),
    same("pipe_length_m", "m", "length of the pipe", 0.12, (1e-3, 10.0), source=_CHOSEN),
    same(
        "pipe_gap_m",
        "m",
        "from the pipe's end down to the plate, on the axis",
        0.03,
        (1e-3, 10.0),
        source=_CHOSEN,
    ),
    same(
        "plate_height_m",
        "m",
        "where the pipe axis meets the plate, above the box mouths",
        0.06,
        (1e-3, 10.0),
        source=_CHOSEN,
    ),
    same(
        "plate_up_m",
        "m",
        "length of the plate above the axis, along the slope",
        0.02,
        (1e-3, 1.0),
        source=_CHOSEN,
    ),
    same(
        "plate_down_m",
        "m",
        "length of the plate below the axis, along the slope",
        0.01,
        (1e-3, 1.0),
        source=_CHOSEN,
    ),
    same(
        "plate_angle_error_deg",
        "deg",
        "slope of the plate beyond 45 degrees",
        0.0,
        (-20.0, 20.0),
        source=NUISANCE,
    ),
    same(
        "tilt_x_deg",
        "deg",
        "apparatus leans towards the boxes",
        0.0,
        (-10.0, 10.0),
        source=NUISANCE,
    ),
    same("tilt_y_deg", "deg", "apparatus leans across", 0.0, (-10.0, 10.0), source=NUISANCE),
    same("plate_width_m", "m", "width of the plate", 0.06, (1e-3, 1.0), source=_CHOSEN),
    same(
        "box_depth_m",
        "m",
        "depth of the boxes below their mouths",
        0.02,
        (1e-3, 1.0),
        source=_CHOSEN,
    ),
    same(
        "box_width_m", "m", "width of the boxes across the plate", 0.06, (1e-3, 1.0), source=_CHOSEN
    ),
    same(
        "box_1_near_m",
        "m",
        "near wall of box 1 from the pipe axis",
        0.036,
        (1e-3, 10.0),
        source=_BOXES,
    ),
    same("box_1_far_m", "m", "far wall of box 1", 0.0565, (1e-3, 10.0), source=_BOXES),
    same("box_2_near_m", "m", "near wall of box 2", 0.0585, (1e-3, 10.0), source=_BOXES),
    same("box_2_far_m", "m", "far wall of box 2", 0.07, (1e-3, 10.0), source=_BOXES),
    same("box_3_near_m", "m", "near wall of box 3", 0.072, (1e-3, 10.0), source=_BOXES),
    same("box_3_far_m", "m", "far wall of box 3", 0.0905, (1e-3, 10.0), source=_BOXES),
    same("box_4_near_m", "m", "near wall of box 4", 0.0925, (1e-3, 10.0), source=_BOXES),
    same("box_4_far_m", "m", "far wall of box 4", 0.12, (1e-3, 10.0), source=_BOXES),
    same(
        "box_rims",
        "-",
        "1: grains bounce off the rims of boxes, 0: boxes are openings alone",
        0.0,
        (0.0, 1.0),
        whole=True,
        source="ours: openings, since nothing of the walls is printed (docs/apparatus.md)",
    ),
    same(
        "box_shift_x_m",
        "m",
        "all boxes farther from the pipe than given",
        0.0,
        _NEAR,
        source=NUISANCE,
    ),
    same("box_shift_z_m", "m", "all boxes higher than given", 0.0, _NEAR, source=NUISANCE),
    same(
        "flight_s",
        "s",
        "time for the last grain to come down",
        0.35,
        (0.01, 100.0),
        source="ours: twice the free fall from the outlet to the boxes",
    ),
    same("skin_d", "d", "neighbour skin", 1.0, (0.01, 5.0), source=SPEED),
    same(
        "frames",
        "-",
        "number of dumps over the run",
        12.0,
        (1.0, 1e4),
        whole=True,
        source="ours: pictures, and what is there at the end",
    ),
)
