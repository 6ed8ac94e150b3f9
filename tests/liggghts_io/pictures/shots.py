"""Frames of known grains, and shots of them."""

from __future__ import annotations

import numpy as np

from liggghts_io.measure.dumps import Frame
from liggghts_io.pictures.colouring import colouring_of
from liggghts_io.pictures.shot import Shot

PLATE = np.array(
    [
        [[-0.02, -0.02, 0.0], [0.02, -0.02, 0.0], [0.02, 0.02, 0.0]],
        [[-0.02, -0.02, 0.0], [0.02, 0.02, 0.0], [-0.02, 0.02, 0.0]],
    ]
)
"""Two triangles that make a level square [m]."""


def frame_of(*grains: tuple[float, float, float], step: int = 0, **columns: list[float]) -> Frame:
    """Return a frame with grains of radius 1 mm and type 1 at rest, or with other columns."""
    x, y, z = np.array(grains, dtype=float).reshape(-1, 3).T
    known = {name: np.zeros(len(x)) for name in ("vx", "vy", "vz")}
    known |= {"id": np.arange(len(x)) + 1.0, "type": np.ones(len(x)), "x": x, "y": y, "z": z}
    known |= {"radius": np.full(len(x), 1e-3)}
    return Frame(step, known | {name: np.array(values) for name, values in columns.items()})


def pile(count: int = 400, seed: int = 20191111) -> Frame:
    """Return grains in a cone of 15 mm on a plate, the upper ones faster."""
    rng = np.random.default_rng(seed)
    height = 0.015 * (1.0 - rng.random(count) ** (1 / 3))
    angle, part = 2.0 * np.pi * rng.random(count), np.sqrt(rng.random(count))
    reach = part * (0.015 - height)
    places = np.column_stack([reach * np.cos(angle), reach * np.sin(angle), height + 1e-3])
    return frame_of(*map(tuple, places), vz=list(-10.0 * height))


def shot_of(frame: Frame, by: str = "speed", title: str = "A pile") -> Shot:
    """Return a shot with the plate under the grains."""
    colouring = colouring_of([frame], by)
    return Shot(frame, colouring, {"plate": PLATE}, {"plate": 0.35}, title=title)
