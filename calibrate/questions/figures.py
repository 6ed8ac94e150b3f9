"""Corner plot of a posterior, to be read by a colleague who has never seen one.

On the diagonal each unknown with its prior (dashed), its 90 % interval (shaded) and its value, and
beside it the same in numbers; below it the regions that hold 68 and 90 % of the probability of
every pair. Each axis shows where the probability lies; the words say within which range it was
looked for. What the data do not determine is grey, says so, and has no value.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator
from scipy.ndimage import gaussian_filter, gaussian_filter1d

from calibrate.arrays import Array
from calibrate.inference.posterior import Posterior
from calibrate.inference.priors import Prior, from_unit, to_unit
from calibrate.shown_figure import shown_figure

__all__ = ["corner_figure"]

INK: Final = "#7a7f87"
SURE: Final = "#2a7fb8"
UNSURE: Final = "#b4b8be"
VALUE: Final = "#d1495b"
SYMBOLS: Final = {
    "mu_pp": r"$\mu_\mathrm{pp}$",
    "mu_roll_pp": r"$\mu_\mathrm{R,pp}$",
    "mu_pw": r"$\mu_\mathrm{pw}$",
    "mu_roll_pw": r"$\mu_\mathrm{R,pw}$",
    "e_pp": r"$e_\mathrm{pp}$",
    "e_pw": r"$e_\mathrm{pw}$",
}
SHOWN: Final = (0.001, 0.999)
MARGIN: Final = 0.15
"""Quantiles that are shown, and the room beside them as a part of their distance."""
BINS: Final = 48
SMOOTH: Final = 1.6
"""Bins over which a histogram is smoothed."""
MOST: Final = 12
"""Unknowns in one picture; with more of them nothing can be read."""
LEVEL: Final = 0.9
PRIOR_DRAWS: Final = 200_000
TICKS: Final = 4
DECADE: Final = 5.0
"""About so many ticks; of logarithmic spacing where the ends of an axis are so far apart."""
PANEL: Final = (1.75, 1.5)
RIM: Final = 0.6
"""Width and height of a panel, and room for labels at the rim [inch]."""
LEGEND: Final = (
    "diagonal: how probable each value is\n"
    "    blue: after the data, shaded within the 90 % interval\n"
    "    dashed: before the data\n"
    "    red: the value\n"
    "below: where each pair lies,\n"
    "    dark with 68 %, pale with 90 % probability"
)
ROOM: Final = 4
"""Unknowns from which the corner has room for these words."""


@dataclass(frozen=True)
class _Axis:
    """One unknown as it is drawn.

    Attributes
    ----------
    name, symbol : str
    values, prior : (n,) float64
        Draws on the unit range of the unknown.
    span : (float, float)
        What is shown of the unit range.
    spec : Prior
        Range and spacing.
    interval : (float, float)
        On the unit range.
    ends : (str, str)
        Marks before its ends where they are those of the range.
    best : float
        On the unit range; nan where nothing is known.
    """

    name: str
    symbol: str
    values: Array
    prior: Array
    span: tuple[float, float]
    spec: Prior
    interval: tuple[float, float]
    ends: tuple[str, str]
    best: float

    @property
    def grey(self) -> bool:
        """Whether the data do not determine it."""
        return math.isnan(self.best)

    def number(self, unit: float) -> float:
        """Return the value at a place of the unit range."""
        return float(from_unit(np.array(unit), self.spec.low, self.spec.high, self.spec.spacing))

    @property
    def words(self) -> str:
        """Symbol, what is known, and the range."""
        low, high = (self.number(end) for end in self.interval)
        value = "" if self.grey else f" = {self.number(self.best):.3g}"
        below, above = self.ends
        known = "not determined" if self.grey else f"90 %: {below}{low:.3g} to {above}{high:.3g}"
        return f"{self.symbol}{value}\n{known}\nrange {self.spec.low:g} to {self.spec.high:g}"


def corner_figure(
    posterior: Posterior, best: Mapping[str, float], undetermined: Collection[str] = ()
) -> Figure:
    """Return the corner plot.

    Parameters
    ----------
    posterior : Posterior
    best : mapping
        Value of each unknown that is marked.
    undetermined : collection of str
        Unknowns that are drawn in grey, without a value.

    Returns
    -------
    Figure
        Of the first twelve unknowns, where there are more.
    """
    axes = _axes_of(posterior, best, undetermined)
    size = len(axes)
    width, height = PANEL[0] * (size + 1) + RIM, PANEL[1] * size + RIM
    figure = shown_figure(width, height)
    grid = figure.subplots(size, size + 1, squeeze=False)  # the last column is room for words
    for row, vertical in enumerate(axes):
        for beyond in grid[row, row + 1 :]:
            beyond.remove()
        for column, horizontal in enumerate(axes[: row + 1]):
            panel = grid[row, column]
            if row == column:
                _marginal(panel, vertical)
            else:
                _pair(panel, horizontal, vertical)
            _frame(panel, horizontal, None if row == column else vertical, last=row == size - 1)
            if column == 0 < row:
                panel.set_ylabel(vertical.symbol, fontsize=11, color=INK)
            elif row != column:
                panel.set_yticklabels([])
    if size >= ROOM:
        figure.text(0.99, 0.98, LEGEND, ha="right", va="top", fontsize=10, color=INK,
                    linespacing=1.5, multialignment="left")  # fmt: skip
    return figure


def _axes_of(
    posterior: Posterior, best: Mapping[str, float], undetermined: Collection[str]
) -> list[_Axis]:
    space = posterior.space
    count = len(space.unknowns)
    units = np.clip(space.units(posterior.samples), 0.0, 1.0)
    prior = space.units(space.draw(PRIOR_DRAWS, np.random.default_rng(0)))
    marked = space.units(np.array([[best[name] for name in space.names]]))[0]
    found = []
    for k in [k for k in space.asked if k < count][:MOST]:
        name, one = space.names[k], space.unknowns[k]
        low, high = np.quantile(units[:, k], SHOWN)
        margin = MARGIN * (high - low)
        symbol = SYMBOLS.get(one.name, one.name)
        interval = posterior.interval(name, LEVEL)
        ends = to_unit(
            np.array([interval.low, interval.high]),
            one.prior.low,
            one.prior.high,
            one.prior.spacing,
        )
        found.append(
            _Axis(
                name,
                f"{symbol} {one.instance}" if one.instance else symbol,
                units[:, k],
                prior[:, k],
                (max(float(low - margin), 0.0), min(float(high + margin), 1.0)),
                one.prior,
                (float(ends[0]), float(ends[1])),
                ("≤ " if interval.open_low else "", "≥ " if interval.open_high else ""),
                math.nan if name in undetermined else float(marked[k]),
            )
        )
    return found


def _density(values: Array, span: tuple[float, float]) -> tuple[Array, Array]:
    """Return a smoothed histogram: middles and heights, per unit of the whole range."""
    counts, edges = np.histogram(values, BINS, span)
    heights = gaussian_filter1d(counts / (len(values) * np.diff(edges)), SMOOTH, mode="nearest")
    return 0.5 * (edges[1:] + edges[:-1]), heights


def _marginal(panel: Axes, one: _Axis) -> None:
    """Draw one unknown: prior, posterior, interval and value."""
    colour = UNSURE if one.grey else SURE
    x, height = _density(one.values, one.span)
    panel.plot(*_density(one.prior, one.span), color=INK, linewidth=0.9, linestyle="--")
    panel.plot(x, height, color=colour, linewidth=1.5)
    inside = (x >= one.interval[0]) & (x <= one.interval[1])
    panel.fill_between(x[inside], height[inside], color=colour, alpha=0.3, linewidth=0.0)
    if not one.grey:
        panel.axvline(one.best, color=VALUE, linewidth=1.0)
    panel.set_ylim(0.0, None)
    words = panel.text(1.06, 0.5, one.words, transform=panel.transAxes, va="center", fontsize=9,
                       linespacing=1.4, color=INK)  # fmt: skip
    words.set_in_layout(False)  # they stand where no panel is


def _pair(panel: Axes, x: _Axis, y: _Axis) -> None:
    """Draw the regions that hold 68 and 90 % of the probability of a pair, and the values."""
    counts, columns, rows = np.histogram2d(x.values, y.values, BINS, (x.span, y.span))
    smooth = gaussian_filter(counts, SMOOTH, mode="nearest").T
    ordered = np.sort(smooth.ravel())[::-1]
    share = np.cumsum(ordered) / ordered.sum()
    outer, inner = (float(ordered[np.searchsorted(share, level)]) for level in (LEVEL, 0.68))
    colour = UNSURE if x.grey or y.grey else SURE
    if outer < inner < smooth.max():
        panel.contourf(
            0.5 * (columns[1:] + columns[:-1]),
            0.5 * (rows[1:] + rows[:-1]),
            smooth,
            [outer, inner, float(smooth.max())],
            colors=[colour + "66", colour],
        )
    if not (x.grey or y.grey):
        panel.plot([x.best], [y.best], "+", color=VALUE, markersize=7)


def _frame(panel: Axes, x: _Axis, y: _Axis | None, *, last: bool) -> None:
    """Set limits, ticks in the unknowns' own units, and labels at the rim."""
    panel.set_xlim(*x.span)
    panel.set_xticks(*_ticks(x))
    panel.tick_params(colors=INK, labelsize=8)
    for spine in panel.spines.values():
        spine.set_color(INK)
    if y is None:
        panel.set_yticks([])
    else:
        panel.set_ylim(*y.span)
        panel.set_yticks(*_ticks(y))
    if last:
        panel.set_xlabel(x.symbol, fontsize=11, color=INK)
    else:
        panel.set_xticklabels([])


def _ticks(one: _Axis) -> tuple[Array, list[str]]:
    """Return round numbers inside what is shown, in the unknown's unit."""
    low, high = (one.number(end) for end in one.span)
    far = one.spec.spacing == "log" and high > DECADE * low
    locator = LogLocator(subs=(1.0, 2.0, 5.0)) if far else MaxNLocator(TICKS, steps=[1, 2, 5, 10])
    values = [value for value in locator.tick_values(low, high) if low <= value <= high]
    at = to_unit(np.array(values), one.spec.low, one.spec.high, one.spec.spacing)
    return at, [f"{value:.3g}" for value in values]
