"""Angle of repose: grains poured between two side walls on the plate under test."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np

from liggghts_io.errors import CaseError
from liggghts_io.experiments.base import Experiment, bundled
from liggghts_io.experiments.common import common_parameters, common_variables
from liggghts_io.experiments.numbers import Curve, Observable, Parameter, same
from liggghts_io.experiments.setup import Build, Observed, Setup
from liggghts_io.experiments.view import Notes, View
from liggghts_io.measure.dumps import FloatArray, Frame, all_frames, read_frame
from liggghts_io.measure.silhouette import FlankFit, Repose, angle_of_repose, draw_silhouette
from liggghts_io.stl import rectangle

_PIXELS_PER_DIAMETER: Final = 16.0
FLANK: Final = "flank.csv"
LEVELS: Final = tuple(k / 10 for k in range(1, 10))
"""Distances from the middle at which the flank is compared, as parts of half the base."""

_PACKING: Final = 0.58  # solid fraction of a loose heap
_GRAVITY: Final = 9.81

PARAMETERS: Final = (
    *common_parameters(mu_side=0.2, mu_roll_side=0.1),
    Parameter(
        "plate_half_length_d",
        "d",
        "half length of the plate; what rolls off it is lost",
        16.0,
        30.0,
        60.0,
        (2.0, 1000.0),
    ),
    Parameter("slice_width_d", "d", "distance of the side walls", 3.0, 8.0, 120.0, (1.5, 1000.0)),
    Parameter(
        "pour_half_width_d", "d", "half side of the square spout", 2.0, 2.0, 3.0, (0.6, 100.0)
    ),
    same(
        "pour_stages",
        "-",
        "how many times the spout is raised while the heap grows",
        5.0,
        (1.0, 100.0),
        whole=True,
    ),
    same(
        "pour_clearance_d",
        "d",
        "spout above the highest apex expected in its stage",
        1.5,
        (0.0, 100.0),
    ),
    same("pour_angle_deg", "deg", "angle from which that apex is computed", 45.0, (5.0, 80.0)),
    same("pour_depth_d", "d", "height of the spout", 3.0, (1.5, 100.0)),
    same("pour_speed_m_s", "m/s", "downward speed at the spout", 0.05, (0.0, 10.0)),
    Parameter(
        "pour_grains",
        "-",
        "number of grains poured",
        800.0,
        4000.0,
        60000.0,
        (10.0, 1e7),
        whole=True,
    ),
    Parameter(
        "pour_tau",
        "sqrt(d/g)",
        "duration of the pour in falls over a diameter",
        90.0,
        350.0,
        1500.0,
        (1.0, 1e5),
    ),
    same("pour_interval_tau", "sqrt(d/g)", "time between two insertions", 0.6, (0.01, 100.0)),
    same("settle_tau", "sqrt(d/g)", "time without pouring at the end", 10.0, (0.0, 1e5)),
    same("skin_d", "d", "neighbour skin", 0.15, (0.01, 5.0)),
    same("frames", "-", "number of dumps over the run", 40.0, (5.0, 1e4), whole=True),
    same(
        "measured_from", "-", "part of the pour after which the angle is averaged", 0.5, (0.0, 0.95)
    ),
    same(
        "flank_low", "-", "lower end of the fitted flank as a part of the height", 0.15, (0.0, 0.9)
    ),
    same(
        "flank_high", "-", "upper end of the fitted flank as a part of the height", 0.9, (0.1, 1.0)
    ),
)


def apex(grains: float, setup: Setup) -> float:
    """Height of a heap of `grains` at the steepest angle expected: a ridge or a cone [m]."""
    a, d = setup.apparatus, setup.particle.d32_m
    volume = grains * np.pi / 6.0 * d**3 / _PACKING
    slope = np.tan(np.radians(a["pour_angle_deg"]))
    ridge = np.sqrt(volume / (a["slice_width_d"] * d) * slope)
    cone = np.cbrt(3.0 * volume * slope**2 / np.pi)
    return float(min(ridge, cone, a["plate_half_length_d"] * d * slope))


def spouts(setup: Setup) -> list[tuple[float, ...]]:
    """Return the block of each stage in which grains appear, from the lowest to the highest."""
    a, d = setup.apparatus, setup.particle.d32_m
    stages = int(a["pour_stages"])
    half = a["pour_half_width_d"] * d
    y = min(half, 0.5 * a["slice_width_d"] * d)
    lows = [
        apex(a["pour_grains"] * (k + 1) / stages, setup) + a["pour_clearance_d"] * d
        for k in range(stages)
    ]
    return [(-half, half, -y, y, low, low + a["pour_depth_d"] * d) for low in lows]


def _check(setup: Setup) -> None:
    """Refuse an apparatus with which no angle can be measured."""
    a = setup.apparatus
    if not a["flank_low"] < a["flank_high"]:
        msg = (
            f"heap: flank_low = {a['flank_low']:g} is not below flank_high = {a['flank_high']:g}; "
            "they are the ends of the fitted flank as parts of the height"
        )
        raise CaseError(msg)
    if not wanted_frames(setup):
        msg = (
            f"heap: none of frames = {a['frames']:g} lies in the measured part of the pour "
            f"(measured_from = {a['measured_from']:g}); raise frames or lower measured_from"
        )
        raise CaseError(msg)


def build(setup: Setup) -> Build:
    """Return template variables and the plate."""
    a, d = setup.apparatus, setup.particle.d32_m
    _check(setup)
    half, side = a["plate_half_length_d"] * d, 0.5 * a["slice_width_d"] * d
    margin = 4.0 * d
    blocks = spouts(setup)
    tau = np.sqrt(d / _GRAVITY)
    variables = {
        **common_variables(setup),
        "domain": (-half - margin, half + margin, -side - d, side + d, -margin, blocks[-1][5] + d),
        "plate_half_length": half,
        "pour_half_width": a["pour_half_width_d"] * d,
        "slice": (-side, side),
        "spouts": blocks,
        "grain_count": a["pour_grains"],
        "grain_rate": a["pour_grains"] / (a["pour_tau"] * tau),
        "pour_interval": a["pour_interval_tau"] * tau,
        "pour_speed": a["pour_speed_m_s"],
        "duration": (a["pour_tau"] + a["settle_tau"]) * tau,
    }
    plate = rectangle((-half, half), (-side - 0.5 * d, side + 0.5 * d), 0.0)
    return Build(variables, {"plate": plate})


def measure(frame: Frame, setup: Setup) -> Repose:
    """Measure the heap of one frame on its silhouette; grains in the air are left out."""
    c, a, d = frame.columns, setup.apparatus, setup.particle.d32_m
    # Falling grains are faster than any in the heap: a free fall over one diameter.
    resting = frame.speeds < np.sqrt(2.0 * _GRAVITY * d)
    shadow = draw_silhouette(
        c["x"][resting], c["z"][resting], c["radius"][resting], d / _PIXELS_PER_DIAMETER
    )
    fit = FlankFit(a["flank_low"], a["flank_high"])
    repose = angle_of_repose(shadow.image, shadow.metres_per_pixel, dark_heap=True, fit=fit)
    return repose.shifted(shadow.left_m)


def pour_end(setup: Setup) -> float:
    """Return the part of the run after which nothing is poured any more."""
    a = setup.apparatus
    return a["pour_tau"] / (a["pour_tau"] + a["settle_tau"])


def wanted_frames(setup: Setup) -> list[int]:
    """Return the numbers of the frames over which the angle is averaged."""
    a, pour = setup.apparatus, pour_end(setup)
    total = int(a["frames"])
    return [k for k in range(total + 1) if a["measured_from"] * pour <= k / total <= pour]


def measured_frames(folder: Path, setup: Setup) -> list[Frame]:
    """Return the frames of the later part of the pour, over which the angle is averaged.

    A single picture scatters by some two degrees, because the slope builds up and slides down
    again and again; the mean over the growing heap does not.

    Raises
    ------
    CaseError
        If no frame falls into that part; DamagedFile if the run is not whole.
    """
    wanted = wanted_frames(setup)
    if not wanted:
        total = setup.apparatus["frames"]
        msg = f"frames = {total:g}: none falls into the measured part of the pour; ask for more"
        raise CaseError(msg)
    paths = all_frames(folder)
    return [read_frame(paths[k]) for k in wanted]


def flank(repose: Repose) -> FloatArray:
    """Return the height of the outline at `LEVELS`, mean of both sides, over half the base.

    Returns
    -------
    (L,) float64
        Height and distance are parts of half the base, so that heaps of any size can be compared.
    """
    x, z = repose.outline.T
    half, middle = 0.5 * repose.base_m, 0.5 * float(x.min() + x.max())
    away = half * np.array(LEVELS)
    sides = [np.interp(middle + side * away, x, z) for side in (-1.0, 1.0)]
    return np.asarray(np.mean(sides, axis=0) / half, dtype=np.float64)


def observe(folder: Path, setup: Setup) -> Observed:
    """Average the angle of repose and the flank over the later part of the pour."""
    heaps = [measure(frame, setup) for frame in measured_frames(folder, setup)]
    angle = float(np.mean([one.angle_deg for one in heaps]))
    profile = np.mean([flank(one) for one in heaps], axis=0)
    table = {"distance": np.array(LEVELS), "height": profile}
    return Observed({"angle_deg": angle}, {FLANK: table})


def notes(frame: Frame, setup: Setup, observables: Mapping[str, float]) -> Notes:
    """Return the flanks as they are fitted in one frame, with their angles."""
    known = observables.get("angle_deg")
    title = "" if known is None else f"mean over the later pour {known:.1f}°"
    try:
        repose = measure(frame, setup)
    except CaseError:  # an early frame: no heap yet
        return Notes(title)
    here = f"in this picture {repose.angle_deg:.1f}°"
    labels = []
    for line, angle, side in zip(
        repose.lines, (repose.left_deg, repose.right_deg), (-1.0, 1.0), strict=True
    ):
        x, z = line.mean(axis=0)
        beside = side * 2.0 * setup.particle.d32_m
        labels.append((float(x + beside), float(z + abs(beside)), f"{angle:.1f}°"))
    return Notes(f"{here}, {title}" if title else here, tuple(repose.lines), tuple(labels))


def chart(folder: Path, setup: Setup, observables: Mapping[str, float], axes: Any) -> None:
    """Draw the silhouette at the end of the pour with the fitted flanks."""
    repose = measure(measured_frames(folder, setup)[-1], setup)
    x, z = repose.outline.T * 1e3
    axes.fill_between(x, z, color="0.75", label="silhouette at the end of the pour")
    for line, angle in zip(repose.lines * 1e3, (repose.left_deg, repose.right_deg), strict=True):
        axes.plot(line[:, 0], line[:, 1], linewidth=2.5, label=f"flank {angle:.1f}°")
    axes.set(aspect="equal", xlabel="x (mm)", ylabel="height above the plate (mm)")
    mean = observables["angle_deg"]
    axes.legend(title=f"mean over the pour {mean:.1f}°", loc="lower center")


HEAP: Final = Experiment(
    name="heap",
    title="Angle of repose",
    caption="Heap for the angle of repose",
    parameters=PARAMETERS,
    observables=(
        Observable(
            "angle_deg",
            "deg",
            "mean slope of both flanks while the heap grows",
            high=90.0,
            part_of="flank",
        ),
    ),
    build=build,
    write=bundled("heap.in.j2"),
    observe=observe,
    chart=chart,
    view=View(solid={"plate": 1.0}, at=pour_end, notes=notes),
    curves=(
        Curve(
            name="flank",
            unit="-",
            meaning="height of the flank over half the base, mean of both sides and of the pour",
            x_name="distance from the middle over half the base",
            x_unit="-",
            levels=LEVELS,
            file=FLANK,
            x_column="distance",
            y_column="height",
            high=10.0,
        ),
    ),
)
