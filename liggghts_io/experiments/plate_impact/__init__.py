"""Plate impact: grains fall through a pipe on a 45 degree plate and into four boxes or beside.

A part of the real mass is poured at the real flow rate; masses are scaled back to the real mass.
Grains leave the simulation below the boxes: they count where they pass the mouth of a box.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np

from liggghts_io.experiments.base import Experiment, bundled
from liggghts_io.experiments.numbers import Curve, Observable
from liggghts_io.experiments.plate_impact.observing import LANDING, masses_with, observe
from liggghts_io.experiments.plate_impact.parameters import PARAMETERS
from liggghts_io.experiments.plate_impact.rig import (
    BOXES,
    FLOW,
    POURED,
    box_edges,
    build,
    domain_bottom,
)
from liggghts_io.experiments.setup import Setup
from liggghts_io.experiments.view import Notes, View
from liggghts_io.measure.dumps import Frame

__all__ = ["PLATE_IMPACT", "masses_with"]

LEVELS_MM: Final = (40.0, 45.0, 50.0, 56.5, 62.0, 70.0, 76.0, 82.0, 90.5, 100.0, 110.0, 120.0)
"""Distances at which the landing distribution is compared; the far walls of the boxes are among
them."""

# In the picture [m]: room around it, the end of the pipe, and room for two lines below the boxes.
_MARGIN_M: Final = 0.008
_PIPE_SHOWN_M: Final = 0.03
_LABEL_ROOM_M: Final = 0.012


def _words(observable: str) -> str:
    """Return "box 1" for m1_g, "beside" for beside_g."""
    return observable.removesuffix("_g").replace("m", "box ", 1)


def chart(_folder: Path, _setup: Setup, observables: Mapping[str, float], axes: Any) -> None:
    """Draw the masses in and beside the boxes."""
    names = [_words(name) for name in observables]
    bars = axes.bar(names, list(observables.values()))
    axes.bar_label(bars, fmt="%.2f g")
    axes.set(ylabel="mass (g)", ylim=(0.0, 1.15 * max(observables.values())))


def window(setup: Setup) -> tuple[float, float, float, float]:
    """Return plate, boxes and the end of the pipe; grains fall straight in the rest of it."""
    a = setup.apparatus
    up = a["plate_up_m"] * np.sqrt(0.5)
    left = -max(up, a["pipe_radius_m"]) - _MARGIN_M
    top = a["plate_height_m"] + a["pipe_gap_m"] + _PIPE_SHOWN_M
    low = domain_bottom(setup) - _LABEL_ROOM_M
    return left, box_edges(setup, BOXES[-1])[1] + _MARGIN_M, low, top


def notes(_frame: Frame, setup: Setup, observables: Mapping[str, float]) -> Notes:
    """Return the number of each box, and the masses in and beside the boxes."""
    low = domain_bottom(setup) - 0.5 * _LABEL_ROOM_M
    labels = []
    for box in BOXES:
        mass = observables.get(f"m{box}_g")
        text = f"box {box}" if mass is None else f"box {box}\n{mass:.2f} g"
        labels.append((float(np.mean(box_edges(setup, box))), low, text))
    beside = observables.get("beside_g")
    title = "" if beside is None else f"masses at the end; {beside:.2f} g fell beside the boxes"
    return Notes(title, labels=tuple(labels))


PLATE_IMPACT: Final = Experiment(
    name="plate_impact",
    title="Plate impact",
    caption="Impact on an inclined plate",
    parameters=PARAMETERS,
    observables=(
        *(
            Observable(f"m{box}_g", "g", f"mass in box {box}", high=1e5, part_of="landing")
            for box in BOXES
        ),
        Observable("beside_g", "g", "mass that falls beside all boxes", high=1e5),
    ),
    build=build,
    write=bundled("plate_impact.in.j2"),
    observe=observe,
    chart=chart,
    view=View(
        solid={"plate": 1.0, "pipe": 0.25, "boxes": 0.35},
        at=lambda _setup: 0.45,
        window=window,
        notes=notes,
    ),
    needs=lambda _kind: (FLOW, POURED),
    curves=(
        Curve(
            name="landing",
            unit="g",
            meaning="mass that lands nearer to the pipe axis than a distance, as high as the boxes",
            x_name="distance from the pipe axis",
            x_unit="mm",
            levels=LEVELS_MM,
            file=LANDING,
            x_column="distance_mm",
            y_column="mass_g",
            high=1e5,
        ),
    ),
)
