"""A stage that frees two parameters: contour lines of every target, as in the paper."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from calibrate.arrays import Array
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
from calibrate.scales import backward, forward, slope
from calibrate.staged.contours import contour_lines
from calibrate.staged.posterior.grid import GridPosterior
from calibrate.staged.result import StageResult, TargetFit
from calibrate.staged.surrogates.emulated import TargetSurrogate

__all__ = ["contour_figure"]

GRID: Final = 161


def contour_figure(result: StageResult) -> Figure:
    """Return the contour lines of every target of a stage and, last, all targets together.

    Parameters
    ----------
    result : StageResult
        Of a stage that frees two parameters.
    """
    count = len(result.fits) + 1
    columns = count if count <= 3 else 2  # four panels in a row are too small to read
    rows = -(-count // columns)
    figure, axes = new_figure(3.7 * columns + 0.4, 3.5 * rows, columns, rows)
    for axis in axes[count - 1 : -1]:
        axis.set_visible(False)  # an odd place stays empty; the last panel shows all together
    for axis, fit in zip(axes, result.fits, strict=False):
        _target_panel(axis, result, fit)
    _joint_panel(axes[-1], result)
    for axis in axes:
        _label(axis, result)
    return figure


def _label(axis: Any, result: StageResult) -> None:
    first, second = result.freed.names
    bounds = result.freed.bounds
    axis.set_xlim(*bounds[0])
    axis.set_ylim(*bounds[1])
    for side, prior in zip((axis.set_xscale, axis.set_yscale), result.freed.priors, strict=True):
        side(prior.spacing)
    axis.set_xlabel(axis_label(first), fontsize=9)
    axis.set_ylabel(axis_label(second), fontsize=9)


def _fields(result: StageResult, surrogate: TargetSurrogate) -> tuple[Array, Array, Array, Array]:
    """Return both axes in the parameters' units, and mean and variance on the grid."""
    axis = np.linspace(0.0, 1.0, GRID)
    grid = np.stack(np.meshgrid(axis, axis, indexing="ij"), axis=-1).reshape(-1, 2)
    mean, variance = surrogate.average(grid)
    x, y = result.freed.values(np.column_stack([axis, axis])).T
    return x, y, mean.reshape(GRID, GRID), variance.reshape(GRID, GRID)


def _target_panel(axis: Any, result: StageResult, fit: TargetFit) -> None:
    x, y, mean, _ = _fields(result, fit.surrogate)
    values = backward(fit.target.model_scale, mean)
    axis.contourf(x, y, values.T, levels=14, cmap="BuPu", alpha=0.55)
    lines = axis.contour(x, y, values.T, levels=9, colors=REGION, linewidths=0.6, alpha=0.7)
    axis.clabel(lines, fontsize=7, fmt="%.3g")
    known = fit.measured
    if values.min() <= known.value + known.se and values.max() >= known.value - known.se:
        band = [known.value - known.se, known.value + known.se]
        axis.contourf(x, y, values.T, levels=band, colors=[TARGET], alpha=0.35)
    for line in contour_lines((x, y), values, known.value):
        axis.plot(*line.T, color=TARGET, lw=2.0, ls=(0, (4, 2)))
    _design(axis, result, fit)
    _point(axis, result)
    axis.set_title(measured_title(fit), fontsize=9, color=INK)


def _joint_panel(axis: Any, result: StageResult) -> None:
    axis.patch.set_facecolor("#f6f6f4")
    for fit, colour in zip(result.fits, LINES, strict=False):
        x, y, mean, variance = _fields(result, fit.surrogate)
        scale, known = fit.target.model_scale, fit.measured
        goal = float(forward(scale, np.array(known.value)))
        error = np.sqrt(variance + (slope(scale, known.value) * known.se) ** 2)
        axis.contourf(x, y, ((mean - goal) / error).T, levels=[-1, 1], colors=[colour], alpha=0.25)
        for line in contour_lines((x, y), mean, goal):
            axis.plot(*line.T, color=colour, lw=1.6, ls=(0, (4, 2)))
        axis.plot([], [], color=colour, lw=1.6, ls=(0, (4, 2)), label=fit.target.label)
    _region(axis, result)
    _point(axis, result)
    axis.set_title("all targets together", fontsize=9, color=INK)
    legend = axis.legend(fontsize=7, loc="upper right", framealpha=0.85, edgecolor="none")
    for text in legend.get_texts():
        text.set_color(REGION)


def _region(axis: Any, result: StageResult) -> None:
    posterior = result.posterior
    if not isinstance(posterior, GridPosterior):
        return
    x, y = result.freed.values(np.column_stack(posterior.axes)).T
    for share, style in ((0.90, "solid"), (0.68, "dotted")):
        level = posterior.level_of(share)
        axis.contour(
            x, y, posterior.density.T, levels=[level], colors=REGION, linewidths=1.4,
            linestyles=style,
        )  # fmt: skip
    axis.plot([], [], color=REGION, lw=1.4, label="68 % and 90 % region")


def _design(axis: Any, result: StageResult, fit: TargetFit) -> None:
    points = result.freed.values(np.array([p.u for p in result.planned]))
    good, bad = runs_of(result, fit)
    axis.plot(*points[good].T, "o", ms=3.2, mfc="white", mec=REGION, mew=0.7, ls="")
    axis.plot(*points[bad].T, "x", ms=5, mec=REGION, mew=1.2, ls="")


def _point(axis: Any, result: StageResult) -> None:
    x, y = result.found.values()
    if result.verdict.is_point:
        axis.plot(x, y, "o", ms=9, mfc=TARGET, mec="white", mew=1.5, zorder=10, clip_on=False)
    else:
        axis.plot(x, y, "D", ms=8, mfc="white", mec=TARGET, mew=2.0, zorder=10, clip_on=False)
