"""``dump custom/vtk``: how columns become the fields of a VTK file."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from minidem.output.text.polydata import HEAD, VERTICES, PolyData, legacy_file, numbers

__all__ = [
    "bounding_box_file",
    "bounding_box_name",
    "particle_data",
    "particle_file",
    "vtk_fields",
]

# LIGGGHTS writes known properties in the order of an internal list, whatever the order in the
# script; computes, fixes and variables follow in the script's order.
_ORDER: Final = (
    *("id", "mol", "type", "element", "mass", "x", "y", "z", "xs", "ys", "zs", "xu", "yu", "zu"),
    *("ix", "iy", "iz", "vx", "vy", "vz", "fx", "fy", "fz", "radius", "diameter"),
    *("omegax", "omegay", "omegaz", "tqx", "tqy", "tqz", "density"),
)
_TRIPLES: Final[dict[tuple[str, ...], str]] = {
    ("ix", "iy", "iz"): "i",
    ("vx", "vy", "vz"): "v",
    ("fx", "fy", "fz"): "f",
    ("omegax", "omegay", "omegaz"): "omega",
    ("tqx", "tqy", "tqz"): "tq",
    ("xs", "ys", "zs"): "xs",
    ("xu", "yu", "zu"): "xu",
}
_POINT: Final = ("x", "y", "z")


def vtk_fields(names: Sequence[str]) -> list[tuple[str, tuple[str, ...]]]:
    """Arrange the columns of a dump command as VTK fields.

    Parameters
    ----------
    names : sequence of str
        Columns as the script names them; ``x y z`` are the points and no field.

    Returns
    -------
    list of (str, tuple of str)
        Name of each field and the columns that are its components, in the order of the file.

    Examples
    --------
    >>> vtk_fields(["x", "y", "z", "vx", "vy", "vz", "id"])
    [('id', ('id',)), ('v', ('vx', 'vy', 'vz'))]
    """
    known = [name for name in _ORDER if name in names and name not in _POINT]
    others = [name for name in dict.fromkeys(names) if name not in _ORDER]
    fields: list[tuple[str, tuple[str, ...]]] = []
    for group in (known, others):
        at = 0
        while at < len(group):
            three = tuple(group[at : at + 3])
            name = _TRIPLES.get(three) or _indexed_triple(three)
            fields.append((name, three) if name else (_plain(group[at]), (group[at],)))
            at += 3 if name else 1
    return fields


def _plain(name: str) -> str:
    """Return the name of a field of one column: variables lose their prefix."""
    return name[2:] if name.startswith("v_") else name


def _indexed_triple(names: tuple[str, ...]) -> str:
    """Return ``c_ID[i-k]`` for three columns of one compute or fix with following indices."""
    if len(names) < 3 or not all(name.endswith("]") for name in names):
        return ""
    stems = [name[:-1].split("[") for name in names]
    if any(len(stem) != 2 or not stem[1].isdigit() for stem in stems):
        return ""
    first = int(stems[0][1])
    same = all(stem[0] == stems[0][0] for stem in stems)
    if not same or [int(stem[1]) for stem in stems] != [first, first + 1, first + 2]:
        return ""
    return f"{stems[0][0]}[{first}-{first + 2}]"


def particle_data(columns: Sequence[tuple[str, NDArray[Any]]]) -> PolyData:
    """Return particles as points with fields.

    Parameters
    ----------
    columns : sequence of (str, (N,) ndarray)
        Names and values, ``x y z`` among them.
    """
    values = dict(columns)
    fields = vtk_fields([name for name, _ in columns])
    points = np.stack([values[name] for name in _POINT], axis=1)
    arrays = [
        (
            name,
            np.stack([values[part] for part in parts], axis=1)
            if len(parts) > 1
            else values[parts[0]],
        )
        for name, parts in fields
    ]
    return PolyData(points, VERTICES, arrays)


def particle_file(columns: Sequence[tuple[str, NDArray[Any]]]) -> str:
    """Return the particles as a legacy VTK file.

    Parameters
    ----------
    columns : sequence of (str, (N,) ndarray)
        Names and values, ``x y z`` among them; integer arrays become int fields, others double.

    Returns
    -------
    str
        The file, byte for byte as LIGGGHTS 3.8.0 with VTK 9.1 writes it.
    """
    return legacy_file(particle_data(columns))


def bounding_box_name(pattern: str) -> str:
    """Return the pattern of the file with the simulation box that goes with a dump.

    Examples
    --------
    >>> bounding_box_name("post/d_*.vtk")
    'post/d_boundingBox_*.vtk'
    >>> bounding_box_name("d.vtk")
    'd_boundingBox.vtk'
    """
    if "*" in pattern:
        return pattern.replace("*", "boundingBox_*", 1)
    stem, dot, end = pattern.rpartition(".")
    return f"{stem}_boundingBox{dot}{end}" if dot else f"{pattern}_boundingBox"


def bounding_box_file(box: NDArray[np.float64]) -> str:
    """Return the simulation box (2, 3) as a legacy VTK rectilinear grid."""
    parts = [f"{HEAD}RECTILINEAR_GRID\nDIMENSIONS 2 2 2\n"]
    for d, axis in enumerate("XYZ"):
        parts += [f"{axis}_COORDINATES 2 double\n", numbers(np.ascontiguousarray(box[:, d]))]
    return "".join(parts)
