"""Pictures of a case: grains and meshes with what is measured on them, and a chart."""

from __future__ import annotations

import logging
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from liggghts_io.case.directory import load_record, load_setup, load_spec
from liggghts_io.case.lock import locked
from liggghts_io.case.output import drawable_run, find_run
from liggghts_io.case.results import load_result
from liggghts_io.case.spec import experiment_of
from liggghts_io.errors import CaseError
from liggghts_io.experiments import Notes
from liggghts_io.pictures.child import grains_of
from liggghts_io.pictures.shot import BEST, Shot, edge_on, shot_of
from liggghts_io.pictures.style import COLOURS, EDGE, FIT, INK, SOLID, WIDTH, sheet

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.figure import Figure

    from liggghts_io.case.lock import Tell
    from liggghts_io.case.results import CaseResult

SCENE: Final = "scene.png"
CHART: Final = "chart.png"
_MM: Final = 1e3
_HEIGHTS: Final = (2.8, 9.0)  # inches
_AROUND: Final = (0.9, 1.9)  # inches of words and bar beside and above the picture itself
_LOG: Final = logging.getLogger(__name__)


def render_case(directory: Path, frame: str = BEST, tell: Tell | None = None) -> Path:
    """Draw the grains of a case from the side, coloured by speed, with its meshes and notes.

    VTK draws the grains where it can; elsewhere matplotlib draws discs, which looks much the same.

    Parameters
    ----------
    directory : Path
        A case that ran.
    frame : str
        Which dump: "best" for the one that the experiment chooses, "first", "middle", "last" or a
        number that counts from 0.
    tell : callable, optional
        Receives a line when another process is waited for.

    Returns
    -------
    Path
        `scene.png` in the case directory.

    Raises
    ------
    CaseError
        If the case was not run, a file of the run was changed, or it has no such frame.
    """
    identity = load_record(directory)["case_id"]
    with locked(directory, tell):
        shot = shot_of(directory, drawable_run(directory, identity), frame)
        notes = shot.view.notes(shot.frame, shot.setup, _observables(directory))
        with grains_of(shot) as grains:
            if grains is None:
                _LOG.info("VTK cannot draw here (no display, no software renderer): discs")
            figure = _picture(shot, grains, notes)
        words = [_title(directory, shot), notes.title]
        figure.axes[0].set_title("\n".join(line for line in words if line), loc="left")
        return _save(figure, directory / SCENE)


def chart_case(directory: Path) -> Path:
    """Draw what was measured, as the experiment shows it.

    Parameters
    ----------
    directory : Path
        A case with the result "ok".

    Returns
    -------
    Path
        `chart.png` in the case directory.

    Raises
    ------
    CaseError
        If the case failed or did not run, or its output is not that of its result.
    """
    load_record(directory)  # before a lock file appears in a directory that holds no case
    with locked(directory):
        folder, result = _measured_run(directory)
        experiment = experiment_of(load_spec(directory))
        figure, axes = sheet(4.0)
        experiment.chart(folder, load_setup(directory), result.observables, axes)
        axes.set_title(experiment.title, loc="left")
        return _save(figure, directory / CHART)


def _measured_run(directory: Path) -> tuple[Path, CaseResult]:
    """Return the run of a case and the numbers that were measured on it."""
    result = load_result(directory)
    if result.status != "ok":
        msg = f"{directory}: the case failed ({result.reason}); there is nothing to draw"
        raise CaseError(msg)
    folder, end = find_run(directory, result.case_id, load_spec(directory).engine)
    if result.output != (end.digest if end else ""):
        msg = f"{directory}: the result is of another run than the output; use 'bulkcal post'"
        raise CaseError(msg)
    return folder, result


def _observables(directory: Path) -> Mapping[str, float]:
    try:
        return _measured_run(directory)[1].observables
    except CaseError:  # drawn all the same: a run that failed is looked at first of all
        return {}


def _title(directory: Path, shot: Shot) -> str:
    spec = load_spec(directory)
    title = experiment_of(spec).title
    return (
        f"{title}: {spec.particle.name} on a {spec.kind} wall, frame {shot.number} of {shot.last}"
    )


def _picture(shot: Shot, grains: Path | None, notes: Notes) -> Figure:
    """Return the picture of the grains, or discs, with axes, colour bar and notes."""
    left, right, low, high = (_MM * edge for edge in shot.window)
    height = (WIDTH - _AROUND[0]) * (high - low) / (right - left) + _AROUND[1]
    figure, axes = sheet(min(max(height, _HEIGHTS[0]), _HEIGHTS[1]))
    if grains is None:
        _discs(axes, shot)
    else:
        from matplotlib.image import imread

        axes.imshow(imread(grains), extent=(left, right, low, high), interpolation="antialiased")
    _edges(axes, shot)
    _write(axes, notes)
    axes.set(aspect="equal", xlim=(left, right), ylim=(low, high), xlabel="x (mm)", ylabel="z (mm)")
    _speeds(figure, axes, shot)
    return figure


def _discs(axes: Any, shot: Shot) -> None:
    """Draw grains as discs, far ones first, for machines on which VTK cannot draw."""
    from matplotlib.collections import EllipseCollection, PolyCollection

    order = np.argsort(-shot.frame.columns["y"])
    size = 2.0 * _MM * shot.frame.columns["radius"][order]
    discs = EllipseCollection(
        size, size, np.zeros_like(size), units="xy", transOffset=axes.transData, cmap=COLOURS,
        offsets=_MM * shot.frame.positions[order][:, [0, 2]], edgecolors="black", linewidths=0.2,
    )  # fmt: skip
    discs.set_array(shot.frame.speeds[order])
    discs.set_clim(0.0, shot.fastest)
    axes.add_collection(discs)
    for name, triangles in shot.meshes.items():
        faces = PolyCollection(
            list(_MM * triangles[:, :, [0, 2]]), facecolors=SOLID, alpha=shot.view.solid[name]
        )
        axes.add_collection(faces)


def _edges(axes: Any, shot: Shot) -> None:
    """Draw what has no thickness from the side, as a level plate."""
    from matplotlib.collections import LineCollection

    for triangles in shot.meshes.values():
        lines = list(_MM * triangles[edge_on(triangles)][:, :, [0, 2]])
        axes.add_collection(LineCollection(lines, colors=EDGE, linewidths=2.0))


def _write(axes: Any, notes: Notes) -> None:
    for line in notes.lines:
        x, z = _MM * line.T
        axes.plot(x, z, color="white", linewidth=4.5, solid_capstyle="round")
        axes.plot(x, z, color=FIT, linewidth=2.5, solid_capstyle="round")
    for x, z, text in notes.labels:
        axes.text(_MM * x, _MM * z, text, ha="center", va="center", fontsize=11, color=INK)


def _speeds(figure: Figure, axes: Any, shot: Shot) -> None:
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    bar = figure.colorbar(
        ScalarMappable(Normalize(0.0, shot.fastest), COLOURS),
        ax=axes, orientation="horizontal", shrink=0.6, aspect=40, label="speed (m/s)",
    )  # fmt: skip
    bar.ax.tick_params(labelsize=9)


def _save(figure: Figure, target: Path) -> Path:
    """Write a figure under a temporary name, then rename it."""
    temporary = target.with_name(f".{os.getpid()}.{target.name}")
    try:
        figure.savefig(temporary)
        os.replace(temporary, target)  # noqa: PTH105 - the atomic rename is the point
    finally:
        temporary.unlink(missing_ok=True)
    return target
