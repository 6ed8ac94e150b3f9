"""What in a log of a scale cannot be right, or is odd: units, the zero of the time, the mass."""

from __future__ import annotations

from typing import Final

import numpy as np

from calibrate.errors import CalibrationError
from calibrate.laboratory.scale.curve import MassCurve

__all__ = ["doubts_about", "refuse_early_onset"]

_SIGMAS: Final = 3.0
_FLOWS_G_S: Final = (0.1, 1000.0)
"""Flows of funnels on a bench lie well between these."""
_LITTLE: Final = 0.01
"""Part of the mass in the end that is no more than the first grains."""
_MORE: Final = 1.25
"""Times the mass that an experiment pours, beyond which it is another mass or another unit."""


def refuse_early_onset(curve: MassCurve) -> None:
    """Refuse a log in which grains arrive before the funnel is open.

    Raises
    ------
    CalibrationError
        With when they arrive.
    """
    apart = float(np.median(np.diff(curve.time_s)))
    early = -curve.onset_s.value - max(_SIGMAS * curve.onset_s.se, 2.0 * apart)
    if early > 0.0:
        msg = (
            f"{curve.path}: grains flow onto the scale {-curve.onset_s.value:.3g} s before the "
            "funnel was opened; say with --start when that was, as the clock of the log shows"
        )
        raise CalibrationError(msg)


def doubts_about(curve: MassCurve, mass_g: float | None, poured_g: float | None) -> list[str]:
    """Say what is odd in a log.

    Parameters
    ----------
    curve : MassCurve
    mass_g : float, optional
        Mass whose time is asked for [g], if one is.
    poured_g : float, optional
        What the experiment pours where a study does not say otherwise [g], if it does.
    """
    flow, most = curve.slope_g_s.value, float(curve.rising_g[-1])
    low, high = _FLOWS_G_S
    found = []
    if not low <= flow <= high:
        found.append(
            f"a flow of {flow:.3g} g/s is none of a funnel on a bench; check the units of time and "
            "mass in its head"
        )
    if mass_g is not None and mass_g < _LITTLE * most:
        found.append(
            f"{mass_g:g} g are {100.0 * mass_g / most:.2g} % of the {most:.4g} g in the end, no "
            "more than the first grains; check --mass and the unit in its head"
        )
    if poured_g is not None and most > _MORE * poured_g:
        found.append(
            f"{most:.4g} g lie on the scale in the end, and the experiment pours {poured_g:.4g} g "
            "where a study does not say poured_mass_kg; say it there, or check the unit in its head"
        )
    return found
