"""How the conveyor's plate moves: a sum of cosines, as numbers of the apparatus.

    x(t) = sum over k of A r_k (cos(2 pi k t / T + phi_k) - cos phi_k)

along the way of the grains, with A = `amplitude_m` times `amplitude_factor`, T = `period_s` times
`period_factor`, r_k = `harmonic_k` (r_1 = 1) and phi_k = `phase_k_deg` (phi_1 = 90 degrees: that
only says when the clock is started). LIGGGHTS calls it ``fix move/mesh ... viblin``.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final

from liggghts_io.experiments.numbers import Parameter, same

__all__ = ["HARMONICS", "LARGEST_RATIO", "MOTION_PARAMETERS", "period_of", "plate_motion"]

HARMONICS: Final = 8
"""Cosines of the sum. More would be heard, not seen: at 12 Hz the eighth is a sound of 100 Hz."""
LARGEST_RATIO: Final = 10.0
_MOTION: Final = (
    "ours: Grobbel et al. 2019, section 2.5.2 says a sum of cosines (docs/apparatus.md)"
)
_DEFAULT_RATIOS: Final = {2: 0.25}
_FIRST_PHASE_DEG: Final = 90.0
_ORDINALS: Final = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth")


def _overtone(order: int) -> tuple[Parameter, Parameter]:
    """Return amplitude and phase of an overtone."""
    word = f"the {_ORDINALS[order - 1]} harmonic"
    return (
        same(
            f"harmonic_{order}",
            "-",
            f"amplitude of {word} as a part of the first",
            _DEFAULT_RATIOS.get(order, 0.0),
            (0.0, LARGEST_RATIO),
            source=_MOTION,
        ),
        same(
            f"phase_{order}_deg",
            "deg",
            f"phase of {word}, where the first begins with 90",
            _FIRST_PHASE_DEG,
            (-360.0, 360.0),
            source=_MOTION,
        ),
    )


MOTION_PARAMETERS: Final = (
    same(
        "amplitude_m",
        "m",
        "amplitude of the fundamental of the plate motion",
        0.002,
        (1e-6, 0.1),
        source=_MOTION,
    ),
    *(one for order in range(2, HARMONICS + 1) for one in _overtone(order)),
    same("period_s", "s", "period of the plate", 0.08, (1e-3, 10.0), source=_MOTION),
    same(
        "amplitude_factor",
        "-",
        "factor on all amplitudes of the motion",
        1.0,
        (0.01, 10.0),
        source="nuisance, one unless it is measured",
    ),
    same(
        "period_factor",
        "-",
        "factor on the period of the motion",
        1.0,
        (0.1, 10.0),
        source="nuisance, one unless measured; section 2.5.2: a little longer than the one set",
    ),
)


def plate_motion(apparatus: Mapping[str, float]) -> dict[str, list[float]]:
    """Return amplitudes [m], phases [rad] and periods [s] of the cosines that are not zero.

    Parameters
    ----------
    apparatus : Mapping[str, float]
        With the parameters above.
    """
    ratios, phases = {1: 1.0}, {1: _FIRST_PHASE_DEG}
    for order in range(2, HARMONICS + 1):
        ratios[order] = apparatus[f"harmonic_{order}"]
        phases[order] = apparatus[f"phase_{order}_deg"]
    used = [order for order, ratio in ratios.items() if ratio > 0.0]
    amplitude = apparatus["amplitude_m"] * apparatus["amplitude_factor"]
    return {
        "amplitudes": [amplitude * ratios[order] for order in used],
        "phases": [math.radians(phases[order]) for order in used],
        "periods": [period_of(apparatus) / order for order in used],
    }


def period_of(apparatus: Mapping[str, float]) -> float:
    """Return the period of the plate [s]."""
    return apparatus["period_s"] * apparatus["period_factor"]
