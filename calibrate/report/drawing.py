"""What the figures of a report share: colours, empty panels, PNG."""

from __future__ import annotations

from io import BytesIO
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

__all__ = ["INK", "LINES", "TARGET", "blank_figure", "png"]

INK = "#7a7f87"  # grey that reads on white and on near-black
TARGET = "#d1495b"
LINES = ("#d1495b", "#2a7fb8", "#e0a020", "#5a9e6f")


def blank_figure(
    width: float, height: float, columns: int, rows: int = 1
) -> tuple[Figure, list[Any]]:
    """Return a transparent figure and its panels, row by row.

    Parameters
    ----------
    width, height : float
        [inch].
    columns, rows : int
    """
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


def png(figure: Figure) -> bytes:
    """Return a figure as PNG."""
    buffer = BytesIO()
    figure.savefig(buffer, format="png", transparent=True)
    return buffer.getvalue()
