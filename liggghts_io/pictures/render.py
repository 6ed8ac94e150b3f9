"""Pictures of a case: grains and meshes, and a chart of what was measured."""

from __future__ import annotations

import logging
import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from liggghts_io.case.directory import load_record, load_setup, load_spec, spec_of
from liggghts_io.case.lock import locked
from liggghts_io.case.output import drawable_run, find_run
from liggghts_io.case.results import load_result
from liggghts_io.errors import CaseError
from liggghts_io.experiments import View, experiment_named
from liggghts_io.pictures.scene import drawn_meshes, picture_frame

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SCENE: Final = "scene.png"
CHART: Final = "chart.png"
_TIMEOUT_S: Final = 180.0
_LOG: Final = logging.getLogger(__name__)


def render_case(directory: Path) -> Path:
    """Draw the grains of a case, coloured by speed, with its meshes.

    PyVista draws where VTK can; elsewhere matplotlib draws a side view, and a warning in the log
    of this package says so.

    Parameters
    ----------
    directory : Path
        A case that ran.

    Returns
    -------
    Path
        `scene.png` in the case directory.

    Raises
    ------
    CaseError
        If the case was not run, a file of the run was changed, or it has no frames.
    """
    record = load_record(directory)
    view = experiment_named(spec_of(record, directory).experiment).view
    with locked(directory):
        folder = drawable_run(directory, record["case_id"])
        picture_frame(folder, view)  # says in plain words what is missing
        target, temporary = directory / SCENE, directory / f".{os.getpid()}.{SCENE}"
        if not _draw_in_child(directory, folder, temporary):
            _LOG.warning("VTK cannot draw here (no display, no software renderer): flat picture")
            _draw_flat(folder, view, temporary)
        os.replace(temporary, target)  # noqa: PTH105 - the atomic rename is the point
    return target


def _draw_in_child(directory: Path, folder: Path, target: Path) -> bool:
    """Draw with PyVista in a child process; say whether a picture came out."""
    package = str(Path(__file__).resolve().parents[2])
    paths = [package, os.environ.get("PYTHONPATH", "")]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(path for path in paths if path)}
    try:
        done = subprocess.run(
            [sys.executable, "-m", "liggghts_io.pictures.scene", str(directory.resolve()),
             str(folder.resolve()), str(target.resolve())],
            stdin=subprocess.DEVNULL, capture_output=True, timeout=_TIMEOUT_S, check=False,
            env=environment,
        )  # fmt: skip
    except (subprocess.TimeoutExpired, OSError):
        return False
    return done.returncode == 0 and target.is_file()


def _figure(width: float, height: float) -> Figure:
    # Here, not on top: matplotlib takes a second to load, and most commands draw nothing.
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), dpi=120, layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def _draw_flat(folder: Path, view: View, target: Path) -> None:
    """Side view with circles, for machines on which VTK cannot draw."""
    from matplotlib.collections import EllipseCollection

    frame = picture_frame(folder, view)
    figure = _figure(9.0, 5.0)
    axes = figure.add_subplot()
    order = np.argsort(-frame.columns["y"])  # far grains first
    size = 2.0 * frame.columns["radius"][order]
    circles = EllipseCollection(
        size, size, np.zeros_like(size), units="xy", transOffset=axes.transData,
        offsets=frame.positions[order][:, [0, 2]], edgecolors="black", linewidths=0.2,
    )  # fmt: skip
    circles.set_array(frame.speeds[order])
    axes.add_collection(circles)
    for triangles in drawn_meshes(folder, view).values():
        for corners in triangles:
            loop = np.vstack([corners, corners[:1]])
            axes.plot(loop[:, 0], loop[:, 2], color="steelblue", linewidth=0.6)
    axes.autoscale_view()
    axes.set(aspect="equal", xlabel="x (m)", ylabel="z (m)")
    figure.colorbar(circles, ax=axes, label="speed (m/s)")
    figure.savefig(target)


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
        If the case failed or did not run.
    """
    result = load_result(directory)
    if result.status != "ok":
        msg = f"{directory}: the case failed ({result.reason}); there is nothing to draw"
        raise CaseError(msg)
    spec = load_spec(directory)
    experiment = experiment_named(spec.experiment)
    figure = _figure(6.4, 3.6)
    axes = figure.add_subplot()
    with locked(directory):
        folder, end = find_run(directory, result.case_id, spec.engine)
        if result.output != (end.digest if end else ""):
            msg = f"{directory}: the result is of another run than the output; use 'bulkcal post'"
            raise CaseError(msg)
        experiment.chart(folder, load_setup(directory), result.observables, axes)
        axes.set_title(experiment.title)
        temporary = directory / f".{os.getpid()}.{CHART}"
        figure.savefig(temporary)
        os.replace(temporary, directory / CHART)  # noqa: PTH105 - the atomic rename is the point
    return directory / CHART
