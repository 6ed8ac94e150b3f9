"""What the figures of measurements share: panels, colours, the bytes of a picture."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO
from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from calibrate.shown_figure import shown_figure
from liggghts_io.pictures.style import SIGNED

__all__ = ["COLOURS", "GREY", "INK", "new_panels", "png_of"]

INK: Final = "#1f2937"
GREY: Final = "#7a7f87"
COLOURS: Final = ("#2a7fb8", "#d1495b", "#5a9e6f", "#e0a020", "#7b5ea7")
_DPI: Final = 150.0


def new_panels(width: float, height: float, ratios: Sequence[float]) -> tuple[Figure, list[Any]]:
    """Return a figure on white [inch] and its panels from top to bottom, so high as the ratios."""
    figure = shown_figure(width, height, dpi=_DPI)
    figure.patch.set_alpha(1.0)
    axes = list(np.atleast_1d(figure.subplots(len(ratios), 1, height_ratios=ratios)))
    for axis in axes:
        axis.tick_params(labelsize=9, color=GREY)
        axis.xaxis.label.set_fontsize(10)
        axis.yaxis.label.set_fontsize(10)
        for side in ("top", "right"):
            axis.spines[side].set_visible(False)
        for spine in axis.spines.values():
            spine.set_color(GREY)
    return figure, axes


def png_of(figure: Figure) -> bytes:
    """Return a figure as PNG."""
    buffer = BytesIO()
    figure.savefig(buffer, format="png", metadata=SIGNED)
    return buffer.getvalue()
