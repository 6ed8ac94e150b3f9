"""A figure that a notebook shows when it is the last thing of a cell."""

from __future__ import annotations

from io import BytesIO

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

__all__ = ["ShownFigure", "shown_figure"]


class ShownFigure(Figure):
    """A matplotlib figure without a window, for pages, files and notebooks."""

    def _repr_png_(self) -> bytes:
        """Return the picture; notebooks ask for it."""
        buffer = BytesIO()
        self.savefig(buffer, format="png")
        return buffer.getvalue()


def shown_figure(width: float, height: float, dpi: float = 110.0) -> ShownFigure:
    """Return an empty figure with a transparent background, which fits light and dark pages.

    Parameters
    ----------
    width, height : float
        In inches.
    dpi : float
        Pixels per inch.
    """
    figure = ShownFigure(figsize=(width, height), dpi=dpi, layout="constrained")
    FigureCanvasAgg(figure)
    figure.patch.set_alpha(0.0)
    return figure
