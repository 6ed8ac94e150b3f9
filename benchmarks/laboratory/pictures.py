"""How long a picture, a page and a frame of a film take, by the number of grains.

    python benchmarks/laboratory/pictures.py [--grains 1000 10000 100000]

A cone of grains on a plate is drawn from the side and from a corner, as a still, as the next frame
of a film, and as a page with a scene. Printed are processor seconds of this process and of the one
that draws, start of the drawing process included in the still and not in the next frame, and the
size of the page.
"""

from __future__ import annotations

import argparse
import resource
from collections.abc import Callable

import numpy as np

from liggghts_io.measure.dumps import Frame
from liggghts_io.pictures.camera import VIEWS, Camera
from liggghts_io.pictures.child import FILM, STILL, Studio
from liggghts_io.pictures.colouring import colouring_of
from liggghts_io.pictures.compose import composed
from liggghts_io.pictures.page import scene_of
from liggghts_io.pictures.shot import Shot

RADIUS_M = 5e-4
FILLED = 0.6  # of the cone's volume by grains
MB = 1e6


def cone(count: int) -> Shot:
    """Return grains in a cone as high as its base is wide in radius, on a plate."""
    rng = np.random.default_rng(20191111)
    size = (4.0 * count / FILLED) ** (1 / 3) * RADIUS_M
    height = size * (1.0 - rng.random(count) ** (1 / 3))
    angle, reach = 2.0 * np.pi * rng.random(count), np.sqrt(rng.random(count)) * (size - height)
    columns = {"x": reach * np.cos(angle), "y": reach * np.sin(angle), "z": height + RADIUS_M}
    columns |= dict(zip(("vx", "vy", "vz"), rng.normal(size=(3, count)), strict=True))
    frame = Frame(0, columns | {"radius": np.full(count, RADIUS_M)})
    corners = size * np.array(
        [[[-1, -1, 0], [1, -1, 0], [1, 1, 0]], [[-1, -1, 0], [1, 1, 0], [-1, 1, 0]]]
    )
    return Shot(frame, colouring_of([frame], "speed"), {"plate": corners}, {"plate": 0.35})


def draw(studio: Studio, shot: Shot, camera: Camera, width: int) -> None:
    """Draw a picture as far as its pixels."""
    grains = studio.picture(shot, camera, width)
    if grains is None:
        msg = "VTK cannot draw here"
        raise SystemExit(msg)
    composed(shot, camera, grains).canvas.draw()


def seconds() -> float:
    """Return the processor time of this process and of those that ended [s]."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(one.ru_utime + one.ru_stime for one in used)


def cost(work: Callable[[Studio], None]) -> float:
    """Return what work costs, the processes that it starts included [s]."""
    before = seconds()
    with Studio() as studio:
        work(studio)
    return seconds() - before


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--grains", type=int, nargs="+", default=[1000, 10_000, 100_000])
    asked = parser.parse_args()
    print("grains   view   still s   film s/frame   page s   page MB")
    for count in asked.grains:
        shot = cone(count)
        for view in ("side", "iso"):
            camera = VIEWS[view]
            still = cost(lambda studio, c=camera, s=shot: draw(studio, s, c, STILL))
            one = cost(lambda studio, c=camera, s=shot: draw(studio, s, c, FILM))
            three = cost(lambda studio, c=camera, s=shot: [draw(studio, s, c, FILM) for _ in "123"])
            before = seconds()
            size = len(scene_of(shot)) / MB
            page = seconds() - before
            print(
                f"{count:6d}   {view:4s}   {still:7.1f}   {(three - one) / 2:12.1f}"
                f"   {page:6.1f}   {size:7.2f}"
            )


if __name__ == "__main__":
    main()
