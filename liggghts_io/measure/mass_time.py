"""Mass on the scale over time, averaged over one plate period, and the time to reach a mass."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from liggghts_io.errors import CaseError

FloatArray = npt.NDArray[np.float64]
_POINTS: Final = 201
_LEAST_PART: Final = 0.3  # of the target mass must have arrived before a slope is trusted


@dataclass(frozen=True)
class MassTime:
    """Mass-time curve on an even grid.

    Attributes
    ----------
    time_s, mass_kg : (n,) float64
    """

    time_s: FloatArray
    mass_kg: FloatArray


def mass_time(times: FloatArray, masses: FloatArray, window: float) -> MassTime:
    """Sum masses that arrive at `times` and average the sum over a moving window.

    Parameters
    ----------
    times, masses : (n,) float64
        Arrival [s] and mass [kg] of each grain, in order of time.
    window : float
        Width of the average [s], one plate period, so that the stroke does not show.

    Returns
    -------
    MassTime
        From 0 to the last arrival minus half a window, where the average is complete.
    """
    if len(times) == 0 or window <= 0.0:
        msg = "a mass-time curve needs at least one arrival and a positive window"
        raise CaseError(msg)
    end = max(float(times[-1]) - 0.5 * window, 0.5 * window)
    grid = np.linspace(0.0, end, _POINTS)
    # The mean over a window of a step of height m at time s is m times the covered part of it.
    covered = np.clip((grid[:, None] + 0.5 * window - times[None, :]) / window, 0.0, 1.0)
    return MassTime(grid, covered @ masses)


def time_to_reach(curve: MassTime, target: float) -> float:
    """Time at which the curve reaches a mass; extrapolated when the run ended before it [s].

    The steady slope is that of the upper half of the recorded mass.

    Raises
    ------
    CaseError
        If less than 30 % of the target arrived, or the mass has stopped to rise.
    """
    time, mass = curve.time_s, curve.mass_kg
    if mass[-1] >= target:
        after = int(np.argmax(mass >= target))
        if after == 0:
            return float(time[0])
        return float(np.interp(target, mass[after - 1 : after + 1], time[after - 1 : after + 1]))
    if mass[-1] < _LEAST_PART * target:
        msg = (
            f"{mass[-1] * 1e3:.1f} g of {target * 1e3:g} g on the scale after {time[-1]:.1f} s: "
            "too little to extrapolate; simulate longer (duration_*_s)"
        )
        raise CaseError(msg)
    late = mass >= 0.5 * mass[-1]
    slope = float(np.polyfit(time[late], mass[late], 1)[0])
    if slope <= 0.0:
        msg = f"the mass on the scale stays at {mass[-1] * 1e3:.1f} g; the target is out of reach"
        raise CaseError(msg)
    return float(time[-1] + (target - mass[-1]) / slope)
