"""Put axes, a colour bar and words around the picture of a shot."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from liggghts_io.experiments import Notes
from liggghts_io.pictures.camera import Camera
from liggghts_io.pictures.shot import Shot, Window, edge_on
from liggghts_io.pictures.style import EDGE, FIT, FRAME, INK, SOLID, TEXT, WIDTH, sheet

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MM: Final = 1e3
_HEIGHTS: Final = (2.6, 7.5)  # inches
_AROUND: Final = (0.7, 1.55)  # inches of words and bar beside and above the picture itself
_BAR_TICKS: Final = 5
_FLAT: Final = (4.5, 3)  # a picture lower than that [inches] has a short bar, and so many ticks
_SCALE_PART: Final = 0.25  # most of the width that the bar of a length takes
_ROUND: Final = (5.0, 2.0, 1.0)


def composed(
    shot: Shot, camera: Camera, grains: Path | None, window: Window | None = None
) -> Figure:
    """Return the picture of the grains, or discs, with axes, colour bar and notes.

    Parameters
    ----------
    shot : Shot
    camera : Camera
    grains : Path, optional
        What VTK drew; discs where it could not.
    window : (float, float, float, float), optional
        Left, right, bottom and top [m] where they are not those of the shot.
    """
    left, right, low, high = (_MM * edge for edge in window or shot.window_of(camera))
    height = (WIDTH - _AROUND[0]) * (high - low) / (right - left) + _AROUND[1]
    figure, axes = sheet(min(max(height, _HEIGHTS[0]), _HEIGHTS[1]))
    if grains is None:
        _discs(axes, shot, camera)
    else:
        from matplotlib.image import imread

        axes.imshow(imread(grains), extent=(left, right, low, high), interpolation="antialiased")
    _edges(axes, shot, camera)
    notes = shot.notes_for(camera)
    _write(axes, notes)
    axes.set(aspect="equal", xlim=(left, right), ylim=(low, high))
    if camera.axes is None:
        _length(axes, (left, right, low, high))
    else:
        axes.set(xlabel=f"{camera.axes[0]} (mm)", ylabel=f"{camera.axes[1]} (mm)")
    away = int(shot.far.sum())
    lost = f"far away and not in sight: {away} of {shot.frame.count} grains" if away else ""
    words = "\n".join(line for line in (shot.title, notes.title, lost) if line)
    figure.suptitle(words, x=0.01, ha="left", fontsize=TEXT["title"], color=INK)
    _legend(figure, axes, shot)
    return figure


def _discs(axes: Any, shot: Shot, camera: Camera) -> None:
    """Draw grains as discs, far ones first, for machines on which VTK cannot draw."""
    from matplotlib.collections import EllipseCollection, PolyCollection

    order = np.argsort(camera.depths(shot.frame.positions))
    size = 2.0 * _MM * shot.frame.columns["radius"][order]
    discs = EllipseCollection(
        size, size, np.zeros_like(size), units="xy", transOffset=axes.transData,
        offsets=_MM * camera.seen(shot.frame.positions[order]), edgecolors="black", linewidths=0.2,
        facecolors=shot.colouring.of(shot.frame)[order] / 255.0,
    )  # fmt: skip
    axes.add_collection(discs)
    for name, triangles in shot.meshes.items():
        faces = PolyCollection(
            list(_MM * camera.seen(triangles)), facecolors=SOLID,
            alpha=shot.opacity(name, camera),
        )  # fmt: skip
        axes.add_collection(faces)


def _edges(axes: Any, shot: Shot, camera: Camera) -> None:
    """Draw what has no thickness in this view, as a level plate from the side."""
    from matplotlib.collections import LineCollection

    for triangles in shot.meshes.values():
        lines = list(_MM * camera.seen(triangles[edge_on(triangles, camera)]))
        axes.add_collection(LineCollection(lines, colors=EDGE, linewidths=1.8))


def _write(axes: Any, notes: Notes) -> None:
    for line in notes.lines:
        x, z = _MM * line.T
        axes.plot(x, z, color="white", linewidth=4.0, solid_capstyle="round")
        axes.plot(x, z, color=FIT, linewidth=2.2, solid_capstyle="round")
    for x, z, text in notes.labels:
        axes.text(
            _MM * x, _MM * z, text, ha="center", va="center", fontsize=TEXT["notes"], color=INK
        )


def _length(axes: Any, window: tuple[float, float, float, float]) -> None:
    """Draw a round length, where no axis lies in the picture."""
    left, right, low, high = window
    longest = _SCALE_PART * (right - left)
    power = 10.0 ** math.floor(math.log10(longest))
    length = power * next(one for one in _ROUND if one * power <= longest)
    x, z = left + 0.04 * (right - left), low + 0.05 * (high - low)
    axes.plot([x, x + length], [z, z], color=INK, linewidth=2.5, solid_capstyle="butt")
    above = z + 0.02 * (high - low)
    words = f"{length:g} mm"
    axes.text(x + length / 2, above, words, ha="center", va="bottom", fontsize=TEXT["ticks"])
    axes.set(xticks=[], yticks=[])
    for spine in axes.spines.values():
        spine.set_visible(False)


def _legend(figure: Figure, axes: Any, shot: Shot) -> None:
    """Say what the colours say: a bar as wide as the picture, or a patch for each kind."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize
    from matplotlib.lines import Line2D
    from matplotlib.ticker import MaxNLocator

    colouring = shot.colouring
    if not colouring.is_bar:
        dots = [
            Line2D([], [], marker="o", linestyle="", markersize=8, color=colour, label=words)
            for colour, words in colouring.patches
        ]
        figure.legend(
            handles=dots, loc="outside lower center", ncols=min(len(dots), 5), frameon=False,
            fontsize=TEXT["labels"],
        )  # fmt: skip
        return
    bar = figure.colorbar(
        ScalarMappable(Normalize(colouring.low, colouring.high), colouring.scale),
        ax=axes, orientation="horizontal", fraction=0.06, aspect=32, pad=0.03,
    )  # fmt: skip
    bar.set_label(colouring.label, fontsize=TEXT["labels"], color=INK)
    bar.ax.tick_params(labelsize=TEXT["ticks"], color=FRAME)
    bar.locator = MaxNLocator(_FLAT[1] if figure.get_figheight() < _FLAT[0] else _BAR_TICKS)
    bar.outline.set_edgecolor(FRAME)
    bar.update_ticks()
