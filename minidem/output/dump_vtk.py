"""``dump ID GROUP custom/vtk N FILE COLUMN ...`` and ``atom/vtk``: particles as VTK files."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, ClassVar, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from minidem.errors import InputError
from minidem.kernels.columns import MASS, OMEGA, POSITION, RADIUS, TOTAL_FORCE, VELOCITY
from minidem.output.columns import atom_vector
from minidem.output.dump import (
    BY_ID,
    DUMPS,
    Dump,
    TextDump,
    sort_key,
    sorted_rows,
    write_snapshot,
)
from minidem.output.dump_custom import DumpCustom, corners
from minidem.output.text.polydata import VERTICES, PolyData, legacy_file
from minidem.output.text.vtk import bounding_box_file, bounding_box_name, particle_data
from minidem.output.text.xml import box_file, parts_file, polydata_file, unstructured_file
from minidem.record import record
from minidem.script.paths import inside
from minidem.words import Words
from minidem.world.world import World

__all__ = ["DumpAtomVtk", "DumpParts", "DumpVtk", "Format", "vtk_format"]


_ATOM_COLUMNS: Final = (
    "x", "y", "z", "radius", "mass", "id", "type", "vx", "vy", "vz", "omegax", "omegay", "omegaz",
    "fx", "fy", "fz",
)  # fmt: skip
"""What the particles of ``atom/vtk`` can be sorted by."""


class Format(NamedTuple):
    """A format of VTK files.

    Attributes
    ----------
    text : callable
        Points with cells to the text of a file.
    box : callable
        The same for the simulation box, shape (2, 3).
    box_suffix : str
        How the name of that file ends.
    part : str
        How the name of the file of the particles ends beside one that tells of its parts.
    kind : str
        What VTK calls the particles in it.
    """

    text: Callable[[PolyData], str]
    box: Callable[[NDArray[Any]], str]
    box_suffix: str
    part: str = ""
    kind: str = ""


_PARTS: Final = (
    "# vtk DataFile Version 2.0\nLIGGGHTS mesh/gran/VTK export\nASCII\n"
    "DATASET RECTILINEAR_GRID\nDIMENSIONS 2 2 2\n"
)
_FORMATS: Final = {
    ".vtk": Format(legacy_file, bounding_box_file, ".vtk"),
    ".vtp": Format(polydata_file, box_file, ".vtr"),
    ".vtu": Format(unstructured_file, box_file, ".vtr"),
    ".pvtp": Format(polydata_file, box_file, ".pvtr", ".vtp", "PolyData"),
    ".pvtu": Format(unstructured_file, box_file, ".pvtr", ".vtu", "UnstructuredGrid"),
}


def vtk_format(dump: Dump, suffixes: tuple[str, ...]) -> Format:
    """Return the format that the end of the file name of a dump asks for.

    Raises
    ------
    InputError
        If it is none of `suffixes`, or there is a ``%`` in the name.
    """
    dump.refuse_names("%")
    suffix = Path(dump.path).suffix
    if suffix not in suffixes:
        msg = (
            f"dump {dump.name}: the file name '{dump.path}' must end in "
            f"{' or '.join(suffixes)}; other VTK files are not written"
        )
        raise InputError(msg)
    return _FORMATS[suffix]


@DUMPS.register("custom/vtk")
class DumpVtk(DumpCustom):
    """``dump custom/vtk``: particles and simulation box as VTK files."""

    keywords: ClassVar[tuple[str, ...]] = (*DumpCustom.keywords, "binary", "compressor")
    words: ClassVar[tuple[str, ...]] = ()

    def read_rest(self, world: World, words: Words) -> None:
        """Read the columns."""
        super().read_rest(world, words)
        vtk_format(self, tuple(_FORMATS))

    def begin(self, world: World) -> None:
        """Make no file: each snapshot is a whole one."""

    def write(self, world: World, target: Path) -> None:
        """Write the particles and the box; positions are the points, whether asked for or not."""
        form = vtk_format(self, tuple(_FORMATS))
        more = tuple(axis for axis in "xyz" if axis not in self.columns)
        data = particle_data(self.select(world, more))
        if form.part:
            part = target.with_name(f"{target.stem}_0{form.part}")
            write_snapshot(target, parts_file(data, form.kind, part.name))
            target = part
        if len(data.points) or not form.part:
            write_snapshot(target, form.text(data))
        pattern = str(Path(bounding_box_name(self.path)).with_suffix(form.box_suffix))
        name = self.file_name(pattern, world.step)
        write_snapshot(inside(world.root, name), form.box(corners(world)))


@DUMPS.register("atom/vtk")
@record
class DumpAtomVtk(Dump):
    """``dump atom/vtk``: what LIGGGHTS chose, as an XML file whatever its name.

    Attributes
    ----------
    sort : int
        See `minidem.output.dump.sort_key`, of the numbers in the order in which LIGGGHTS has them.
    """

    sort: int = BY_ID

    def read_rest(self, world: World, words: Words) -> None:
        """Read nothing more."""
        del world, words
        self.refuse_names("%")

    def modify(self, key: str, words: Words) -> None:
        """Read the value of ``sort``, or of a common keyword."""
        if key == "sort":
            self.sort = sort_key(self, words, len(_ATOM_COLUMNS))
        else:
            super().modify(key, words)

    def write(self, world: World, target: Path) -> None:
        """Write the particles."""
        state = world.state
        order = state.output_order()
        order = sorted_rows(
            self.sort,
            order[world.member(self.bit)[order]],
            state.ids,
            lambda column: atom_vector(world, _ATOM_COLUMNS[column - 1]),
        )
        row, force = state.row[order], state.force[order]
        fields: list[tuple[str, NDArray[Any]]] = [
            ("radii", row[:, RADIUS]),
            ("id", state.ids[order]),
            ("type", state.kind[order] + 1),
            ("proc", np.zeros(len(order), np.int64)),
            ("mass", row[:, MASS]),
            ("velocity_lin", row[:, VELOCITY]),
            ("velocity_ang", state.spin[order][:, OMEGA]),
            ("force", force[:, TOTAL_FORCE]),
        ]
        write_snapshot(target, unstructured_file(PolyData(row[:, POSITION], VERTICES, fields)))


@DUMPS.register("decomposition/vtk")
class DumpParts(TextDump):
    """``dump decomposition/vtk``: the parts of the box that the processes have; here it is one."""

    def read_rest(self, world: World, words: Words) -> None:
        """Read nothing more."""
        del world, words
        self.refuse_names(".bin")

    def write(self, world: World, target: Path) -> None:
        """Write the box."""
        edges = [
            f"{axis}_COORDINATES 2 float\n{low:f} {high:f} \n"
            for axis, low, high in zip("XYZ", *corners(world), strict=True)
        ]
        self.put(target, _PARTS + "".join(edges))
