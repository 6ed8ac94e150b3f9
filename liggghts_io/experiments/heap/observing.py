"""What is measured on a heap: angle of repose and flank, while a slice grows or of a cone at rest.

Both shapes go through the routine that measures photographs (`measure.silhouette`).
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Final

import numpy as np

from liggghts_io.errors import CaseError
from liggghts_io.experiments.setup import Observed, Setup
from liggghts_io.measure.dumps import FloatArray, Frame, all_frames, read_frame
from liggghts_io.measure.flanks import FlankFit, Repose
from liggghts_io.measure.silhouette import angle_of_repose, draw_silhouette

_PIXELS_PER_DIAMETER: Final = 16.0
FLANK: Final = "flank.csv"
VIEWS: Final = "views.csv"
LEVELS: Final = tuple(k / 10 for k in range(1, 10))
"""Distances from the middle at which the flank is compared, as parts of half the base."""

_GRAVITY: Final = 9.81
_PRINTED: Final = 1e-4  # relative accuracy of an energy from the six digits of a dump


def has_walls(setup: Setup) -> bool:
    """Whether the heap is a slice between side walls; a free cone otherwise."""
    return bool(setup.apparatus["side_walls"])


def measure(frame: Frame, setup: Setup, azimuth_deg: float = 0.0) -> Repose:
    """Measure the heap of one frame on its silhouette; grains in the air are left out.

    Parameters
    ----------
    frame : Frame
    setup : Setup
    azimuth_deg : float
        By how much the camera is turned about the vertical from its place in front of the xz
        plane, counterclockwise from above [deg].

    Raises
    ------
    CaseError
        If there is no heap.
    """
    c, a, d = frame.columns, setup.apparatus, setup.particle.d32_m
    # Falling grains are faster than any in the heap: a free fall over one diameter.
    resting = frame.speeds < np.sqrt(2.0 * _GRAVITY * d)
    turn = math.radians(azimuth_deg)
    across = c["x"] * math.cos(turn) + c["y"] * math.sin(turn)
    shadow = draw_silhouette(
        across[resting], c["z"][resting], c["radius"][resting], d / _PIXELS_PER_DIAMETER
    )
    fit = FlankFit(a["flank_low"], a["flank_high"])
    repose = angle_of_repose(shadow.image, shadow.metres_per_pixel, dark_heap=True, fit=fit)
    return repose.shifted(shadow.left_m)


def pour_end(setup: Setup) -> float:
    """Return the part of a slice's run after which nothing is poured any more."""
    a = setup.apparatus
    return a["pour_tau"] / (a["pour_tau"] + a["settle_tau"])


def wanted_frames(setup: Setup) -> list[int]:
    """Return the numbers of the frames over which the angle of a slice is averaged."""
    a, pour = setup.apparatus, pour_end(setup)
    total = int(a["frames"])
    return [k for k in range(total + 1) if a["measured_from"] * pour <= k / total <= pour]


def measured_frames(folder: Path, setup: Setup) -> list[Frame]:
    """Return the frames over which the angle is averaged.

    Of a slice those of the later part of the pour: a single picture scatters by some two degrees,
    because the slope builds up and slides down again and again; the mean over the growing heap
    does not. Of a cone the last one, of the heap at rest.

    Raises
    ------
    CaseError
        If no frame falls into that part, or the cone moves still; DamagedFile if the run is not
        whole.
    """
    if not has_walls(setup):
        last = read_frame(all_frames(folder)[-1])
        _check_rest(last, setup)
        return [last]
    wanted = wanted_frames(setup)
    if not wanted:
        total = setup.apparatus["frames"]
        msg = f"frames = {total:g}: none falls into the measured part of the pour; ask for more"
        raise CaseError(msg)
    paths = all_frames(folder)
    return [read_frame(paths[k]) for k in wanted]


def motion(frame: Frame, setup: Setup) -> float:
    """Return the mean kinetic energy of a grain over m g d; 0 where there is none."""
    mass = frame.columns["radius"] ** 3
    if not frame.count:
        return 0.0
    mean = 0.5 * float(np.sum(mass * frame.speeds**2) / np.sum(mass))
    return mean / (_GRAVITY * setup.particle.d32_m)


def _check_rest(frame: Frame, setup: Setup) -> None:
    a, found = setup.apparatus, motion(frame, setup)
    if found > a["rest_energy"] * (1.0 + _PRINTED):
        msg = (
            f"the heap moves still {a['rest_limit_tau']:g} falls over a diameter after the pour: "
            f"mean kinetic energy {found:.2g} m g d (at rest below {a['rest_energy']:g}); raise "
            "rest_limit_tau, or the grains roll on and on"
        )
        raise CaseError(msg)


def azimuths(setup: Setup) -> list[float]:
    """Return the directions [deg] from which a heap is seen; half a turn shows every flank."""
    count = 1 if has_walls(setup) else int(setup.apparatus["views"])
    return [180.0 * k / count for k in range(count)]


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


def mean_of_flanks(views: list[Repose]) -> tuple[float, float]:
    """Return the mean angle of all flanks and its standard error, as if each were independent.

    Returns
    -------
    (float, float)
        [deg]; the error is NaN for a single flank.
    """
    angles = np.array([side for one in views for side in (one.left_deg, one.right_deg)])
    error = angles.std(ddof=1) / np.sqrt(len(angles)) if len(angles) > 1 else np.nan
    return float(angles.mean()), float(error)


def observe(folder: Path, setup: Setup) -> Observed:
    """Average angle of repose and flank: of a slice over the later pour, of a cone all round."""
    turns = azimuths(setup)
    frames = measured_frames(folder, setup)
    heaps = [measure(frame, setup, turn) for frame in frames for turn in turns]
    profile = np.mean([flank(one) for one in heaps], axis=0)
    tables = {FLANK: {"distance": np.array(LEVELS), "height": profile}}
    if not has_walls(setup):
        tables[VIEWS] = {
            "azimuth_deg": np.array(turns),
            "left_deg": np.array([one.left_deg for one in heaps]),
            "right_deg": np.array([one.right_deg for one in heaps]),
        }
    return Observed({"angle_deg": float(np.mean([one.angle_deg for one in heaps]))}, tables)
