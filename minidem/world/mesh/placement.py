"""Where a script puts the triangles of a mesh."""

from __future__ import annotations

import numpy as np

from minidem.words import Words
from minidem.world.mesh.surface import turned
from minidem.world.state import Floats

__all__ = ["PLACEMENT", "placed"]

PLACEMENT = ("scale", "move", "rotate")
"""Keywords of a mesh that place its triangles, in the order in which they stand."""
_PI = 3.14159265  # as LIGGGHTS has it


def placed(nodes: Floats, key: str, words: Words) -> Floats:
    """Return triangles after ``scale S``, ``move X Y Z`` or ``rotate axis X Y Z angle DEG``."""
    placed: Floats
    if key == "scale":
        placed = nodes * words.number()
    elif key == "move":
        placed = nodes + np.array(words.numbers(3))
    else:
        words.need(6, "rotate axis AX AY AZ angle DEG")
        words.expect("axis")
        axis = words.numbers(3)
        words.expect("angle")
        placed = turned(nodes, axis, words.number() * _PI / 180.0)
    return placed
