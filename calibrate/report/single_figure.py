"""A stage that frees one parameter: every target over it, and where the probability lies."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from calibrate.inference.intervals import LEVELS
from calibrate.report.drawing import (
    INK,
    LINES,
    REGION,
    TARGET,
    axis_label,
    measured_title,
    new_figure,
    runs_of,
)
from calibrate.scales import backward
from calibrate.staged.posterior.grid import GridPosterior
from calibrate.staged.result import StageResult, TargetFit

__all__ = ["single_figure"]

POINTS: Final = 201
MOST: Final = 3  # panels in a row


def single_figure(result: StageResult) -> Figure:
    """Return the curve of every target with its measured band and, last, the probability.

    Parameters
    ----------
    result : StageResult
        Of a stage that frees one parameter.
    """
    count = len(result.fits) + 1
    columns = min(count, MOST)
    rows = -(-count // columns)
    figure, axes = new_figure(3.7 * columns + 0.4, 3.2 * rows, columns, rows)
    for axis in axes[count:]:
        axis.set_visible(False)
    for axis, fit in zip(axes, result.fits, strict=False):
        _target_panel(axis, result, fit)
    _probability_panel(axes[count - 1], result)
    (name,), (prior,) = result.freed.names, result.freed.priors
    for axis in axes[:count]:
        axis.set_xscale(prior.spacing)
        axis.set_xlim(prior.low, prior.high)
        axis.set_xlabel(axis_label(name), fontsize=9)
    return figure


def _target_panel(axis: Any, result: StageResult, fit: TargetFit) -> None:
    u = np.linspace(0.0, 1.0, POINTS)[:, None]
    x, (mean, variance) = result.freed.values(u)[:, 0], fit.surrogate.average(u)
    scale, sd, known = fit.target.model_scale, np.sqrt(variance), fit.measured
    axis.fill_between(
        x, backward(scale, mean - sd), backward(scale, mean + sd), color=LINES[1], alpha=0.25, lw=0
    )
    axis.plot(x, backward(scale, mean), color=LINES[1], lw=1.6)
    axis.axhspan(known.value - known.se, known.value + known.se, color=TARGET, alpha=0.25, lw=0)
    axis.axhline(known.value, color=TARGET, lw=1.6, ls=(0, (4, 2)))
    _runs(axis, result, fit)
    _mark(axis, result, fit.predicted)
    axis.set_ylabel(f"[{fit.target.simulated_unit}]", fontsize=9)
    axis.set_title(measured_title(fit), fontsize=9, color=INK)


def _runs(axis: Any, result: StageResult, fit: TargetFit) -> None:
    """Draw the runs; a curve's have no single height, so only where they lie is shown."""
    at = result.freed.values(np.array([p.u for p in result.planned]))[:, 0]
    good, bad = runs_of(result, fit)
    if fit.target.is_curve:
        axis.plot(at[good], np.zeros(good.sum()), "|", color=REGION, ms=6,
                  transform=axis.get_xaxis_transform())  # fmt: skip
    else:
        seen = result.runs[fit.target.observable].to_numpy(float)
        axis.plot(at[good], seen[good], "o", ms=3.2, mfc="white", mec=REGION, mew=0.7, ls="")
    axis.plot(at[bad], np.zeros(bad.sum()), "x", ms=5, mec=REGION, mew=1.2, ls="",
              transform=axis.get_xaxis_transform(), clip_on=False)  # fmt: skip


def _probability_panel(axis: Any, result: StageResult) -> None:
    posterior = result.posterior
    if isinstance(posterior, GridPosterior):
        u, height = posterior.axes[0], posterior.density / posterior.density.max()
        x = result.freed.values(u[:, None])[:, 0]
        axis.plot(x, height, color=REGION, lw=1.4)
        for level in LEVELS[:2]:
            span = result.intervals[result.freed.names[0]][level]
            inside = (x >= span.low) & (x <= span.high)
            axis.fill_between(x[inside], height[inside], color=REGION, alpha=0.2, lw=0)
    axis.set_ylim(0.0, None)
    axis.set_yticks([])
    _mark(axis, result, 0.0)
    axis.set_title("all targets together:\n68 % and 90 % intervals", fontsize=9, color=INK)


def _mark(axis: Any, result: StageResult, height: float) -> None:
    (x,) = result.found.values()
    shape, fill, edge = (
        ("o", TARGET, "white") if result.verdict.is_point else ("D", "white", TARGET)
    )
    axis.plot(x, height, shape, ms=8, mfc=fill, mec=edge, mew=1.5, zorder=10, clip_on=False)
