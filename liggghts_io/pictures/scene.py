"""Draw grains and meshes of a case with PyVista, off-screen; run as a program of its own.

`python -m liggghts_io.pictures.scene CASE FRAME PNG`. A child process, because VTK may abort the
whole process where neither a display nor a software renderer exists. Axes and words come later,
from matplotlib.
"""

from __future__ import annotations

import sys
from importlib import import_module
from pathlib import Path
from typing import Any, Final

import numpy as np

from liggghts_io.pictures.shot import Shot, shot_of
from liggghts_io.pictures.style import COLOURS, SOLID

_WIDTH: Final = 1600  # pixels
_MOST_PIXELS: Final = 4000


def draw(shot: Shot, target: Path) -> None:
    """Write a picture of a shot that fills its window to the border."""
    pyvista: Any = import_module("pyvista")  # slow to load, only needed in this process

    left, right, low, high = shot.window
    height = min(max(round(_WIDTH * (high - low) / (right - left)), 1), _MOST_PIXELS)
    plotter = pyvista.Plotter(off_screen=True, window_size=[_WIDTH, height])
    plotter.set_background("white")
    cloud = pyvista.PolyData(shot.frame.positions)
    cloud["speed"] = shot.frame.speeds
    cloud["size"] = 2.0 * shot.frame.columns["radius"]
    ball = pyvista.Sphere(radius=0.5, theta_resolution=20, phi_resolution=16)
    plotter.add_mesh(
        cloud.glyph(geom=ball, scale="size", orient=False),
        scalars="speed",
        cmap=COLOURS,
        clim=(0.0, shot.fastest),
        smooth_shading=True,
        show_scalar_bar=False,
    )
    for name, triangles in shot.meshes.items():
        corners = np.arange(3 * len(triangles)).reshape(-1, 3)
        faces = np.column_stack([np.full(len(triangles), 3), corners])
        surface = pyvista.PolyData(triangles.reshape(-1, 3), faces.ravel())
        plotter.add_mesh(surface, color=SOLID, opacity=shot.view.solid[name])
    middle = (0.5 * (left + right), 0.0, 0.5 * (low + high))
    distance = 10.0 * max(right - left, high - low)
    plotter.camera_position = [(middle[0], -distance, middle[2]), middle, (0.0, 0.0, 1.0)]
    plotter.camera.parallel_projection = True
    plotter.camera.parallel_scale = 0.5 * (high - low)
    plotter.reset_camera_clipping_range()
    plotter.screenshot(str(target))
    plotter.close()


if __name__ == "__main__":
    draw(shot_of(Path(sys.argv[1]), sys.argv[2]), Path(sys.argv[3]))
