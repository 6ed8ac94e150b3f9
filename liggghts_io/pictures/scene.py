"""Draw grains and meshes with VTK, off-screen; a program of its own that knows no case.

A child process, because VTK may abort the whole process where neither a display nor a software
renderer exists. Each line of its input is the path of a scene, a tab and the path of what is to be
made of it; it answers with a line, empty when that is done.

A scene is an `.npz` file: `positions` (n, 3) and `radii` (n,) of the grains [m], `colours` (n, 3)
uint8; the camera, `right` and `up` (3,), and `window`, left, right, bottom and top along these [m];
for each mesh `mesh_NAME`, triangles (m, 3, 3) [m]; `opacities`, one for each mesh in this order;
`solid` and `edge`, colours (3,) of meshes and their edges from 0 to 1; `width` in pixels.

What is made is a `.png` without border, axes or words.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from importlib import import_module
from typing import Any, Final

import numpy as np

pyvista: Any = import_module("pyvista")  # its decorators mislead the type checker

_MOST_PIXELS: Final = 3200  # from top to bottom
_DISTANCE: Final = 10.0  # of the camera, in sizes of the scene; a parallel view looks the same
_EDGE_DEG: Final = 30.0  # between two triangles that meet in an edge that is drawn
_EDGE_WIDTH: Final = 1.0 / 800.0  # of the picture


def _camera(plotter: Any, scene: Mapping[str, Any]) -> None:
    """Place the camera far away, in a parallel projection."""
    left, right, low, high = scene["window"]
    toward = np.cross(scene["right"], scene["up"])
    corners = [scene[name].reshape(-1, 3) for name in scene if name.startswith("mesh_")]
    depths = np.concatenate([scene["positions"], *corners]) @ toward
    near, far = (float(depths.max()), float(depths.min())) if len(depths) else (0.0, 0.0)
    depth, size = (near + far) / 2, max(right - left, high - low, near - far)
    middle = scene["right"] * (left + right) / 2 + scene["up"] * (low + high) / 2 + toward * depth
    plotter.camera_position = [middle + _DISTANCE * size * toward, middle, scene["up"]]
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = 0.5 * (high - low)
    plotter.reset_camera_clipping_range()


def _meshes(plotter: Any, scene: Mapping[str, Any]) -> None:
    """Add the meshes with their edges."""
    names = [name for name in scene if name.startswith("mesh_")]
    for name, opacity in zip(names, scene["opacities"], strict=True):
        triangles = scene[name]
        corners = np.arange(3 * len(triangles)).reshape(-1, 3)
        faces = np.column_stack([np.full(len(triangles), 3), corners])
        mesh = pyvista.PolyData(triangles.reshape(-1, 3), faces.ravel()).clean()
        plotter.add_mesh(mesh, color=list(scene["solid"]), opacity=float(opacity))
        lines = mesh.extract_feature_edges(feature_angle=_EDGE_DEG)
        if lines.n_cells:
            width = max(float(scene["width"]) * _EDGE_WIDTH, 1.0)
            plotter.add_mesh(lines, color=list(scene["edge"]), line_width=width)


def _spheres(scene: Mapping[str, Any]) -> Any:
    """Return the grains as spheres that are traced in every pixel: no facets, a fifth of the time.

    The mapper of VTK draws a square for each grain; as triangles, 100 000 grains take 30 s.
    """
    mapper = import_module("vtkmodules.vtkRenderingOpenGL2").vtkOpenGLSphereMapper()
    cloud = pyvista.PolyData(scene["positions"])
    cloud["radii"], cloud["colours"] = scene["radii"].astype(np.float32), scene["colours"]
    mapper.SetInputData(cloud)
    mapper.SetScaleArray("radii")
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("colours")
    mapper.SetColorModeToDirectScalars()
    actor = import_module("vtkmodules.vtkRenderingCore").vtkActor()
    actor.SetMapper(mapper)
    return actor


def draw(scene: Mapping[str, Any], target: str) -> None:
    """Write the picture of a scene."""
    left, right, low, high = scene["window"]
    # A high picture is made narrower as well: one that is cut in height would be squeezed.
    width = min(int(scene["width"]), round(_MOST_PIXELS * (right - left) / (high - low)))
    height = max(round(width * (high - low) / (right - left)), 1)
    plotter = pyvista.Plotter(off_screen=True, window_size=[max(width, 1), height])
    plotter.set_background("white")
    if len(scene["positions"]):
        plotter.add_actor(_spheres(scene))
    _meshes(plotter, scene)
    _camera(plotter, scene)
    plotter.screenshot(target)
    plotter.close()


def main() -> None:
    """Draw what each line of the input asks for."""
    for line in sys.stdin:
        source, target = line.rstrip("\n").split("\t")
        answer = ""
        try:
            with np.load(source) as arrays:
                scene = dict(arrays)
            draw(scene, target)
        except Exception as err:  # whatever it is, the other process goes on without a picture
            answer = " ".join(f"{type(err).__name__}: {err}".split())
        sys.stdout.write(f"{answer}\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
