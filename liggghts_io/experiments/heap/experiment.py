"""Angle of repose: grains poured on the plate under test."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from liggghts_io.errors import CaseError
from liggghts_io.experiments.base import Experiment
from liggghts_io.experiments.heap.observing import (
    FLANK,
    LEVELS,
    azimuths,
    has_walls,
    mean_of_flanks,
    measure,
    measured_frames,
    observe,
    pour_end,
)
from liggghts_io.experiments.heap.parameters import PARAMETERS
from liggghts_io.experiments.heap.pouring import build, write
from liggghts_io.experiments.numbers import Curve, Observable
from liggghts_io.experiments.setup import Setup
from liggghts_io.experiments.view import Notes, View
from liggghts_io.measure.dumps import Frame


def best_frame(setup: Setup) -> float:
    """Return the part of the run that is drawn: a slice's end of the pour, a cone at rest."""
    return pour_end(setup) if has_walls(setup) else 1.0


def notes(frame: Frame, setup: Setup, observables: Mapping[str, float]) -> Notes:
    """Return the flanks as they are fitted in one frame, with their angles."""
    known = observables.get("angle_deg")
    of_what = "over the later pour" if has_walls(setup) else "all round"
    title = "" if known is None else f"mean {of_what} {known:.1f}°"
    try:
        repose = measure(frame, setup)
    except CaseError:  # an early frame: no heap yet
        return Notes(title)
    here = f"in this picture {repose.angle_deg:.1f}°"
    labels = []
    for line, angle, side in zip(
        repose.lines, (repose.left_deg, repose.right_deg), (-1.0, 1.0), strict=True
    ):
        x, z = line.mean(axis=0)
        beside = side * 2.0 * setup.particle.d32_m
        labels.append((float(x + beside), float(z + abs(beside)), f"{angle:.1f}°"))
    return Notes(f"{here}, {title}" if title else here, tuple(repose.lines), tuple(labels))


def chart(folder: Path, setup: Setup, observables: Mapping[str, float], axes: Any) -> None:
    """Draw the silhouette of the last frame that is measured, with the fitted flanks."""
    views = [measure(measured_frames(folder, setup)[-1], setup, turn) for turn in azimuths(setup)]
    repose, mean = views[0], observables["angle_deg"]
    x, z = repose.outline.T * 1e3
    when = "end of the pour" if has_walls(setup) else "rest"
    axes.fill_between(x, z, color="0.75", label=f"silhouette at {when}")
    for line, angle in zip(repose.lines * 1e3, (repose.left_deg, repose.right_deg), strict=True):
        axes.plot(line[:, 0], line[:, 1], linewidth=2.5, label=f"flank {angle:.1f}°")
    axes.set(aspect="equal", xlabel="x (mm)", ylabel="height above the plate (mm)")
    title = f"mean over the pour {mean:.1f}°"
    if not has_walls(setup):
        title = f"{len(views)} views: {mean:.1f} ± {mean_of_flanks(views)[1]:.1f}°"
    # Below, where it covers neither a flank nor its line.
    axes.figure.legend(
        title=title, loc="outside lower center", ncols=3, frameon=False,
        columnspacing=1.0, handlelength=1.2,
    )  # fmt: skip


HEAP: Final = Experiment(
    name="heap",
    title="Angle of repose",
    caption="Heap for the angle of repose",
    parameters=PARAMETERS,
    observables=(
        Observable(
            "angle_deg",
            "deg",
            "mean slope of the flanks of the silhouette",
            high=90.0,
            part_of="flank",
        ),
    ),
    build=build,
    write=write,
    observe=observe,
    chart=chart,
    view=View(solid={"plate": 1.0}, at=best_frame, notes=notes),
    curves=(
        Curve(
            name="flank",
            unit="-",
            meaning="height of the flank over half the base, mean of all flanks measured",
            x_name="distance from the middle over half the base",
            x_unit="-",
            levels=LEVELS,
            file=FLANK,
            x_column="distance",
            y_column="height",
            high=10.0,
        ),
    ),
)
