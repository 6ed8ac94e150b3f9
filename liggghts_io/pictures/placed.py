"""Where a script puts its meshes: scaled, moved and turned in the order of its words."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from liggghts_io.measure.script_reader import ScriptReader
from liggghts_io.measure.script_text import logical_lines, words_of
from liggghts_io.stl import read_stl

FloatArray = npt.NDArray[np.float64]
_STYLE: Final = "mesh/surface"


def placed_meshes(script: Path) -> Iterator[tuple[str, FloatArray]]:
    """Yield name (that of the file) and triangles (n, 3, 3) of every mesh of a script [m].

    A mesh that moves is given where it starts, and one whose place the text does not tell as its
    file has it.
    """
    reader = ScriptReader()
    for _, line in logical_lines(script.read_bytes().decode("utf-8", errors="replace")):
        words = words_of(line)
        reader.read(words)
        if words[:1] == ["fix"] and words[3:4] and words[3].startswith(_STYLE) and "file" in words:
            path = script.parent / words[words.index("file") + 1]
            yield path.stem, _placed(read_stl(path), words[words.index("file") + 2 :], reader)


def _placed(triangles: FloatArray, words: list[str], reader: ScriptReader) -> FloatArray:
    points = triangles
    for k, word in enumerate(words):
        if word not in _MOVES:
            continue
        count, move = _MOVES[word]
        numbers = [reader.value(one) for one in words[k + 1 : k + 1 + count] if one not in _WORDS]
        if None in numbers:
            return triangles
        points = move(points, [float(one or 0.0) for one in numbers])
    return points


def _turned(points: FloatArray, numbers: list[float]) -> FloatArray:
    """Turn about an axis through the origin (Rodrigues)."""
    axis = np.array(numbers[:3]) / np.linalg.norm(numbers[:3])
    angle = math.radians(numbers[3])
    along = (points @ axis)[..., None] * axis
    across = np.cross(axis, points)
    turned = points * math.cos(angle) + across * math.sin(angle) + along * (1.0 - math.cos(angle))
    return np.asarray(turned, dtype=np.float64)


_WORDS: Final = ("axis", "angle")
_MOVES: Final[dict[str, tuple[int, Callable[[FloatArray, list[float]], FloatArray]]]] = {
    "scale": (1, lambda points, numbers: np.asarray(points * numbers[0])),
    "move": (3, lambda points, numbers: np.asarray(points + np.array(numbers))),
    "rotate": (6, _turned),
}
