"""A fitted motion as lines of a study and of a LIGGGHTS script."""

from __future__ import annotations

from typing import Final

import numpy as np

from calibrate.laboratory.motion.profile import PlateMotion
from calibrate.laboratory.targets import experiment_lines
from liggghts_io.errors import CaseError
from liggghts_io.experiments import EXPERIMENTS
from liggghts_io.experiments.plate_motion import HARMONICS, MOTION_PARAMETERS
from liggghts_io.scripts.filters import number

__all__ = ["apparatus_of", "script_line", "study_lines"]

_DIGITS: Final = 6
_CONVEYOR: Final = "conveyor"
_LEAST_PART: Final = 1e-6
"""Of the first amplitude; a phase of less is no number."""


def apparatus_of(motion: PlateMotion) -> dict[str, float]:
    """Return the motion as apparatus parameters of the conveyor, as far as it has harmonics."""
    first = float(motion.amplitudes_m[0])
    found = {"amplitude_m": _rounded(first), "period_s": _rounded(motion.period_s)}
    for order in range(2, HARMONICS + 1):
        ratio = 0.0
        if order <= motion.harmonics:
            ratio = float(motion.amplitudes_m[order - 1]) / first
        found[f"harmonic_{order}"] = _rounded(ratio)
        if ratio > _LEAST_PART:
            degrees = float(np.degrees(motion.phases_rad[order - 1]))
            found[f"phase_{order}_deg"] = _rounded(degrees)
    usual = EXPERIMENTS[_CONVEYOR].apparatus("quick", {})
    needed = ("amplitude_m", "period_s")
    return {key: value for key, value in found.items() if value != usual[key] or key in needed}


def _rounded(value: float) -> float:
    return float(f"{value:.{_DIGITS}g}")


def study_lines(motion: PlateMotion) -> str:
    """Return the lines of a study, or a comment that says why it cannot have the motion."""
    apparatus = apparatus_of(motion)
    known = {one.name: one for one in MOTION_PARAMETERS}
    try:
        for name, value in apparatus.items():
            known[name].check(value)
    except CaseError as err:
        return f"# The conveyor of a study cannot move so: {err}."
    lines = experiment_lines(_CONVEYOR, apparatus)
    if motion.harmonics > HARMONICS:
        return f"# The first {HARMONICS} of {motion.harmonics} harmonics.\n{lines}"
    return lines


def script_line(motion: PlateMotion) -> str:
    """Return the command that moves a mesh named plate along x in a LIGGGHTS script."""
    orders = np.arange(1, motion.harmonics + 1)
    words = {
        "amplitude": motion.amplitudes_m,
        "phase": motion.phases_rad,
        "period": motion.period_s / orders,
    }
    waves = " ".join(
        f"{word} {' '.join(number(float(one)) for one in values)}" for word, values in words.items()
    )
    head = "fix drive all move/mesh mesh plate viblin axis 1 0 0"
    return f"{head} order {motion.harmonics} {waves}"
