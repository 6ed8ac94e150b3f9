"""Mass-time curves as they were read, with onset, steady flow, plateau and the time of a mass."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from calibrate.laboratory.plotting import COLOURS, GREY, INK, new_panels
from calibrate.laboratory.scale.curve import MassCurve

__all__ = ["mass_figure"]

_MOST_DOTS: Final = 400
"""Readings of a log that are drawn; more hide each other."""
_LEGEND: Final = 5
"""Logs that are told one by one."""


def mass_figure(curves: Sequence[MassCurve], mass_g: float, title: str) -> Figure:
    """Draw the curves of several logs.

    Parameters
    ----------
    curves : sequence of MassCurve
    mass_g : float
        Mass whose time is marked, where a log reaches it.
    title : str
    """
    figure, (axis, below) = new_panels(7.2, 5.8, (3.0, 1.0))
    axis.axhline(0.0, color=GREY, lw=0.6)
    for k, curve in enumerate(curves):
        colour = COLOURS[k % len(COLOURS)]
        _log(axis, curve, colour, k < _LEGEND)
        _off_line(below, curve, colour)
    times = [curve.time_to(mass_g).value for curve in curves if curve.rising_g[-1] >= mass_g > 0.0]
    if times:
        axis.axhline(mass_g, color=INK, lw=0.8, ls=(0, (1, 2)))
        axis.plot(times, [mass_g] * len(times), "o", ms=5.5, mfc="white", mec=INK, mew=1.3,
                  zorder=6, label=f"{mass_g:g} g after {np.mean(times):.4g} s")  # fmt: skip
    if (others := len(curves) - _LEGEND) > 0:
        axis.plot([], [], " ", label=f"and {others} log{'s' if others > 1 else ''} more")
    axis.plot([], [], "--", color=INK, lw=1.2, label="steady flow from its onset")
    if any(curve.plateau_g for curve in curves):
        axis.plot([], [], ":", color=INK, lw=1.6, label="plateau")
    axis.set(ylabel="mass on the scale (g)")
    below.axhline(0.0, color=INK, ls="--", lw=1.0)
    below.set(xlabel="time since the funnel was opened (s)", ylabel="less the steady\nflow (g)")
    below.set_xlim(axis.get_xlim())
    axis.set_title(title, loc="left", fontsize=11, color=INK)
    axis.legend(loc="upper left", fontsize=8.5, frameon=False, markerscale=1.6)
    return figure


def _off_line(axis: Any, curve: MassCurve, colour: str) -> None:
    """Draw how far readings lie from the line of the steady flow, while it flows."""
    line = curve.slope_g_s.value * (curve.time_s - curve.onset_s.value)
    flows = (curve.rising_g > 0.02 * curve.rising_g[-1]) & (
        curve.rising_g < 0.98 * curve.rising_g[-1]
    )
    axis.plot(curve.time_s[flows], (curve.mass_g - line)[flows], ".-", ms=3.0, lw=0.7, color=colour)


def _log(axis: Any, curve: MassCurve, colour: str, told: bool) -> None:
    """Draw readings, line of the steady flow, onset and plateau of one log."""
    some = slice(None, None, max(1, len(curve.time_s) // _MOST_DOTS))
    axis.plot(curve.time_s[some], curve.mass_g[some], ".", ms=3.5, color=colour, alpha=0.55, mew=0,
              label=curve.path.stem if told else None)  # fmt: skip
    onset, slope = curve.onset_s.value, curve.slope_g_s.value
    top = curve.plateau_g.value if curve.plateau_g else float(curve.rising_g[-1])
    end = onset + top / slope
    axis.plot([onset, end], [0.0, top], "--", color=colour, lw=1.2)
    axis.plot(onset, 0.0, "^", ms=7, color=colour, mec="white", mew=0.8, zorder=5, clip_on=False)
    if curve.plateau_g:
        axis.plot([end, curve.time_s[-1]], [top, top], ":", color=colour, lw=1.8)
