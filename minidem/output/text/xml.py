"""Points with cells as XML files of VTK, ASCII: shortest digits that give the same number back."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from minidem.output.text.polydata import LINES, POLYGONS, VERTICES, Field, PolyData

__all__ = ["box_file", "parts_file", "polydata_file", "shortest", "unstructured_file"]

_PER_LINE: Final = 6
_TYPES: Final = {"i": "Int32", "u": "UInt8", "f": "Float32", "d": "Float64", "q": "Int64"}
_NOTHING: Final = (1.0e299, -1.0e299)  # range of no values
_FIXED: Final = (-7, 21)  # exponents between these are written without
_CELLS: Final = (("Verts", VERTICES), ("Lines", LINES), ("Strips", ""), ("Polys", POLYGONS))
_VTK_TYPE: Final = {VERTICES: 1, LINES: 3, POLYGONS: 5}


def shortest(value: float) -> str:
    """Return the fewest digits that give a number back, without exponent unless it is far from 0.

    Examples
    --------
    >>> [shortest(x) for x in (0.5, 3.0, 6.25e-6, 5e-8, 1e21)]
    ['0.5', '3', '0.00000625', '5e-8', '1e+21']
    """
    if value == 0.0 or not isfinite(value):
        return {"inf": "Infinity", "-inf": "-Infinity", "nan": "NaN"}.get(str(value), "0")
    digits, _, exponent = repr(value).partition("e")
    power = int(exponent or 0)
    digits = digits.removesuffix(".0")
    if not _FIXED[0] < power < _FIXED[1]:
        return f"{digits}e{power:+d}" if power > 0 else f"{digits}e{power}"
    if not power:
        return digits
    places = len(digits.lstrip("-").replace(".", "")) - 1 - power
    return f"{value:.{max(places, 0)}f}"


def polydata_file(data: PolyData) -> str:
    """Return points and cells as a .vtp file, as VTK 9.1 writes it."""
    count = len(data.points)
    cells = data.amount
    counts = " ".join(
        f'NumberOf{name}="{cells if kind == data.cells else 0}"' for name, kind in _CELLS
    )
    lines = [
        *_head("PolyData"),
        f'    <Piece NumberOfPoints="{count}" {counts}>',
        *_values(data),
    ]
    for name, kind in _CELLS:
        own = data if kind == data.cells else PolyData(np.zeros((0, 3)), VERTICES)
        lines += [f"      <{name}>", *_topology(own), f"      </{name}>"]
    return "\n".join([*lines, *_tail("PolyData")])


def unstructured_file(data: PolyData) -> str:
    """Return points and cells as a .vtu file, as VTK 9.1 writes it."""
    count = len(data.points)
    cells = data.amount
    types = np.full(cells, _VTK_TYPE[data.cells], np.uint8)
    return "\n".join(
        [
            *_head("UnstructuredGrid"),
            f'    <Piece NumberOfPoints="{count}" NumberOfCells="{cells}">',
            *_values(data),
            "      <Cells>",
            *_topology(data),
            *_array("types", types, "u"),
            "      </Cells>",
            *_tail("UnstructuredGrid"),
        ]
    )


def parts_file(data: PolyData, kind: str, part: str) -> str:
    """Return the .pvtp or .pvtu file of one part.

    Parameters
    ----------
    data : PolyData
        What is in the part.
    kind : str
        ``PolyData`` or ``UnstructuredGrid``.
    part : str
        Name of its file, in the same folder.
    """
    fields = [(name, values, _kind(values)) for name, values in data.point_data]
    return "\n".join(
        [
            *_head(f"P{kind}", ' GhostLevel="0"'),
            "    <PPointData>",
            *(f"      <{_named('PDataArray', *one)}/>" for one in fields),
            "    </PPointData>",
            "    <PPoints>",
            f"      <{_named('PDataArray', 'Points', data.points, 'f')}/>",
            "    </PPoints>",
            *([f'    <Piece Source="{part}"/>'] if len(data.points) else ()),
            f"  </P{kind}>", "</VTKFile>", "",
        ]
    )  # fmt: skip


def box_file(box: NDArray[np.float64]) -> str:
    """Return the simulation box (2, 3) as a .vtr file."""
    lines = [
        *_head("RectilinearGrid", ' WholeExtent="0 1 0 1 0 1"'),
        '  <Piece Extent="0 1 0 1 0 1">',
        *(f"    {tag}" for tag in ("<PointData>", "</PointData>", "<CellData>", "</CellData>")),
        "    <Coordinates>",
    ]
    for d, axis in enumerate("xyz"):
        lines += [line.removeprefix("  ") for line in _array(axis, box[:, d], "d")]
    return "\n".join(
        [*lines, "    </Coordinates>", "  </Piece>", "  </RectilinearGrid>", "</VTKFile>", ""]
    )


def _head(kind: str, extent: str = "") -> list[str]:
    return [
        '<?xml version="1.0"?>',
        f'<VTKFile type="{kind}" version="0.1" byte_order="LittleEndian" header_type="UInt32">',
        f"  <{kind}{extent}>",
    ]


def _tail(kind: str) -> list[str]:
    return ["    </Piece>", f"  </{kind}>", "</VTKFile>", ""]


def _values(data: PolyData) -> list[str]:
    """Return the lines of point data, cell data and points."""
    return [
        *_fields("PointData", data.point_data),
        *_fields("CellData", data.cell_data),
        "      <Points>",
        *_array("Points", data.points.astype(np.float32), "f"),
        "      </Points>",
    ]


def _fields(title: str, fields: Sequence[Field]) -> list[str]:
    lines = [f"      <{title}>"]
    for name, values in fields:
        lines += _array(name, values, _kind(values))
    return [*lines, f"      </{title}>"]


def _topology(data: PolyData) -> list[str]:
    """Return the arrays that say which points the cells have."""
    ends = data.nodes * (1 + np.arange(data.amount))
    return [*_array("connectivity", data.connections, "q"), *_array("offsets", ends, "q")]


def _kind(values: NDArray[Any]) -> str:
    return "i" if values.dtype.kind in "iu" else str(values.dtype.char)


def _named(tag: str, name: str, values: NDArray[Any], kind: str) -> str:
    """Return tag, type, name and size of an array."""
    from xml.sax.saxutils import quoteattr  # brings half of the network library with it

    size = f' NumberOfComponents="{values.shape[1]}"' if values.ndim > 1 else ""
    return f'{tag} type="{_TYPES[kind]}" Name={quoteattr(name)}{size}'


def _array(name: str, values: NDArray[Any], kind: str) -> list[str]:
    """Return the lines of an array with its range."""
    vectors = values.ndim > 1
    size = np.sqrt((values.astype(np.float64) ** 2).sum(axis=1)) if vectors else values
    low, high = (float(size.min()), float(size.max())) if len(values) else _NOTHING
    write = shortest if values.dtype.kind == "f" else str
    flat = [write(value) for value in values.astype(values.dtype).ravel().tolist()]
    rows = [flat[at : at + _PER_LINE] for at in range(0, len(flat), _PER_LINE)]
    return [
        f"        <{_named('DataArray', name, values, kind)} "
        f'format="ascii" RangeMin="{shortest(low)}" RangeMax="{shortest(high)}">',
        *("          " + " ".join(row) for row in rows),
        *(_key(low, high) if vectors else ()),
        "        </DataArray>",
    ]


def _key(low: float, high: float) -> list[str]:
    """Return the range of the lengths of vectors."""
    inner = [
        line
        for at, value in enumerate((low, high))
        for line in (
            f'            <Value index="{at}">',
            f"              {value:.11g}",
            "            </Value>",
        )
    ]
    return [
        '          <InformationKey name="L2_NORM_RANGE" location="vtkDataArray" length="2">',
        *inner,
        "          </InformationKey>",
    ]
