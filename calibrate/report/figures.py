"""Figures of a calibration, drawn to be read on light and dark paper alike."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from calibrate.questions.figures import corner_figure
from calibrate.report.contour_figure import contour_figure
from calibrate.report.drawing import INK, LINES, SYMBOLS, TARGET, new_figure, png
from calibrate.report.single_figure import single_figure
from calibrate.scales import backward
from calibrate.staged.posterior.cloud import CloudPosterior
from calibrate.staged.result import StageResult
from calibrate.study.model import Study

__all__ = ["interval_figure", "quality_figure", "stage_figure"]


def stage_figure(result: StageResult) -> bytes:
    """Draw a stage: contour lines of two parameters, the curve of one, a corner plot of more.

    Returns
    -------
    bytes
        PNG.
    """
    posterior = result.posterior
    if isinstance(posterior, CloudPosterior):
        names = posterior.drawn.names
        best = dict(zip(names, map(float, posterior.drawn.best), strict=True))
        return png(corner_figure(posterior.drawn, best, result.undetermined))
    return png(single_figure(result) if posterior.size == 1 else contour_figure(result))


def quality_figure(results: Sequence[StageResult]) -> bytes:
    """Draw every surrogate's left-out predictions against the simulated values, as PNG."""
    fits = [fit for result in results for fit in result.fits]
    columns = min(len(fits), 4)
    rows = -(-len(fits) // columns)
    figure, axes = new_figure(2.5 * columns, 2.4 * rows, columns, rows)
    for axis in axes[len(fits) :]:
        axis.set_visible(False)
    for axis, fit in zip(axes, fits, strict=False):
        scale, quality = fit.target.model_scale, fit.surrogate.quality
        # The first component of a curve has no unit, and no scale to be taken off.
        off = np.asarray if fit.target.is_curve else partial(backward, scale)
        seen, guess = off(quality.observed), off(quality.predicted)
        low = guess - off(quality.predicted - quality.predicted_sd)
        high = off(quality.predicted + quality.predicted_sd) - guess
        axis.errorbar(
            seen, guess, yerr=[low, high], fmt="o", ms=3, color=LINES[1], ecolor=INK, elinewidth=0.7
        )
        ends = [float(min(seen.min(), guess.min())), float(max(seen.max(), guess.max()))]
        axis.plot(ends, ends, color=INK, lw=0.8)
        axis.set_title(f"{fit.target.name}\n$Q^2$ = {quality.q2:.2f}", fontsize=8, color=INK)
        unit = "first component" if fit.target.is_curve else f"[{fit.target.simulated_unit}]"
        axis.set_xlabel(f"simulated {unit}", fontsize=8)
    for axis in axes[::columns]:
        axis.set_ylabel("predicted when left out", fontsize=8)
    return png(figure)


def interval_figure(study: Study, results: Sequence[StageResult]) -> bytes:
    """Draw the found parameters with their intervals, and published values as crosses, as PNG."""
    rows = [(result, k) for result in results for k in range(len(result.freed.keys))]
    figure, (axis,) = new_figure(7.2, 0.42 * len(rows) + 0.7, 1)
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
    return png(figure)
