"""Draw grains and meshes of a case with PyVista, off-screen; run as a program of its own.

`python -m liggghts_io.pictures.scene CASE RUN PNG`. A child process, because VTK may abort the
whole process where neither a display nor a software renderer exists.
"""

from __future__ import annotations

import sys
from importlib import import_module
from pathlib import Path
from typing import Any, Final

import numpy as np

from liggghts_io.case.directory import MESHES, load_spec
from liggghts_io.errors import CaseError
from liggghts_io.experiments import View, experiment_named
from liggghts_io.measure.dumps import POST, Frame, frame_paths, read_frame
from liggghts_io.stl import read_stl

WINDOW: Final = (1200, 800)


def picture_frame(folder: Path, view: View) -> Frame:
    """Return the frame of a run that a view shows, or the nearest with a grain in it.

    Raises
    ------
    CaseError
        If the engine wrote no frame with a grain in it.
    """
    paths = frame_paths(folder)
    if not paths:
        msg = f"{folder / POST}: no frame_*.dump; the run ended before the first one"
        raise CaseError(msg)
    start = round(view.at * (len(paths) - 1))
    for path in [*paths[start:], *reversed(paths[:start])]:
        frame = read_frame(path)
        if frame.count:
            return frame
    msg = f"{folder / POST}: no frame holds a grain"
    raise CaseError(msg)


def drawn_meshes(folder: Path, view: View) -> dict[str, np.ndarray[Any, np.dtype[np.float64]]]:
    """Return the solid meshes of a run by name, triangles of shape (n, 3, 3) [m]."""
    paths = sorted((folder / MESHES).glob("*.stl"))
    return {path.stem: read_stl(path) for path in paths if path.stem in view.solid}


def draw(directory: Path, folder: Path, target: Path) -> None:
    """Write the picture of a case whose run lies in `folder`."""
    pyvista: Any = import_module("pyvista")  # slow to load, only needed in this process

    view = experiment_named(load_spec(directory).experiment).view
    frame = picture_frame(folder, view)
    plotter = pyvista.Plotter(off_screen=True, window_size=list(WINDOW))
    plotter.set_background("white")
    cloud = pyvista.PolyData(frame.positions)
    cloud["speed (m/s)"] = frame.speeds
    cloud["size"] = 2.0 * frame.columns["radius"]
    ball = pyvista.Sphere(radius=0.5, theta_resolution=16, phi_resolution=12)
    grains = cloud.glyph(geom=ball, scale="size", orient=False)
    plotter.add_mesh(
        grains,
        scalars="speed (m/s)",
        cmap="viridis",
        clim=(0.0, max(float(frame.speeds.max()), 1e-3)),
        smooth_shading=True,
        scalar_bar_args={"color": "black", "title": "speed (m/s)"},
    )
    for name, triangles in drawn_meshes(folder, view).items():
        faces = np.column_stack(
            [np.full(len(triangles), 3), np.arange(3 * len(triangles)).reshape(-1, 3)]
        )
        surface = pyvista.PolyData(triangles.reshape(-1, 3), faces.ravel())
        plotter.add_mesh(surface, color="lightsteelblue", opacity=view.solid[name])
    plotter.view_vector(view.direction, viewup=(0.0, 0.0, 1.0))
    plotter.camera.zoom(view.zoom)
    plotter.screenshot(str(target))
    plotter.close()


if __name__ == "__main__":
    draw(Path(sys.argv[1]), Path(sys.argv[2]), Path(sys.argv[3]))
