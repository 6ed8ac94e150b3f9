"""One look for all pictures of cases: sizes, colours, and a sheet to draw on."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from liggghts_io.errors import CaseError

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

SIGNED: Final = {"Software": "bulkcal"}
"""What our PNG files say of their origin, so that they can be told from those of a person."""
_SIGNATURE: Final = b"Software\0bulkcal"
_EARLIER: Final = b"Software\0Matplotlib"
_HEAD: Final = 4096  # bytes at the beginning of a PNG that hold its texts


def check_replaced(path: Path, option: str, *, case: bool = False) -> Path:
    """Return where a picture goes that nobody named; one that is there must be ours.

    Parameters
    ----------
    path : Path
    option : str
        With which another file is named.
    case : bool
        Whether it lies in a case directory, where earlier versions left unsigned ones.

    Raises
    ------
    CaseError
        For a file that we did not draw.
    """
    if path.exists():
        head = b""
        if path.is_file():
            with path.open("rb") as opened:
                head = opened.read(_HEAD)
        if _SIGNATURE not in head and not (case and _EARLIER in head):
            msg = (
                f"{path}: exists already and was not drawn by bulkcal; name another file with "
                f"{option}, or move it away"
            )
            raise CaseError(msg)
    return path


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
