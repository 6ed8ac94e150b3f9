"""What all figures of a report share: colours, words, panels."""

from __future__ import annotations

from io import BytesIO
from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from calibrate.questions.core.from_study import place_of
from calibrate.questions.figures import SYMBOLS
from calibrate.shown_figure import shown_figure
from calibrate.staged.result import StageResult, TargetFit

__all__ = [
    "INK",
    "LINES",
    "REGION",
    "SYMBOLS",
    "TARGET",
    "WORDS",
    "axis_label",
    "measured_title",
    "new_figure",
    "png",
    "runs_of",
]

WORDS: Final = {
    "mu_pp": "friction between particles",
    "mu_roll_pp": "rolling friction between particles",
    "mu_pw": "friction at the wall",
    "mu_roll_pw": "rolling friction at the wall",
    "e_pp": "restitution between particles",
    "e_pw": "restitution at the wall",
}
INK: Final = "#7a7f87"  # grey that reads on white and on near-black
TARGET: Final = "#d1495b"
REGION: Final = "#1f2937"
LINES: Final = ("#d1495b", "#2a7fb8", "#e0a020", "#5a9e6f")


def new_figure(
    width: float, height: float, columns: int, rows: int = 1
) -> tuple[Figure, list[Any]]:
    """Return a figure [inch] and its panels, row by row."""
    figure = shown_figure(width, height, dpi=150)
    axes = np.atleast_1d(figure.subplots(rows, columns)).ravel()
    for axis in axes:
        axis.tick_params(colors=INK, labelsize=8)
        for spine in axis.spines.values():
            spine.set_color(INK)
        axis.xaxis.label.set_color(INK)
        axis.yaxis.label.set_color(INK)
        axis.title.set_color(INK)
    return figure, list(axes)


def png(figure: Figure) -> bytes:
    """Return a figure as PNG."""
    buffer = BytesIO()
    figure.savefig(buffer, format="png", transparent=True)
    return buffer.getvalue()


def axis_label(name: str) -> str:
    """Return a parameter as an axis is labelled: symbol and meaning."""
    return f"{SYMBOLS.get(name, name)}  {WORDS.get(name, '')}"


def measured_title(fit: TargetFit) -> str:
    """Return the title of a panel of one target."""
    unit, known = fit.target.simulated_unit, fit.measured
    what = "mean of its levels, measured" if fit.target.is_curve else "measured"
    return f"{fit.target.label}\n{what} {known.value:.4g} ± {known.se:.2g} {unit}"


def runs_of(result: StageResult, fit: TargetFit) -> tuple[Any, Any]:
    """Return which runs of a stage are of a target and went well, and which failed, (n,) bool."""
    here = np.array([p.place == place_of(fit.target) for p in result.planned])
    ok = (result.runs["status"] == "ok").to_numpy()
    return here & ok, here & ~ok
