"""Figures of a sensitivity study: curves of one parameter at a time, bars of Sobol indices."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from calibrate.questions.figures import SYMBOLS
from calibrate.questions.sensitivity.baseline import ELASTIC
from calibrate.questions.sensitivity.responses import Response
from calibrate.questions.sensitivity.shares import Share
from calibrate.shown_figure import shown_figure

__all__ = ["indices_figure", "responses_figure"]

INK: Final = "#7a7f87"
MEASURED: Final = "#d1495b"
SEEN: Final = "#2a7fb8"
UNSEEN: Final = "#b4b8be"
PANEL: Final = (1.7, 1.5)
RIM: Final = 0.9
"""Width and height of a panel, and room at the rim [inch]."""
SHORT: Final = {
    "youngs_modulus_pa": "$Y$ [Pa]",
    "poisson_ratio": r"$\nu$",
    **SYMBOLS,
}


def responses_figure(responses: Sequence[Response]) -> Figure:
    """Return curves: a row per output with one vertical scale, a column per parameter.

    Parameters
    ----------
    responses : sequence of Response
        At least one.
    """
    rows = list(dict.fromkeys((one.where, one.name, one.unit) for one in responses))
    columns = sorted(dict.fromkeys(one.parameter for one in responses), key=ELASTIC.__contains__)
    figure = shown_figure(PANEL[0] * len(columns) + RIM, PANEL[1] * len(rows) + RIM)
    axes = figure.subplots(len(rows), len(columns), squeeze=False, sharey="row")
    for axis in axes.ravel():
        axis.set_visible(False)
    for one in responses:
        row = rows.index((one.where, one.name, one.unit))
        _curve(axes[row, columns.index(one.parameter)], one)
    for row, (where, name, unit) in enumerate(rows):
        first = next(axis for axis in axes[row] if axis.get_visible())
        first.set_ylabel(f"{_wrapped(where)}\n{name} [{unit}]", fontsize=7, color=INK)
        first.tick_params(labelleft=True)
    figure.supxlabel(
        "points: single runs; line: their mean; shaded: from the lowest to the highest seed; "
        "grey line: not more than luck;\ndotted: baseline; red: measured",
        fontsize=8, color=INK,
    )  # fmt: skip
    return figure


def _wrapped(where: str) -> str:
    return where.replace(" of ", "\nof ", 1)


def _styled(axis: Axes) -> None:
    axis.set_visible(True)
    axis.tick_params(colors=INK, labelsize=7)
    for spine in axis.spines.values():
        spine.set_color(INK)


def _curve(axis: Axes, one: Response) -> None:
    """Draw what one parameter does to one output."""
    _styled(axis)
    colour = UNSEEN if one.direction == "not seen" else SEEN
    good = np.isfinite(one.y).any(axis=1)
    x, y = one.x[good], one.y[good]
    if len(x):
        axis.fill_between(
            x, np.nanmin(y, axis=1), np.nanmax(y, axis=1), color=colour, alpha=0.25, linewidth=0
        )
    axis.plot(x, one.means[good], color=colour, linewidth=1.4)
    axis.plot(one.x, one.y, ".", color=colour, markersize=2.5)
    axis.axvline(one.baseline, color=INK, linewidth=0.8, linestyle=":")
    value, error = one.measured
    if np.isfinite(value):
        axis.axhline(value, color=MEASURED, linewidth=0.9)
        axis.axhspan(value - error, value + error, color=MEASURED, alpha=0.2, linewidth=0)
    if one.logarithmic:
        axis.set_xscale("log")
        ends = [float(one.x[0]), float(one.x[-1])]
        axis.set_xticks(ends, [f"{end:.0e}".replace("+0", "") for end in ends])
        axis.xaxis.set_minor_locator(NullLocator())
    axis.set_xlabel(SHORT.get(one.parameter, one.parameter), fontsize=10, color=INK, labelpad=1)


def indices_figure(shares: Sequence[Share]) -> Figure:
    """Return bars of the indices: a panel per output, first-order dark, total light.

    Parameters
    ----------
    shares : sequence of Share
        At least one.
    """
    rows = list(dict.fromkeys((one.where, one.name) for one in shares))
    columns = list(dict.fromkeys(one.parameter for one in shares))
    width = max(0.55 * len(columns) + RIM, 3.0)
    across = min(len(rows), 3)
    down = -(-len(rows) // across)
    figure = shown_figure(width * across, 2.1 * down + 0.6)
    axes = figure.subplots(down, across, squeeze=False, sharey=True).ravel()
    for axis in axes[len(rows) :]:
        axis.set_visible(False)
    for axis, (where, name) in zip(axes, rows, strict=False):
        _bars(axis, [one for one in shares if (one.where, one.name) == (where, name)])
        axis.set_title(f"{name}\n{where}", fontsize=9, color=INK)
    figure.supxlabel(
        "dark: by itself (first order); pale: with all it does together with others (total); "
        "bars of error: 90 %;\ngrey: no more than what the emulator's error makes (dashed)",
        fontsize=9, color=INK,
    )  # fmt: skip
    return figure


def _bars(axis: Axes, shares: Sequence[Share]) -> None:
    """Draw the indices of one output."""
    _styled(axis)
    for k, one in enumerate(shares):
        colour = SEEN if one.seen else UNSEEN
        for shift, value, span, alpha in (
            (-0.18, one.first, one.first_span, 1.0),
            (0.18, one.total, one.total_span, 0.45),
        ):
            axis.bar(k + shift, value, width=0.34, color=colour, alpha=alpha)
            bar = np.array([[max(value - span[0], 0.0)], [max(span[1] - value, 0.0)]])
            axis.errorbar(k + shift, value, yerr=bar, color=INK, linewidth=0.8, capsize=1.5)
        axis.hlines(one.made, k - 0.4, k + 0.4, color=INK, linestyle="--", linewidth=0.7)
    axis.set_ylim(0.0, 1.05)
    axis.set_xticks(range(len(shares)), [SHORT.get(s.parameter, s.parameter) for s in shares])
    axis.tick_params(axis="x", labelsize=10)
