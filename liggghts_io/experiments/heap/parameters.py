"""Numbers of the heap's apparatus: those of both shapes, of the slice and of the cone."""

from __future__ import annotations

from typing import Final

from liggghts_io.experiments.common import NUISANCE, ROOM, SPEED, common_parameters
from liggghts_io.experiments.numbers import Parameter, same

_SLICE_SOURCE: Final = "ours: docs/apparatus.md, why the slice is as it is"

_SHAPE: Final = (
    Parameter(
        "side_walls",
        "-",
        "1: a slice between two side walls, measured while it grows; 0: a free cone below a "
        "funnel, measured at rest",
        1.0,
        1.0,
        0.0,
        (0.0, 1.0),
        whole=True,
        source="paper: as section 2.5.1 photographs it; quick and lab: ours, the cheapest",
    ),
    same(
        "pour_angle_deg",
        "deg",
        "angle from which the highest apex is computed",
        45.0,
        (5.0, 80.0),
        source="ours: about that of the steepest measured heap, 46 degrees (table B.4)",
    ),
    same(
        "pour_interval_tau",
        "sqrt(d/g)",
        "time between two insertions",
        0.6,
        (0.01, 100.0),
        source=ROOM,
    ),
    same("skin_d", "d", "neighbour skin", 0.15, (0.01, 5.0), source=SPEED),
    same(
        "frames",
        "-",
        "number of dumps over the run (slice) or the pour (cone)",
        40.0,
        (5.0, 1e4),
        whole=True,
        source=_SLICE_SOURCE,
    ),
    same(
        "flank_low",
        "-",
        "lower end of the fitted flank as a part of the height",
        0.15,
        (0.0, 0.9),
        source=_SLICE_SOURCE,
    ),
    same(
        "flank_high",
        "-",
        "upper end of the fitted flank as a part of the height",
        0.9,
        (0.1, 1.0),
        source=_SLICE_SOURCE,
    ),
)

_SLICE: Final = (
    Parameter(
        "plate_half_length_d",
        "d",
        "slice: half length of the plate; what rolls off it is lost",
        16.0,
        30.0,
        60.0,
        (2.0, 1000.0),
        source=_SLICE_SOURCE,
    ),
    Parameter(
        "slice_width_d",
        "d",
        "slice: distance of the side walls",
        3.0,
        8.0,
        120.0,
        (1.5, 1000.0),
        source=_SLICE_SOURCE,
    ),
    Parameter(
        "pour_half_width_d",
        "d",
        "slice: half side of the square spout",
        2.0,
        2.0,
        3.0,
        (0.6, 100.0),
        source=_SLICE_SOURCE,
    ),
    same(
        "pour_stages",
        "-",
        "slice: how many times the spout is raised while the heap grows",
        5.0,
        (1.0, 100.0),
        whole=True,
        source=_SLICE_SOURCE,
    ),
    same(
        "pour_clearance_d",
        "d",
        "slice: spout above the highest apex expected in its stage",
        1.5,
        (0.0, 100.0),
        source=_SLICE_SOURCE,
    ),
    same("pour_depth_d", "d", "slice: height of the spout", 3.0, (1.5, 100.0), source=ROOM),
    same(
        "pour_speed_m_s",
        "m/s",
        "slice: downward speed at the spout",
        0.05,
        (0.0, 10.0),
        source=_SLICE_SOURCE,
    ),
    Parameter(
        "pour_grains",
        "-",
        "slice: number of grains poured",
        800.0,
        4000.0,
        60000.0,
        (10.0, 1e7),
        whole=True,
        source=_SLICE_SOURCE,
    ),
    Parameter(
        "pour_tau",
        "sqrt(d/g)",
        "slice: duration of the pour in falls over a diameter",
        90.0,
        350.0,
        1500.0,
        (1.0, 1e5),
        source=_SLICE_SOURCE,
    ),
    same(
        "settle_tau",
        "sqrt(d/g)",
        "slice: time without pouring at the end",
        10.0,
        (0.0, 1e5),
        source=_SLICE_SOURCE,
    ),
    same(
        "measured_from",
        "-",
        "slice: part of the pour after which the angle is averaged",
        0.5,
        (0.0, 0.95),
        source=_SLICE_SOURCE,
    ),
)

_CONE: Final = (
    same(
        "outlet_m",
        "m",
        "cone: diameter of the funnel's outlet",
        0.0075,
        (1e-4, 1.0),
        source="Grobbel et al. 2019, appendix B: nominal size of all funnels",
    ),
    same(
        "outlet_height_m",
        "m",
        "cone: height of the outlet above the plate",
        0.06,
        (1e-3, 10.0),
        source="ours: the paper prints no height",
    ),
    same(
        "cone_mass_kg",
        "kg",
        "cone: mass poured",
        0.04,
        (1e-5, 100.0),
        source="ours: less is no heap on steel (docs/apparatus.md, slice or cone)",
    ),
    same(
        "pour_flow_kg_s",
        "kg/s",
        "cone: mass flow of the funnel; 0 takes the one measured with the particle",
        0.0,
        (0.0, 100.0),
        source="Grobbel et al. 2019, table B.9, where the particle has it",
    ),
    same(
        "plate_half_length_m",
        "m",
        "cone: half length of the square plate; what rolls off it is lost",
        0.06,
        (1e-3, 10.0),
        source="ours: holds the whole heap; the paper prints no plate",
    ),
    same(
        "rest_energy",
        "m g d",
        "cone: at rest when the mean kinetic energy of a grain is below this",
        1e-5,
        (1e-12, 1.0),
        source="ours: a fall by a hundred-thousandth of a diameter",
    ),
    same(
        "rest_limit_tau",
        "sqrt(d/g)",
        "cone: longest time to come to rest after the pour; a heap that moves still has no angle",
        150.0,
        (1.0, 1e5),
        source="ours: a heap that moves still then is a failed run",
    ),
    same(
        "views",
        "-",
        "cone: directions over half a turn from which the silhouette is taken",
        6.0,
        (1.0, 180.0),
        whole=True,
        source="ours: every 30 degrees; the paper took one photograph",
    ),
)

_NUISANCES: Final = (
    same(
        "tilt_x_deg",
        "deg",
        "error of the plate's level: slope down towards +x, as the direction of gravity",
        0.0,
        (-20.0, 20.0),
        source=NUISANCE,
    ),
    same(
        "tilt_y_deg",
        "deg",
        "error of the plate's level: slope down towards +y, as the direction of gravity",
        0.0,
        (-20.0, 20.0),
        source=NUISANCE,
    ),
    same(
        "pour_offset_x_d", "d", "shift of the spout along x", 0.0, (-100.0, 100.0), source=NUISANCE
    ),
    same(
        "pour_offset_y_d", "d", "shift of the spout along y", 0.0, (-100.0, 100.0), source=NUISANCE
    ),
    same(
        "pour_speed_error_m_s",
        "m/s",
        "added to the downward speed at the spout or outlet",
        0.0,
        (-10.0, 10.0),
        source=NUISANCE,
    ),
)

PARAMETERS: Final = (
    *common_parameters(mu_side=0.2, mu_roll_side=0.1),
    *_SHAPE,
    *_SLICE,
    *_CONE,
    *_NUISANCES,
)
