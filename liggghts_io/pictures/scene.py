"""Draw grains and meshes with VTK, off-screen; a program of its own that knows no case.

`python scene.py SCENE.npz PICTURE.png`. A child process, because VTK may abort the whole process
where neither a display nor a software renderer exists; and one that loads nothing but VTK, because
that takes a third of the time. The picture has no border, axes or words: matplotlib adds them.

Arrays of the file: `positions` (n, 3) and `diameters` (n,) of the grains [m], `colours` (n, 3)
uint8; `window`, left, right, bottom and top [m]; for each mesh `mesh_NAME`, triangles (m, 3, 3)
[m]; `opacities`, one for each mesh in this order, and `solid`, their colour (3,) from 0 to 1.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Any, Final

import numpy as np
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 - brings the code that draws
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkGlyph3DMapper,
    vtkPolyDataMapper,
    vtkRenderer,
    vtkRenderWindow,
    vtkWindowToImageFilter,
)

_WIDTH: Final = 1600  # pixels
_MOST_PIXELS: Final = 4000
_SAMPLES: Final = 8  # per pixel, against steps at edges
_DISTANCE: Final = 10.0  # of the camera, in sizes of the window; a parallel view looks the same


def _points(positions: np.ndarray[Any, Any]) -> Any:
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(positions), deep=True))
    return points


def _grains(scene: Mapping[str, Any]) -> Any:
    """Return one shaded sphere for every grain."""
    data = vtkPolyData()
    data.SetPoints(_points(scene["positions"]))
    for name in ("diameters", "colours"):
        array = numpy_to_vtk(scene[name], deep=True)
        array.SetName(name)
        data.GetPointData().AddArray(array)
    data.GetPointData().SetActiveScalars("colours")
    ball = vtkSphereSource()
    ball.SetRadius(0.5)
    ball.SetThetaResolution(20)
    ball.SetPhiResolution(16)
    mapper = vtkGlyph3DMapper()
    mapper.SetInputData(data)
    mapper.SetSourceConnection(ball.GetOutputPort())
    mapper.SetScaleArray("diameters")
    mapper.SetScaleModeToScaleByMagnitude()
    mapper.SetScalarModeToUsePointData()
    actor = vtkActor()
    actor.SetMapper(mapper)
    return actor


def _mesh(triangles: np.ndarray[Any, Any], colour: np.ndarray[Any, Any], opacity: float) -> Any:
    cells = vtkCellArray()
    for first in range(0, 3 * len(triangles), 3):
        cells.InsertNextCell(3, (first, first + 1, first + 2))
    data = vtkPolyData()
    data.SetPoints(_points(triangles.reshape(-1, 3)))
    data.SetPolys(cells)
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*colour)
    actor.GetProperty().SetOpacity(opacity)
    return actor


def draw(scene: Mapping[str, Any], target: str) -> None:
    """Write the picture of a scene, seen along y with x to the right and z up."""
    left, right, low, high = scene["window"]
    renderer = vtkRenderer()
    renderer.SetBackground(1.0, 1.0, 1.0)
    renderer.AddActor(_grains(scene))
    meshes = [scene[name] for name in scene if name.startswith("mesh_")]
    for triangles, opacity in zip(meshes, scene["opacities"], strict=True):
        renderer.AddActor(_mesh(triangles, scene["solid"], float(opacity)))
    camera, size = renderer.GetActiveCamera(), max(right - left, high - low)
    middle = 0.5 * (left + right), 0.0, 0.5 * (low + high)
    camera.SetFocalPoint(*middle)
    camera.SetPosition(middle[0], -_DISTANCE * size, middle[2])
    camera.SetViewUp(0.0, 0.0, 1.0)
    camera.ParallelProjectionOn()
    camera.SetParallelScale(0.5 * (high - low))
    renderer.ResetCameraClippingRange()
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(_SAMPLES)
    height = min(max(round(_WIDTH * (high - low) / (right - left)), 1), _MOST_PIXELS)
    window.SetSize(_WIDTH, height)
    window.AddRenderer(renderer)
    window.Render()
    image = vtkWindowToImageFilter()
    image.SetInput(window)
    writer = vtkPNGWriter()
    writer.SetInputConnection(image.GetOutputPort())
    writer.SetFileName(target)
    writer.Write()


if __name__ == "__main__":
    with np.load(sys.argv[1]) as arrays:
        draw(dict(arrays), sys.argv[2])
