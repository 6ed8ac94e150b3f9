"""Draw grains and meshes with PyVista, off-screen; a program of its own that knows no case.

`python scene.py SCENE.npz PICTURE.png`. A child process, because VTK may abort the whole process
where neither a display nor a software renderer exists. The picture has no border, axes or words:
matplotlib adds them.

Arrays of the file: `positions` (n, 3) and `diameters` (n,) of the grains [m], `colours` (n, 3)
uint8; `window`, left, right, bottom and top [m]; for each mesh `mesh_NAME`, triangles (m, 3, 3)
[m]; `opacities`, one for each mesh in this order, and `solid`, their colour (3,) from 0 to 1.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from importlib import import_module
from typing import Any, Final

import numpy as np

pyvista: Any = import_module("pyvista")  # its decorators mislead the type checker

_WIDTH: Final = 1600  # pixels
_MOST_PIXELS: Final = 4000
_SAMPLES: Final = 8  # per pixel, against steps at edges
_DISTANCE: Final = 10.0  # of the camera, in sizes of the window; a parallel view looks the same


def _grains(scene: Mapping[str, Any]) -> Any:
    """Return one sphere for every grain."""
    cloud = pyvista.PolyData(scene["positions"])
    cloud["diameters"], cloud["colours"] = scene["diameters"], scene["colours"]
    ball = pyvista.Sphere(radius=0.5, theta_resolution=20, phi_resolution=16)
    return cloud.glyph(geom=ball, scale="diameters", orient=False)


def _mesh(triangles: np.ndarray[Any, Any]) -> Any:
    corners = np.arange(3 * len(triangles)).reshape(-1, 3)
    faces = np.column_stack([np.full(len(triangles), 3), corners])
    return pyvista.PolyData(triangles.reshape(-1, 3), faces.ravel())


def draw(scene: Mapping[str, Any], target: str) -> None:
    """Write the picture of a scene, seen along y with x to the right and z up."""
    left, right, low, high = scene["window"]
    size = max(right - left, high - low)
    height = min(max(round(_WIDTH * (high - low) / (right - left)), 1), _MOST_PIXELS)
    plotter = pyvista.Plotter(off_screen=True, window_size=[_WIDTH, height])
    plotter.set_background("white")
    plotter.enable_anti_aliasing("msaa", multi_samples=_SAMPLES)
    plotter.add_mesh(_grains(scene), scalars="colours", rgb=True, smooth_shading=True)
    meshes = [scene[name] for name in scene if name.startswith("mesh_")]
    for triangles, opacity in zip(meshes, scene["opacities"], strict=True):
        plotter.add_mesh(_mesh(triangles), color=list(scene["solid"]), opacity=float(opacity))
    middle = 0.5 * (left + right), 0.0, 0.5 * (low + high)
    eye = middle[0], -_DISTANCE * size, middle[2]
    plotter.camera_position = [eye, middle, (0.0, 0.0, 1.0)]
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = 0.5 * (high - low)
    plotter.reset_camera_clipping_range()
    plotter.screenshot(target)
    plotter.close()


if __name__ == "__main__":
    with np.load(sys.argv[1]) as arrays:
        draw(dict(arrays), sys.argv[2])
