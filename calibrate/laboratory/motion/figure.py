"""The motion of a plate as in Fig. B.9 of the paper: measured, fitted, and what remains."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from calibrate.arrays import Array
from calibrate.laboratory.instrument.quantities import POSITION
from calibrate.laboratory.motion.profile import PlateMotion
from calibrate.laboratory.plotting import COLOURS, GREY, INK, new_panels

__all__ = ["motion_figure"]

_MOST_DOTS: Final = 3000
_PERIODS: Final = 2.0
"""Periods that are drawn, all readings laid onto them."""
_POINTS: Final = 600
_MM_PER_M: Final = 1e3


def motion_figure(motion: PlateMotion) -> Figure:
    """Draw position and acceleration over two periods, and the remaining error over the record."""
    figure, (way, force, left) = new_panels(7.2, 7.6, (1.0, 1.0, 0.6))
    clock = np.linspace(0.0, _PERIODS * motion.period_s, _POINTS)
    is_way = motion.quantity.name == POSITION.name
    _panel(way, clock, _MM_PER_M * motion.position(clock), from_fit=not is_way)
    _panel(force, clock, motion.acceleration(clock), from_fit=is_way)
    some = slice(None, None, max(1, len(motion.time_s) // _MOST_DOTS))
    folded = (motion.time_s[some] - motion.start_s) % motion.period_s
    seen = (motion.measured - motion.fit.slow(motion.time_s))[some]
    by = _MM_PER_M if is_way else 1.0
    _dots(way if is_way else force, folded, motion.period_s, by * seen)
    unit = "mm" if is_way else "m/s²"
    left.plot(motion.time_s[some], by * motion.fit.residual[some], ".", ms=3, color=COLOURS[0],
              mew=0)  # fmt: skip
    left.axhline(0.0, color=INK, lw=0.8)
    way.set_ylabel("position (mm)")
    force.set(xlabel="time in the motion (s), all periods laid onto each other",
              ylabel="acceleration (m/s²)")  # fmt: skip
    left.set(xlabel="time of the record (s)", ylabel=f"measured less\nfit ({unit})")
    left.set_title(
        f"remaining error {by * motion.fit.rms:.3g} {unit} (rms), {100 * motion.share:.2g} % of "
        "the motion",
        loc="left", fontsize=9.5, color=INK,
    )  # fmt: skip
    count = "1 cosine" if motion.harmonics == 1 else f"{motion.harmonics} cosines"
    way.set_title(
        f"{motion.path.name}: {count}, period {1e3 * motion.period_s:.5g} ms",
        loc="left", fontsize=11, color=INK,
    )  # fmt: skip
    for axis in (way, force):
        axis.set_xlim(0.0, _PERIODS * motion.period_s)
        axis.margins(y=0.12)
        axis.legend(loc="lower right", bbox_to_anchor=(1.0, 0.99), ncols=2, fontsize=8.5,
                    frameon=False, borderpad=0.0)  # fmt: skip
    return figure


def _panel(axis: Any, clock: Array, values: Array, *, from_fit: bool) -> None:
    label = "follows from the fit" if from_fit else "sum of cosines"
    axis.axhline(0.0, color=GREY, lw=0.6)
    axis.plot(clock, values, color=COLOURS[1], lw=1.7, zorder=5, label=label,
              ls="--" if from_fit else "-")  # fmt: skip


def _dots(axis: Any, folded: Array, period: float, values: Array) -> None:
    for shift in np.arange(_PERIODS):
        axis.plot(folded + shift * period, values, ".", ms=4, mew=0, color=COLOURS[0], alpha=0.6,
                  label=None if shift else "measured (drift taken off)")  # fmt: skip
