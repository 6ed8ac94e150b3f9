"""How a heap is poured: the variables of the script and the plate, of a slice and of a cone."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from liggghts_io.errors import CaseError
from liggghts_io.experiments.common import common_variables
from liggghts_io.experiments.heap.observing import has_walls, wanted_frames
from liggghts_io.experiments.setup import Build, Setup
from liggghts_io.materials import GLUED
from liggghts_io.scripts.templating import render
from liggghts_io.sizes import extra_radius
from liggghts_io.stl import rectangle

_PACKING: Final = 0.58  # solid fraction of a loose heap
_OUTLET_PACKING: Final = 0.5  # solid fraction of grains that leave a funnel
_STREAM_PACKING: Final = 0.22  # of a stream so thin that grains can be placed in it at random
_GRAVITY: Final = 9.81
_ROOM_D: Final = 4.0  # between plate and border of the box, in diameters
_NARROWEST_D: Final = 3.0  # outlet, in diameters, below which no grain finds its place


def write(variables: Mapping[str, Any]) -> str:
    """Return the script of a heap, from the template of its shape."""
    return render("heap.in.j2" if "slice" in variables else "heap_cone.in.j2", variables)


def build(setup: Setup) -> Build:
    """Return template variables and the plate.

    Raises
    ------
    CaseError
        For an apparatus with which no angle can be measured.
    """
    _check(setup)
    own = _slice(setup) if has_walls(setup) else _cone(setup)
    variables = {**common_variables(setup), "gravity": gravity(setup), **own.variables}
    return Build(variables, own.meshes)


def gravity(setup: Setup) -> tuple[float, float, float]:
    """Return the direction of gravity as a plate sees it that is out of level."""
    x, y = (math.tan(math.radians(setup.apparatus[f"tilt_{axis}_deg"])) for axis in "xy")
    size = math.sqrt(1.0 + x * x + y * y)
    return x / size, y / size, -1.0 / size


def _check(setup: Setup) -> None:
    """Refuse an apparatus with which no angle can be measured."""
    a = setup.apparatus
    if not a["flank_low"] < a["flank_high"]:
        msg = (
            f"heap: flank_low = {a['flank_low']:g} is not below flank_high = {a['flank_high']:g}; "
            "they are the ends of the fitted flank as parts of the height"
        )
        raise CaseError(msg)
    if has_walls(setup) and not wanted_frames(setup):
        msg = (
            f"heap: none of frames = {a['frames']:g} lies in the measured part of the pour "
            f"(measured_from = {a['measured_from']:g}); raise frames or lower measured_from"
        )
        raise CaseError(msg)


def _slice(setup: Setup) -> Build:
    """Return variables and plate of a slice between two side walls."""
    a, d = setup.apparatus, setup.particle.d32_m
    half, side = a["plate_half_length_d"] * d, 0.5 * a["slice_width_d"] * d
    margin = _ROOM_D * d
    blocks = spouts(setup)
    tau = np.sqrt(d / _GRAVITY)
    variables = {
        "domain": (-half - margin, half + margin, -side - d, side + d, -margin, blocks[-1][5] + d),
        "plate_half_length": half,
        "pour_half_width": a["pour_half_width_d"] * d,
        "slice": (-side, side),
        "spouts": blocks,
        "grain_count": a["pour_grains"],
        "grain_rate": a["pour_grains"] / (a["pour_tau"] * tau),
        "pour_interval": a["pour_interval_tau"] * tau,
        "pour_speed": _pour_speed(setup, a["pour_speed_m_s"]),
        "duration": (a["pour_tau"] + a["settle_tau"]) * tau,
    }
    plate = rectangle((-half, half), (-side - 0.5 * d, side + 0.5 * d), 0.0)
    return Build(variables, {"plate": plate})


def _pour_speed(setup: Setup, speed: float) -> float:
    """Return the downward speed of a pour with its error [m/s]."""
    error = setup.apparatus["pour_speed_error_m_s"]
    if speed + error < 0.0:
        msg = (
            f"heap: pour_speed_error_m_s = {error:g} turns the speed of the pour ({speed:.3g} m/s) "
            "upwards; give more"
        )
        raise CaseError(msg)
    return speed + error


def apex(grains: float, setup: Setup) -> float:
    """Height of a slice of `grains` at the steepest angle expected: a ridge or a cone [m]."""
    a, d = setup.apparatus, setup.particle.d32_m
    volume = grains * np.pi / 6.0 * d**3 / _PACKING
    slope = np.tan(np.radians(a["pour_angle_deg"]))
    ridge = np.sqrt(volume / (a["slice_width_d"] * d) * slope)
    return float(min(ridge, cone_height(volume, slope), a["plate_half_length_d"] * d * slope))


def cone_height(volume: float, slope: float) -> float:
    """Height of a cone [m] from its volume [m3] and the tangent of its angle."""
    return float(np.cbrt(3.0 * volume * slope**2 / np.pi))


def spouts(setup: Setup) -> list[tuple[float, ...]]:
    """Return the block of each stage in which grains appear, from the lowest to the highest.

    Raises
    ------
    CaseError
        If the spout is shifted off the slice.
    """
    a, d = setup.apparatus, setup.particle.d32_m
    stages = int(a["pour_stages"])
    more = extra_radius(setup.particle)
    half = a["pour_half_width_d"] * d + more
    across = min(half, 0.5 * a["slice_width_d"] * d)
    x, y = a["pour_offset_x_d"] * d, a["pour_offset_y_d"] * d
    for axis, shift, room in (
        ("x", x, a["plate_half_length_d"] * d - half),
        ("y", y, 0.5 * a["slice_width_d"] * d - across),
    ):
        _check_offset(axis, shift, room, d)
    lows = [
        apex(a["pour_grains"] * (k + 1) / stages, setup) + a["pour_clearance_d"] * d
        for k in range(stages)
    ]
    depth = a["pour_depth_d"] * d + 2.0 * more
    return [(x - half, x + half, y - across, y + across, low, low + depth) for low in lows]


def _check_offset(axis: str, shift: float, room: float, d: float) -> None:
    """Refuse a spout that is shifted further than there is room [m]."""
    if shift and abs(shift) > room:
        msg = (
            f"heap: pour_offset_{axis}_d = {shift / d:g} shifts the pour off the plate or into a "
            f"wall; at most {max(room, 0.0) / d:.3g}"
        )
        raise CaseError(msg)


def _cone(setup: Setup) -> Build:
    """Return variables and plate of a free cone below a funnel.

    Grains appear in the stream where it is thin enough, with the speed of their fall from the
    outlet; above that nothing happens that a heap could notice.
    """
    a, d = setup.apparatus, setup.particle.d32_m
    radius, half = 0.5 * a["outlet_m"], a["plate_half_length_m"]
    x, y = a["pour_offset_x_d"] * d, a["pour_offset_y_d"] * d
    for axis, shift in (("x", x), ("y", y)):
        _check_offset(axis, shift, half - radius, d)
    flow, tau = pour_flow(setup), np.sqrt(d / _GRAVITY)
    interval = a["pour_interval_tau"] * tau
    bottom, depth, speed = _stream(setup, flow, interval)
    more = extra_radius(setup.particle)
    top = bottom + depth + 2.0 * more
    pour, settle = a["cone_mass_kg"] / flow + interval, a["rest_limit_tau"] * tau
    margin = _ROOM_D * d
    variables = {
        "domain": (-half - margin, half + margin) * 2 + (-margin, top + d),
        "outlet": (x, y, radius + more, bottom, top),
        "grain_count": a["cone_mass_kg"] / setup.particle.mass_kg,
        "grain_rate": flow / setup.particle.mass_kg,
        "pour_interval": interval,
        "pour_speed": speed,
        "pour_duration": pour,
        "settle_duration": settle,
        "rest_energy": a["rest_energy"] * _GRAVITY * d,
        "duration": pour + settle,
    }
    return Build(variables, {"plate": rectangle((-half, half), (-half, half), 0.0)})


def pour_flow(setup: Setup) -> float:
    """Return the mass flow of a cone's funnel [kg/s].

    Raises
    ------
    CaseError
        If neither the apparatus nor the particle tells it.
    """
    given, particle = setup.apparatus["pour_flow_kg_s"], setup.particle
    field = "flow_glued_kg_s" if setup.kind == GLUED else "flow_flat_kg_s"
    if given > 0.0:
        return given
    if not particle.has([field]):
        msg = (
            f"heap: how fast the funnel pours {particle.name!r} is not known; give pour_flow_kg_s "
            "of the apparatus, or measure the flow and add it where the particle is described"
        )
        raise CaseError(msg)
    return particle.amount(field)


def _stream(setup: Setup, flow: float, interval: float) -> tuple[float, float, float]:
    """Return bottom and depth [m] of the part of the stream where grains appear, and their speed.

    Raises
    ------
    CaseError
        If the outlet is too narrow, or so low that the heap would reach that part.
    """
    a, particle = setup.apparatus, setup.particle
    d = particle.d32_m
    if a["outlet_m"] < _NARROWEST_D * d:
        msg = (
            f"heap: outlet_m = {a['outlet_m']:g} is less than {_NARROWEST_D:g} diameters of a "
            f"grain ({_NARROWEST_D * d:.3g} m); grains would not find their place, nor flow"
        )
        raise CaseError(msg)
    dense = flow / (particle.density * 0.25 * math.pi * a["outlet_m"] ** 2)  # speed if solid, m/s
    leaving = _pour_speed(setup, dense / _OUTLET_PACKING)
    speed = max(dense / _STREAM_PACKING, leaving)
    fall = (speed**2 - leaving**2) / (2.0 * _GRAVITY)
    depth = speed * interval + d
    bottom = a["outlet_height_m"] - fall - depth
    volume = a["cone_mass_kg"] / particle.density / _PACKING
    top = cone_height(volume, math.tan(math.radians(a["pour_angle_deg"])))
    if bottom < top:
        msg = (
            f"heap: outlet_height_m = {a['outlet_height_m']:g}: the stream is thin enough to place "
            f"grains {fall + depth:.3g} m below the outlet, and a heap of {a['pour_angle_deg']:g} "
            f"deg would be {top:.3g} m high; raise the outlet or pour less"
        )
        raise CaseError(msg)
    return bottom, depth, speed
