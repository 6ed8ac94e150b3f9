"""Pictures of what was measured on photographs, as PNG: outlines, flanks, distributions."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any, Final

import cv2
import numpy as np
import numpy.typing as npt

from liggghts_io.photo.grains.result import GrainSizes
from liggghts_io.photo.heap import Heap
from liggghts_io.photo.light import FloatArray
from liggghts_io.photo.ticks import Ruler
from liggghts_io.pictures.style import EDGE, FIT, INK, WIDTH, sheet

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ColourImage = npt.NDArray[np.uint8]

COUNTED: Final = (30, 200, 60)  # red, green, blue
LEFT_OUT: Final = (235, 40, 60)
FOLLOWED: Final = (40, 110, 240)
_LEAST_WIDTH: Final = 1400  # px of an annotated picture; smaller photographs are magnified
_MOST_WIDTH: Final = 3000
_LINE: Final = 900  # picture's width over that of a line
_FINE_BITS: Final = 4  # binary digits of a coordinate behind the point
_BINS: Final = (8, 40)  # bars of a histogram, fewest and most
_UM: Final = 1e6
_PLATE: Final = "#2a7fb8"
_ABOVE: Final = 0.25  # of a heap's height, shown above it


def grains_picture(colour: ColourImage, found: GrainSizes, ruler: Ruler | None = None) -> bytes:
    """Draw the outlines of grains into their photograph: green what counts, red what does not.

    Blue is where the ticks of a ruler were followed.

    Parameters
    ----------
    colour : (rows, columns, 3) uint8
        Red, green, blue.
    found : GrainSizes
    ruler : Ruler, optional

    Returns
    -------
    bytes
        PNG.
    """
    columns = colour.shape[1]
    zoom = max(1.0, np.ceil(_LEAST_WIDTH / columns)) if columns < _LEAST_WIDTH else 1.0
    zoom = min(zoom, _MOST_WIDTH / columns)
    way = cv2.INTER_AREA if zoom < 1.0 else cv2.INTER_NEAREST
    size = (round(columns * zoom), round(colour.shape[0] * zoom))
    canvas = np.ascontiguousarray(cv2.resize(colour, size, interpolation=way))
    wide = max(1, round(size[0] / _LINE))
    lines = np.empty((0, 2, 2)) if ruler is None else ruler.line[None]
    for outlines, ink in (
        (found.left_out, LEFT_OUT), (found.outlines, COUNTED), (lines, FOLLOWED),
    ):  # fmt: skip
        fixed = np.round(((outlines + 0.5) * zoom - 0.5) * 2**_FINE_BITS).astype(np.int32)
        cv2.polylines(canvas, list(fixed), True, ink, wide, cv2.LINE_AA, _FINE_BITS)
    return bytes(cv2.imencode(".png", cv2.cvtColor(canvas, cv2.COLOR_RGB2BGR))[1])


def sizes_chart(diameters_m: FloatArray, d32_m: float, quantiles_m: tuple[float, ...]) -> bytes:
    """Draw the distribution of diameters by number, with its quantiles and the Sauter diameter.

    Parameters
    ----------
    diameters_m : (n,) float64
        [m]
    d32_m : float
        Sauter diameter [m].
    quantiles_m : tuple of float
        d10,0, d50,0 and d90,0 [m].

    Returns
    -------
    bytes
        PNG.
    """
    figure, axes = sheet(0.6 * WIDTH)
    d = np.sort(diameters_m) * _UM
    bins = int(np.clip(np.sqrt(len(d)), *_BINS))
    axes.hist(d, bins=bins, weights=np.full(len(d), 100.0 / len(d)), color="#c9d6e5", edgecolor="w")
    axes.set_xlabel("diameter of the circle of equal area (µm)")
    axes.set_ylabel("grains in a bar (%)")
    total = axes.twinx()
    total.step(d, 100.0 * np.arange(1, len(d) + 1) / len(d), where="post", color=EDGE)
    total.set_ylim(0.0, 105.0)
    total.set_ylabel("grains below (%)")
    for value, name in zip(quantiles_m, ("d10,0", "d50,0", "d90,0"), strict=True):
        total.axvline(value * _UM, color=EDGE, lw=0.8, ls=":")
        total.text(value * _UM, 106.0, f"{name}\n{value * _UM:.0f}", ha="center", va="bottom",
                   fontsize=8, color=INK)  # fmt: skip
    total.axvline(d32_m * _UM, color=FIT, lw=1.2, label=f"d32 = {d32_m * _UM:.0f} µm")
    total.legend(loc="center right", frameon=False, fontsize=9, title=f"{len(d)} grains")
    return _png(figure)


def heap_picture(colour: ColourImage, heap: Heap, title: str) -> bytes:
    """Draw plate, outline and fitted flanks with their angles over the photograph of a heap.

    Parameters
    ----------
    colour : (rows, columns, 3) uint8
        Red, green, blue.
    heap : Heap
    title : str

    Returns
    -------
    bytes
        PNG.
    """
    rows, columns = colour.shape[:2]
    shrink = max(1, int(np.ceil(columns / _MOST_WIDTH)))
    figure, axes = sheet(min(WIDTH * rows / columns, 1.5 * WIDTH) + 0.4)
    extent = (0.0, float(columns), float(rows), 0.0)
    axes.imshow(colour[::shrink, ::shrink], extent=extent, interpolation="bilinear")
    axes.axis("off")
    ends = np.array([0.0, float(columns)])
    axes.plot(ends, heap.plate.row(ends), color=_PLATE, lw=1.0, label="plate")
    axes.plot(*heap.outline.T, color="#ffd23f", lw=0.8, label="outline")
    _flanks(axes, heap)
    axes.set_xlim(0.0, columns)
    axes.set_ylim(rows, 0.0)
    axes.set_title(title, fontsize=10, color=INK)
    axes.legend(loc="upper right", fontsize=8, framealpha=0.8)
    return _png(figure)


def _flanks(axes: Any, heap: Heap) -> None:
    """Draw the fitted lines, longer than the fit, with the angle beside each."""
    angles = [one for one in (heap.repose.left_deg, heap.repose.right_deg) if np.isfinite(one)]
    for (start, end), angle in zip(heap.lines, angles, strict=True):
        way = _ABOVE * (end - start)
        line = np.array([start - way, end + way])
        axes.plot(*line.T, color=FIT, lw=1.6)
        middle = 0.5 * (start + end)
        rises = end[1] < start[1]
        axes.annotate(
            f"{angle:.1f}°", middle, xytext=(-14 if rises else 14, 14),
            textcoords="offset points", ha="right" if rises else "left", color=FIT,
            fontsize=11, bbox={"facecolor": "w", "alpha": 0.75, "lw": 0, "pad": 1.5},
        )  # fmt: skip


def _png(figure: Figure) -> bytes:
    target = io.BytesIO()
    figure.savefig(target, format="png")
    return target.getvalue()
