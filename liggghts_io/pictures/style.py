"""One look for all pictures of cases: sizes, colours, and a sheet to draw on."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SOLID: Final = "lightsteelblue"
EDGE: Final = "#5b6b7f"
FIT: Final = "#d1495b"
FRAME: Final = "#7a7f87"
INK: Final = "#1f2937"

WIDTH: Final = 5.25  # inches; 1050 pixels, which a report shows at a half to all of their size
DOTS: Final = 200  # per inch
TEXT: Final = {"title": 10.5, "labels": 10, "ticks": 9, "notes": 9}  # points


def sheet(height: float) -> tuple[Figure, Any]:
    """Return a white figure of the common width [inches] and its axes."""
    # Here, not on top: matplotlib takes a second to load, and most commands draw nothing.
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(WIDTH, height), dpi=DOTS, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    axes.tick_params(labelsize=TEXT["ticks"], color=FRAME)
    axes.xaxis.label.set_fontsize(TEXT["labels"])
    axes.yaxis.label.set_fontsize(TEXT["labels"])
    for spine in axes.spines.values():
        spine.set_color(FRAME)
    axes.set_prop_cycle(color=["#2a7fb8", FIT, "#e0a020", "#5a9e6f"])
    return figure, axes
