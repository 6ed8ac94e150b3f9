"""Figures of a calibration, drawn to be read on light and dark paper alike."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from calibrate.arrays import Array
from calibrate.scales import backward, forward, slope
from calibrate.staged.contours import contour_lines
from calibrate.staged.design import from_unit
from calibrate.staged.result import StageResult, TargetFit
from calibrate.staged.surface import Surrogate
from calibrate.study.model import Study

__all__ = ["SYMBOLS", "interval_figure", "quality_figure", "stage_figure"]


SYMBOLS = {
    "mu_pp": r"$\mu_\mathrm{pp}$",
    "mu_roll_pp": r"$\mu_\mathrm{R,pp}$",
    "mu_pw": r"$\mu_\mathrm{pw}$",
    "mu_roll_pw": r"$\mu_\mathrm{R,pw}$",
    "e_pp": r"$e_\mathrm{pp}$",
    "e_pw": r"$e_\mathrm{pw}$",
}
WORDS = {
    "mu_pp": "friction between particles",
    "mu_roll_pp": "rolling friction between particles",
    "mu_pw": "friction at the wall",
    "mu_roll_pw": "rolling friction at the wall",
    "e_pp": "restitution between particles",
    "e_pw": "restitution at the wall",
}
INK = "#7a7f87"  # grey that reads on white and on near-black
TARGET = "#d1495b"
REGION = "#1f2937"
LINES = ("#d1495b", "#2a7fb8", "#e0a020", "#5a9e6f")
GRID = 161


def _figure(width: float, height: float, columns: int, rows: int = 1) -> tuple[Figure, list[Any]]:
    figure = Figure(figsize=(width, height), dpi=150, layout="constrained")
    FigureCanvasAgg(figure)
    figure.patch.set_alpha(0.0)
    axes = np.atleast_1d(figure.subplots(rows, columns)).ravel()
    for axis in axes:
        axis.tick_params(colors=INK, labelsize=8)
        for spine in axis.spines.values():
            spine.set_color(INK)
        axis.xaxis.label.set_color(INK)
        axis.yaxis.label.set_color(INK)
        axis.title.set_color(INK)
    return figure, list(axes)


def _png(figure: Figure) -> bytes:
    buffer = BytesIO()
    figure.savefig(buffer, format="png", transparent=True)
    return buffer.getvalue()


def stage_figure(result: StageResult) -> bytes:
    """Draw the contour lines of every target of a stage and, last, all targets together.

    Returns
    -------
    bytes
        PNG.
    """
    count = len(result.fits) + 1
    columns = count if count <= 3 else 2  # four panels in a row are too small to read
    rows = -(-count // columns)
    figure, axes = _figure(3.7 * columns + 0.4, 3.5 * rows, columns, rows)
    for axis in axes[count - 1 : -1]:
        axis.set_visible(False)  # an odd place stays empty; the last panel shows all together
    for axis, fit in zip(axes, result.fits, strict=False):
        _target_panel(axis, result, fit)
    _joint_panel(axes[-1], result)
    for axis in axes:
        _label(axis, result)
    return _png(figure)


def _label(axis: Any, result: StageResult) -> None:
    first, second = result.freed.names
    bounds = result.freed.bounds
    axis.set_xlim(*bounds[0])
    axis.set_ylim(*bounds[1])
    axis.set_xlabel(f"{SYMBOLS.get(first, first)}  {WORDS.get(first, '')}", fontsize=9)
    axis.set_ylabel(f"{SYMBOLS.get(second, second)}  {WORDS.get(second, '')}", fontsize=9)


def _fields(result: StageResult, surrogate: Surrogate) -> tuple[Array, Array, Array, Array]:
    """Return both axes in the parameters' units, and mean and variance on the grid."""
    axis = np.linspace(0.0, 1.0, GRID)
    grid = np.stack(np.meshgrid(axis, axis, indexing="ij"), axis=-1).reshape(-1, 2)
    mean, variance = surrogate.predict(grid)
    bounds = result.freed.bounds
    x, y = (bounds[i, 0] + axis * (bounds[i, 1] - bounds[i, 0]) for i in range(2))
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
    unit = fit.target.simulated_unit
    axis.set_title(
        f"{fit.target.label}\nmeasured {known.value:g} ± {known.se:g} {unit}",
        fontsize=9,
        color=INK,
    )


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
    posterior, bounds = result.posterior, result.freed.bounds
    x, y = (bounds[i, 0] + posterior.axes[i] * (bounds[i, 1] - bounds[i, 0]) for i in range(2))
    for share, style in ((0.90, "solid"), (0.68, "dotted")):
        level = posterior.level_of(share)
        axis.contour(
            x, y, posterior.density.T, levels=[level], colors=REGION, linewidths=1.4,
            linestyles=style,
        )  # fmt: skip
    axis.plot([], [], color=REGION, lw=1.4, label="68 % and 90 % region")


