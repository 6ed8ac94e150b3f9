"""Pictures of a case: grains and meshes, and a chart of what was measured."""

from __future__ import annotations

import logging
import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from liggghts_io.case.directory import load_setup, load_spec
from liggghts_io.case.results import load_result
from liggghts_io.errors import CaseError
from liggghts_io.experiments import experiment_named
from liggghts_io.experiments.heap import measure, measured_frames
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
        If the case is not intact or has no frames.
    """
    experiment = load_spec(directory).experiment
    picture_frame(directory, experiment)  # says in plain words what is missing
    target, temporary = directory / SCENE, directory / f".{os.getpid()}.{SCENE}"
    if not _draw_in_child(directory, temporary):
        _LOG.warning("VTK cannot draw here (no display, no software renderer): flat picture")
        _draw_flat(directory, experiment, temporary)
    os.replace(temporary, target)  # noqa: PTH105 - the atomic rename is the point
    return target


def _draw_in_child(directory: Path, target: Path) -> bool:
    """Draw with PyVista in a child process; say whether a picture came out."""
    package = str(Path(__file__).resolve().parents[2])
    paths = [package, os.environ.get("PYTHONPATH", "")]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(path for path in paths if path)}
    try:
        done = subprocess.run(
            [sys.executable, "-m", "liggghts_io.pictures.scene", str(directory.resolve()),
             str(target.resolve())],
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


def _draw_flat(directory: Path, experiment: str, target: Path) -> None:
    """Side view with circles, for machines on which VTK cannot draw."""
    from matplotlib.collections import EllipseCollection

    frame = picture_frame(directory, experiment)
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
    for triangles in drawn_meshes(directory).values():
        for corners in triangles:
            loop = np.vstack([corners, corners[:1]])
            axes.plot(loop[:, 0], loop[:, 2], color="steelblue", linewidth=0.6)
    axes.autoscale_view()
    axes.set(aspect="equal", xlabel="x (m)", ylabel="z (m)")
    figure.colorbar(circles, ax=axes, label="speed (m/s)")
    figure.savefig(target)


def chart_case(directory: Path) -> Path:
    """Draw what was measured: the fitted flanks, the mass-time curve or the box masses.

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
    experiment = load_spec(directory).experiment
    figure = _figure(6.4, 3.6)
    axes = figure.add_subplot()
    _CHARTS[experiment](directory, dict(result.observables), axes)
    axes.set_title(experiment_named(experiment).title)
    temporary = directory / f".{os.getpid()}.{CHART}"
    figure.savefig(temporary)
    os.replace(temporary, directory / CHART)  # noqa: PTH105 - the atomic rename is the point
    return directory / CHART


def _heap_chart(directory: Path, observables: dict[str, float], axes: Any) -> None:
    setup = load_setup(directory)
    repose = measure(measured_frames(directory, setup)[-1], setup)
    x, z = repose.outline.T * 1e3
    axes.fill_between(x, z, color="0.75", label="silhouette at the end of the pour")
    for line, angle in zip(repose.lines * 1e3, (repose.left_deg, repose.right_deg), strict=True):
        axes.plot(line[:, 0], line[:, 1], linewidth=2.5, label=f"flank {angle:.1f}°")
    axes.set(aspect="equal", xlabel="mm", ylabel="mm")
    mean = observables["angle_deg"]
    axes.legend(title=f"mean over the pour {mean:.1f}°", fontsize=8, loc="upper right")


def _conveyor_chart(directory: Path, observables: dict[str, float], axes: Any) -> None:
    rows = np.loadtxt(directory / "mass_time.csv", delimiter=",", skiprows=1)
    target = load_setup(directory).apparatus["target_mass_kg"] * 1e3
    axes.plot(rows[:, 0], rows[:, 1], linewidth=2.0)
    axes.plot(observables["t100_s"], target, "o", label=f"{observables['t100_s']:.2f} s")
    axes.axhline(target, color="0.6", linewidth=0.8, linestyle="--")
    axes.set(xlabel="time (s)", ylabel="mass on the scale (g)")
    axes.legend()


def _impact_chart(_directory: Path, observables: dict[str, float], axes: Any) -> None:
    names = [name.removesuffix("_g") for name in observables]
    bars = axes.bar(names, list(observables.values()))
    axes.bar_label(bars, fmt="%.2f")
    axes.set(ylabel="mass (g)", ylim=(0.0, 1.15 * max(observables.values())))


_CHARTS: Final = {
    "heap": _heap_chart,
    "conveyor": _conveyor_chart,
    "plate_impact": _impact_chart,
}
