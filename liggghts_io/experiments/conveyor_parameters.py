"""Numbers that describe the conveyor: plate, motion, funnel, scale, and what may be off in them."""

from __future__ import annotations

from typing import Final

from liggghts_io.experiments.common import FLOW_NUISANCE, NUISANCE, ROOM, SPEED, common_parameters
from liggghts_io.experiments.numbers import Parameter, same
from liggghts_io.experiments.plate_motion import MOTION_PARAMETERS

__all__ = ["CONVEYOR_PARAMETERS"]

_SIMILAR: Final = "paper: the whole plate; quick and lab: ours, similar to it (docs/apparatus.md)"
_CHOSEN: Final = "ours: docs/apparatus.md, horizontal conveyor"

_DEVIATIONS: Final = (
    same(
        "tilt_deg",
        "deg",
        "slope of the plate down towards its end",
        0.0,
        (-10.0, 10.0),
        source=NUISANCE,
    ),
    same(
        "cross_tilt_deg",
        "deg",
        "slope of the plate across the transport, down towards +y",
        0.0,
        (-10.0, 10.0),
        source=NUISANCE,
    ),
    same(
        "pour_offset_m",
        "m",
        "how far the funnel stands off pour_position, towards the end of the plate",
        0.0,
        (-1.0, 1.0),
        source=NUISANCE,
    ),
    same(
        "mass_flow_factor",
        "-",
        "factor on the measured flow of the funnel",
        1.0,
        (0.01, 100.0),
        source=FLOW_NUISANCE,
    ),
)
"""What nobody set and may be off all the same; neutral by default. Those of the motion: there."""

_RESIDENTS: Final = (
    Parameter(
        "resident_mass_kg",
        "kg",
        "poured beforehand on a glued plate, which keeps grains of it; 0: a bare plate",
        0.0,
        0.2,
        0.2,
        (0.0, 100.0),
        source="ours: leaves a closed layer (docs/apparatus.md, residents); section 2.5.2: some",
    ),
    same(
        "resident_duration_s",
        "s",
        "from the beginning of that pour to that of the measured one, real time",
        45.0,
        (0.1, 1e4),
        source="ours: the paper waits until none leaves (docs/apparatus.md, residents)",
    ),
)

CONVEYOR_PARAMETERS: Final = (
    *common_parameters(),
    Parameter(
        "length_fraction",
        "-",
        "similarity factor of lengths, masses and times",
        0.1,
        0.2,
        1.0,
        (0.01, 1.0),
        source=_SIMILAR,
    ),
    Parameter(
        "width_fraction",
        "-",
        "part of the plate width that is simulated",
        0.12,
        0.125,
        1.0,
        (0.01, 1.0),
        source=_SIMILAR,
    ),
    Parameter(
        "slice_width_d",
        "d",
        "widest slice that is simulated, whatever width_fraction says; 0: no limit",
        0.0,
        6.5,
        0.0,
        (0.0, 1e4),
        source="ours: HSP13 fills the lab slice with 6.3; finer grains need no more of them",
    ),
    Parameter(
        "periodic_slice",
        "-",
        "1: the slice goes on periodically across the plate; 0: it lies between smooth walls",
        0.0,
        1.0,
        0.0,
        (0.0, 1.0),
        whole=True,
        source="ours: docs/apparatus.md, slice",
    ),
    same(
        "plate_length_m",
        "m",
        "from the back stop to the end of the plate",
        0.4,
        (0.01, 10.0),
        source=_CHOSEN,
    ),
    Parameter(
        "plate_width_m", "m", "width of the plate", 0.04, 0.08, 0.08, (2e-3, 2.0), source=_CHOSEN
    ),
    same(
        "pour_position_m",
        "m",
        "middle of the funnel in front of the back stop",
        0.08,
        (1e-3, 10.0),
        source=_CHOSEN,
    ),
    same(
        "poured_mass_kg",
        "kg",
        "mass in the funnel",
        0.3,
        (1e-4, 100.0),
        source="Grobbel et al. 2019, section 2.5.2",
    ),
    same(
        "target_mass_kg",
        "kg",
        "mass on the scale at which the time is taken",
        0.1,
        (1e-5, 100.0),
        source="Grobbel et al. 2019, section 2.5.2",
    ),
    *_DEVIATIONS,
    *MOTION_PARAMETERS,
    *_RESIDENTS,
    same(
        "pour_height_d",
        "d",
        "lower edge of the spout above the plate",
        9.0,
        (0.5, 1000.0),
        source=_CHOSEN,
    ),
    same("pour_depth_d", "d", "height of the spout", 5.0, (1.5, 100.0), source=ROOM),
    same(
        "pour_half_width_d",
        "d",
        "half length of the spout along the plate",
        2.0,
        (0.6, 100.0),
        source=_CHOSEN,
    ),
    same("pour_speed_m_s", "m/s", "downward speed at the spout", 0.1, (0.0, 10.0), source=_CHOSEN),
    same("pour_interval_s", "s", "time between two insertions", 0.005, (1e-4, 1.0), source=ROOM),
    same(
        "scale_drop_d",
        "d",
        "height of the plate above the scale",
        2.0,
        (0.5, 100.0),
        source="ours: the duration of the fall is taken out of the time",
    ),
    Parameter(
        "duration_flat_s",
        "s",
        "longest time that is simulated, flat plate, real time",
        14.0,
        24.0,
        24.0,
        (0.1, 1e4),
        source="ours: longer than the slowest takes; lab and paper: funnel and plate empty",
    ),
    Parameter(
        "duration_glued_s",
        "s",
        "longest time that is simulated, glued plate, real time",
        24.0,
        40.0,
        40.0,
        (0.1, 1e4),
        source="ours: longer than the slowest takes; lab and paper: funnel empty",
    ),
    same("skin_d", "d", "neighbour skin", 0.15, (0.01, 5.0), source=SPEED),
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