def _design(axis: Any, result: StageResult, fit: TargetFit) -> None:
    place = (fit.target.experiment, fit.target.surface)
    here = [(p.spec.experiment, p.spec.surface) == place for p in result.planned]
    ok = (result.runs["status"] == "ok").to_numpy()
    points = from_unit(np.array([p.u for p in result.planned]), result.freed.bounds)
    good, bad = np.array(here) & ok, np.array(here) & ~ok
    axis.plot(*points[good].T, "o", ms=3.2, mfc="white", mec=REGION, mew=0.7, ls="")
    axis.plot(*points[bad].T, "x", ms=5, mec=REGION, mew=1.2, ls="")


def _point(axis: Any, result: StageResult) -> None:
    x, y = result.found.values()
    if result.verdict.is_point:
        axis.plot(x, y, "o", ms=9, mfc=TARGET, mec="white", mew=1.5, zorder=10, clip_on=False)
    else:
        axis.plot(x, y, "D", ms=8, mfc="white", mec=TARGET, mew=2.0, zorder=10, clip_on=False)


def quality_figure(results: Sequence[StageResult]) -> bytes:
    """Draw every surrogate's left-out predictions against the simulated values, as PNG."""
    fits = [fit for result in results for fit in result.fits]
    columns = min(len(fits), 4)
    rows = -(-len(fits) // columns)
    figure, axes = _figure(2.5 * columns, 2.4 * rows, columns, rows)
    for axis in axes[len(fits) :]:
        axis.set_visible(False)
    for axis, fit in zip(axes, fits, strict=False):
        scale, quality = fit.target.model_scale, fit.surrogate.quality
        seen = backward(scale, quality.observed)
        guess = backward(scale, quality.predicted)
        low = guess - backward(scale, quality.predicted - quality.predicted_sd)
        high = backward(scale, quality.predicted + quality.predicted_sd) - guess
        axis.errorbar(
            seen, guess, yerr=[low, high], fmt="o", ms=3, color=LINES[1], ecolor=INK, elinewidth=0.7
        )
        ends = [float(min(seen.min(), guess.min())), float(max(seen.max(), guess.max()))]
        axis.plot(ends, ends, color=INK, lw=0.8)
        axis.set_title(f"{fit.target.name}\n$Q^2$ = {quality.q2:.2f}", fontsize=8, color=INK)
        axis.set_xlabel(f"simulated [{fit.target.simulated_unit}]", fontsize=8)
    for axis in axes[::columns]:
        axis.set_ylabel("predicted when left out", fontsize=8)
    return _png(figure)


def interval_figure(study: Study, results: Sequence[StageResult]) -> bytes:
    """Draw the found parameters with their intervals, and published values as crosses, as PNG."""
    rows = [(result, k) for result in results for k in range(len(result.freed.keys))]
    figure, (axis,) = _figure(7.2, 0.42 * len(rows) + 0.7, 1)
    labels = []
    for i, (result, k) in enumerate(rows):
        name, instance = result.freed.keys[k]
        labels.append(study.label(name, instance).replace(name, SYMBOLS.get(name, name), 1))
        low, high = result.freed.bounds[k]
        axis.plot([low, high], [i, i], color=INK, lw=0.8, alpha=0.6)
        for level, width in ((0.90, 3.0), (0.68, 7.0)):
            interval = result.intervals[name][level]
            axis.plot([interval.low, interval.high], [i, i], color=LINES[1], lw=width, alpha=0.75,
                      solid_capstyle="butt")  # fmt: skip
        marker = "o" if result.verdict.is_point else "D"
        axis.plot(result.found[name], i, marker, ms=7, mfc=TARGET, mec="white", mew=1.2)
        published = study.published_of(name, instance)
        if published is not None:
            axis.plot(published, i, "x", ms=7, mec=INK, mew=1.8)
    axis.set_yticks(range(len(rows)), labels, fontsize=11)
    axis.invert_yaxis()
    axis.set_xlim(0.0, 1.0)
    for side in ("top", "right", "left"):
        axis.spines[side].set_visible(False)
    return _png(figure)
