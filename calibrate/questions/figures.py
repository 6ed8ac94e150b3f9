"""Corner plot of a posterior, to be read by a colleague who has never seen one.

On the diagonal each unknown with its prior (thin line), its 90 % interval (shaded) and its value;
below it the regions that hold 68 and 90 % of the probability of every pair. What the data do not
determine is grey and says so.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from scipy.ndimage import gaussian_filter, gaussian_filter1d

from calibrate.arrays import Array
from calibrate.inference.posterior import Posterior
from calibrate.inference.priors import from_unit

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
BINS: Final = 60
SMOOTH: Final = 1.6
"""Bins over which a histogram is smoothed."""
MOST: Final = 12
"""Unknowns in one picture; with more of them nothing can be read."""
LEVEL: Final = 0.9
PRIOR_DRAWS: Final = 20_000


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
        Unknowns that are drawn in grey.

    Returns
    -------
    Figure
        Of the first twelve unknowns, where there are more.
    """
    count = len(posterior.space.unknowns)
    columns = [k for k in posterior.space.asked if k < count][:MOST]
    size = len(columns)
    figure = Figure(figsize=(1.9 * size + 1.2, 1.9 * size + 1.0), dpi=110, layout="constrained")
    FigureCanvasAgg(figure)
    figure.patch.set_alpha(0.0)
    grid = figure.subplots(size, size, squeeze=False)
    units = np.clip(posterior.space.units(posterior.samples), 0.0, 1.0)
    prior = posterior.space.units(posterior.space.draw(PRIOR_DRAWS, np.random.default_rng(0)))
    for row, k in enumerate(columns):
        for column, other in enumerate(columns):
            axes = grid[row, column]
            if column > row:
                axes.set_axis_off()
                continue
            grey = posterior.names[k] in undetermined or posterior.names[other] in undetermined
            if row == column:
                _marginal(axes, posterior, k, units[:, k], prior[:, k], grey=grey)
            else:
                _pair(axes, units[:, other], units[:, k], grey=grey)
            _mark(axes, posterior, best, other, k if row != column else None)
            _frame(axes, posterior, k, other, last=row == size - 1, first=column == 0 < row)
    return figure


def _density(values: Array) -> tuple[Array, Array]:
    """Return a smoothed histogram on the unit range: middles and heights."""
    counts, edges = np.histogram(values, BINS, (0.0, 1.0), density=True)
    return 0.5 * (edges[1:] + edges[:-1]), gaussian_filter1d(counts, SMOOTH, mode="nearest")


def _marginal(
    axes: Axes, posterior: Posterior, k: int, values: Array, prior: Array, *, grey: bool
) -> None:
    """Draw one unknown: prior, posterior, interval, and its value in words."""
    name = posterior.names[k]
    colour = UNSURE if grey else SURE
    x, height = _density(values)
    axes.plot(*_density(prior), color=INK, linewidth=0.8, linestyle="--")
    axes.plot(x, height, color=colour, linewidth=1.4)
    span = posterior.interval(name, LEVEL)
    low, high = _unit(posterior, k, np.array([span.low, span.high]))
    inside = (x >= low) & (x <= high)
    axes.fill_between(x[inside], height[inside], color=colour, alpha=0.3, linewidth=0.0)
    axes.set_ylim(0.0, None)
    words = "not determined" if grey else f"{span.low:.3g} to {span.high:.3g}"
    axes.set_title(f"{_symbol(posterior, k)}\n{words}", fontsize=8, color=INK)


def _pair(axes: Axes, x: Array, y: Array, *, grey: bool) -> None:
    """Draw the regions that hold 68 and 90 % of the probability of a pair."""
    counts, _, _ = np.histogram2d(x, y, BINS, ((0.0, 1.0), (0.0, 1.0)))
    smooth = gaussian_filter(counts, SMOOTH, mode="nearest").T
    ordered = np.sort(smooth.ravel())[::-1]
    share = np.cumsum(ordered) / ordered.sum()
    levels = [float(ordered[np.searchsorted(share, level)]) for level in (LEVEL, 0.68)]
    middle = (np.arange(BINS) + 0.5) / BINS
    colour = UNSURE if grey else SURE
    if levels[0] < levels[1] < smooth.max():
        ends = [*levels, float(smooth.max())]
        axes.contourf(middle, middle, smooth, ends, colors=[colour + "66", colour])


def _unit(posterior: Posterior, k: int, values: Array) -> Array:
    every = np.tile(posterior.samples[:1], (len(values), 1))
    every[:, k] = values
    return np.asarray(posterior.space.units(every)[:, k])


def _mark(
    axes: Axes, posterior: Posterior, best: Mapping[str, float], x: int, y: int | None
) -> None:
    """Mark the value."""
    at = float(_unit(posterior, x, np.array([best[posterior.names[x]]]))[0])
    if y is None:
        axes.axvline(at, color=VALUE, linewidth=1.0)
        return
    height = float(_unit(posterior, y, np.array([best[posterior.names[y]]]))[0])
    axes.plot([at], [height], "+", color=VALUE, markersize=7)


def _frame(
    axes: Axes, posterior: Posterior, k: int, other: int, *, last: bool, first: bool
) -> None:
    """Set limits, ticks in the unknowns' own units, and labels at the rim."""
    axes.set_xlim(0.0, 1.0)
    _ticks(axes.xaxis, posterior, other, shown=last)
    axes.tick_params(colors=INK, labelsize=7)
    for spine in axes.spines.values():
        spine.set_color(INK)
    if k == other:
        axes.set_yticks([])
    else:
        axes.set_ylim(0.0, 1.0)
        _ticks(axes.yaxis, posterior, k, shown=first)
    if last:
        axes.set_xlabel(_symbol(posterior, other), fontsize=8, color=INK)
    if first:
        axes.set_ylabel(_symbol(posterior, k), fontsize=8, color=INK)


def _ticks(axis: Any, posterior: Posterior, k: int, *, shown: bool) -> None:
    prior = posterior.space.priors[k]
    units = np.array([0.0, 0.5, 1.0])
    values = from_unit(units, prior.low, prior.high, prior.spacing)
    axis.set_ticks(units, [f"{value:.2g}" if shown else "" for value in values])


def _symbol(posterior: Posterior, k: int) -> str:
    one = posterior.space.unknowns[k]
    symbol = SYMBOLS.get(one.name, one.name)
    return f"{symbol} {one.instance}" if one.instance else symbol
