"""Figures of a joint calibration: every target as measured and predicted, and the emulators."""

from __future__ import annotations

from textwrap import wrap
from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from calibrate.arrays import Array
from calibrate.emulator.quality import draw_left_out
from calibrate.inference.problem import Place, Reading
from calibrate.questions.joint.check import CheckRow
from calibrate.questions.joint.result import JointResult
from calibrate.report.drawing import INK, LINES, TARGET, new_figure
from calibrate.scales import backward
from calibrate.study.schema.targets import Target

__all__ = ["left_out_figure", "targets_figure"]

COLUMNS: Final = 3
PANEL: Final = (2.9, 1.75)
"""Width and height of a panel [inch]."""
LETTERS: Final = 40
"""Of a title that fit above a panel."""
NINETY: Final = 1.645
"""Half width of a 90 % interval in standard errors."""
WORDS: Final = ("measured", "predicted", "engine")


def targets_figure(result: JointResult) -> Figure:
    """Return a panel for each target: measured, predicted by the posterior, and the engine's check.

    Bars are 90 % intervals. A curve has its levels along the axis.
    """
    seen = {reading.name: (place, reading) for place in result.problem.places
            for reading in place.readings}  # fmt: skip
    rows = [row for row in result.check if row.name in seen]
    figure, panels = _panels(len(rows))
    for panel, row in zip(panels, rows, strict=True):
        target = result.study.target_named(row.name)
        title = row.label if row.met else f"{row.label} (not met)"
        panel.set_title(_lines(title), fontsize=8, color=INK)
        if target.is_curve:
            levels = np.array(result.data.curves[row.name].levels)
            _curve(panel, result, *seen[row.name], target, levels)
        else:
            _number(panel, row)
    return figure


def _lines(title: str) -> str:
    """Return a title in lines that fit above a panel; what is too long for two ends in dots."""
    return "\n".join(wrap(title, LETTERS, max_lines=2, placeholder=" ..."))


def _panels(count: int) -> tuple[Figure, list[Any]]:
    columns = min(count, COLUMNS)
    rows = -(-count // columns)
    figure, axes = new_figure(PANEL[0] * columns, PANEL[1] * rows, columns, rows)
    for axis in axes[count:]:
        axis.set_visible(False)
    return figure, axes[:count]


def _number(panel: Any, row: CheckRow) -> None:
    """Draw three bars below each other: measured, predicted, engine."""
    bars = (
        (row.measured, row.measured_se, TARGET, "D"),
        (row.predicted, row.predicted_sd, LINES[1], "o"),
        (row.simulated, row.simulated_se, INK, "s"),
    )
    for height, (value, error, colour, marker) in enumerate(bars):
        panel.errorbar(
            [value], [-height], xerr=[NINETY * error], fmt=marker, color=colour, markersize=5,
            elinewidth=2.0,
        )  # fmt: skip
    panel.axvspan(
        row.measured - NINETY * row.measured_se, row.measured + NINETY * row.measured_se,
        color=TARGET, alpha=0.12, linewidth=0.0,
    )  # fmt: skip
    panel.set_ylim(-len(bars) + 0.4, 0.6)
    panel.set_yticks([-k for k in range(len(bars))], WORDS)
    panel.set_xlabel(f"[{row.unit}]", fontsize=8, color=INK)


def _curve(
    panel: Any, result: JointResult, place: Place, reading: Reading, target: Target, levels: Array
) -> None:
    """Draw a measured curve and the band in which the posterior expects it."""
    expected = place.predict(result.posterior.samples).columns(reading.columns)
    spread = np.sqrt(expected.mean.var(axis=0) + expected.total.mean(axis=0))
    middle, scale = expected.mean.mean(axis=0), target.model_scale
    low, high = (backward(scale, middle + side * NINETY * spread) for side in (-1.0, 1.0))
    panel.fill_between(levels, low, high, color=LINES[1], alpha=0.35, linewidth=0.0)
    panel.plot(levels, backward(scale, middle), color=LINES[1], linewidth=1.2)
    y = backward(scale, reading.y)
    below = y - backward(scale, reading.y - NINETY * reading.se)
    above = backward(scale, reading.y + NINETY * reading.se) - y
    panel.errorbar(
        levels, y, yerr=[below, above], fmt="D", color=TARGET, markersize=3, elinewidth=1.0
    )
    curve = target.curve
    x = f"{curve.x_name} [{curve.x_unit}]" if curve else "level"
    panel.set_xlabel(x, fontsize=8, color=INK)
    panel.set_ylabel(f"[{target.simulated_unit}]", fontsize=8, color=INK)


def left_out_figure(result: JointResult) -> Figure:
    """Return a panel for each emulated output: runs that it was not shown, against its guess.

    Numbers are on the scale on which they are emulated.
    """
    parts = [
        (experiment, kind, part)
        for (experiment, kind), one in result.emulators.trained.items()
        for part in one.emulator.parts
    ]
    figure, panels = _panels(len(parts))
    for panel, (experiment, kind, part) in zip(panels, parts, strict=True):
        draw_left_out(panel, part, LINES[1])
        title = _lines(f"{part.output.name}, {experiment}, {kind}")
        panel.set_title(title, fontsize=8, color=INK)
    for panel in panels[::COLUMNS]:
        panel.set_ylabel("predicted when left out", fontsize=8, color=INK)
    for panel in panels[-COLUMNS:]:
        panel.set_xlabel("simulated", fontsize=8, color=INK)
    return figure
