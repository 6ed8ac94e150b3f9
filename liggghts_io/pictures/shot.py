"""What a picture of a case shows: one dump, the solid meshes, and the window around them.

Every picture is taken from the side with a parallel projection, x to the right and z up, so that
lengths and angles in it are those of the apparatus.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from liggghts_io.case.directory import load_setup, load_spec
from liggghts_io.case.spec import experiment_of
from liggghts_io.errors import CaseError
from liggghts_io.experiments import Setup, View
from liggghts_io.measure.dumps import POST, SCRIPT, Frame, frame_paths, read_frame
from liggghts_io.pictures.placed import placed_meshes

FloatArray = npt.NDArray[np.float64]

BEST: Final = "best"
_MARGIN: Final = 0.03  # room around everything, as a part of its size
_LEAST_SPEED: Final = 1e-3  # m/s, so that grains at rest do not stretch the colours over rounding


@dataclass(frozen=True)
class Shot:
    """What a picture shows.

    Attributes
    ----------
    view : View
    setup : Setup
    frame : Frame
    number, last : int
        Which dump of the run it is, and the number of the last one; both count from 0.
    meshes : dict of str to (n, 3, 3) float64
        Triangles of the solid meshes [m].
    window : (float, float, float, float)
        Left, right, bottom and top [m].
    """

    view: View
    setup: Setup
    frame: Frame
    number: int
    last: int
    meshes: dict[str, FloatArray]
    window: tuple[float, float, float, float]

    @property
    def fastest(self) -> float:
        """Speed at the upper end of the colours [m/s]."""
        left, right, low, high = self.window
        x, z = self.frame.columns["x"], self.frame.columns["z"]
        seen = (x >= left) & (x <= right) & (z >= low) & (z <= high)
        return max(float(self.frame.speeds[seen].max(initial=0.0)), _LEAST_SPEED)


def shot_of(directory: Path, folder: Path, frame: str = BEST) -> Shot:
    """Read what a picture of a case shows.

    Parameters
    ----------
    directory : Path
        A case that ran.
    folder : Path
        Where its run lies.
    frame : str
        "best" (the one of the experiment's view, or the nearest with a grain in it), "first",
        "middle", "last" or a number that counts from 0.

    Raises
    ------
    CaseError
        If the case is not intact, has no such frame, or its frame or meshes cannot be drawn.
    """
    setup = load_setup(directory)
    view = experiment_of(load_spec(directory)).view
    paths = frame_paths(folder)
    if not paths:
        msg = f"{folder / POST}: no frame_*.dump; the run ended before the first one"
        raise CaseError(msg)
    number, seen = _frame(paths, view.at(setup), frame)
    meshes = _meshes(folder, view)
    window = view.window(setup) if view.window else _around(seen, meshes)
    return Shot(view, setup, seen, number, len(paths) - 1, meshes, window)


def _frame(paths: list[Path], at: float, word: str) -> tuple[int, Frame]:
    """Return number and content of the frame that `word` asks for."""
    last = len(paths) - 1
    places = {"first": 0, "middle": last // 2, "last": last}
    if word == BEST:
        return _with_a_grain(paths, int(at * last + 1e-9))
    if word.isdecimal():
        number = int(word) if len(word) < 10 else last + 1
    elif word in places:
        number = places[word]
    else:
        msg = f"frame '{word}': write best, first, middle, last or a number from 0 to {last}"
        raise CaseError(msg)
    if number > last:
        msg = f"frame {word}: the run wrote frames 0 to {last}"
        raise CaseError(msg)
    found = read_frame(paths[number])
    if not found.count:
        msg = f"{paths[number]}: no grain in this frame; draw another (--frame)"
        raise CaseError(msg)
    return number, found


def _with_a_grain(paths: list[Path], start: int) -> tuple[int, Frame]:
    for number in [*range(start, len(paths)), *reversed(range(start))]:
        frame = read_frame(paths[number])
        if frame.count:
            return number, frame
    msg = f"{paths[0].parent}: no frame holds a grain"
    raise CaseError(msg)


def _meshes(folder: Path, view: View) -> dict[str, FloatArray]:
    found: dict[str, FloatArray] = {}
    for name, triangles in placed_meshes(folder / SCRIPT):
        if name in view.solid:
            there = [found[name]] if name in found else []
            found[name] = np.concatenate([*there, triangles])
    return found


def _around(frame: Frame, meshes: dict[str, FloatArray]) -> tuple[float, float, float, float]:
    """Return the smallest window that holds all grains and meshes, with a margin."""
    radius = frame.columns["radius"][:, None]
    middles = frame.positions[:, [0, 2]]
    corners = [triangles.reshape(-1, 3)[:, [0, 2]] for triangles in meshes.values()]
    points: FloatArray = np.vstack([middles - radius, middles + radius, *corners])
    low, high = points.min(axis=0), points.max(axis=0)
    margin = _MARGIN * float((high - low).max())
    left, bottom = (low - margin).tolist()
    right, top = (high + margin).tolist()
    return left, right, bottom, top


def edge_on(triangles: FloatArray) -> Any:
    """Return which triangles (n, 3, 3) are seen as a line from the side, shape (n,) bool."""
    a, b, c = (triangles[:, k][:, [0, 2]] for k in range(3))
    one, other = b - a, c - a
    area = np.abs(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0])
    size = np.ptp(triangles, axis=1).max(axis=1)
    return area <= 1e-6 * size**2
