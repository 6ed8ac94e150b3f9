"""``dump ID GROUP mesh/vtk N FILE WORD ... [MESH ...]``: meshes with values of their triangles."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, ClassVar, Final

import numpy as np
from numpy.typing import NDArray

from minidem.errors import InputError, suggest
from minidem.kernels.columns import CORNER_BIT, EDGE_BIT
from minidem.output.dump import DUMPS, Dump, write_snapshot
from minidem.output.dump_vtk import vtk_format
from minidem.output.text.polydata import POLYGONS, PolyData
from minidem.record import record
from minidem.words import Words
from minidem.world.mesh.edges import edges_of, node_numbers
from minidem.world.mesh.facets import Facets, areas
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["DumpMesh"]

Values = NDArray[Any]
Found = Callable[[World, str], "Values | None"]

_SUFFIXES: Final = (".vtk", ".vtp")
_ABSENT: Final = ("temp", "liquid", "distaa")  # known to LIGGGHTS, but no mesh has these values


def _facets(world: World, mesh: str) -> Facets | None:
    found: Facets | None = world.fixes[mesh].facets
    return found


def _nodes(world: World, mesh: str) -> Floats:
    lo, hi = world.meshes.span(mesh)
    nodes: Floats = world.meshes.table.node[lo:hi]
    return nodes


def _stress(part: int, world: World, mesh: str) -> Values | None:
    """Return normal (0) or shear stress (1) of the triangles, Pa."""
    facets = _facets(world, mesh)
    if facets is None or not world.fixes[mesh].stress:
        return None
    lo, hi = world.meshes.span(mesh)
    return facets.stress(world.meshes.table.normal[lo:hi], areas(_nodes(world, mesh)))[part]


def _force(world: World, mesh: str) -> Values | None:
    facets = _facets(world, mesh)
    return None if facets is None or not world.fixes[mesh].stress else facets.force


def _components(world: World, mesh: str) -> Values | None:
    force = _force(world, mesh)
    return None if force is None else force * (1.0 / areas(_nodes(world, mesh)))[:, None]


def _wear(world: World, mesh: str) -> Values | None:
    facets = _facets(world, mesh)
    if facets is None or not world.fixes[mesh].wears:
        return None
    found: Values = facets.worn / areas(_nodes(world, mesh))
    return found


def _no_wear(world: World, mesh: str) -> Values | None:
    """Return the wear of a step that is not finished: none."""
    worn = _wear(world, mesh)
    return None if worn is None else np.zeros_like(worn)


def _number(world: World, mesh: str) -> Values:
    return np.arange(len(_nodes(world, mesh)))


def _active(bit: int, world: World, mesh: str) -> Values:
    """Return how many edges or corners of each triangle take contacts."""
    lo, hi = world.meshes.span(mesh)
    flags = world.meshes.table.flags[lo:hi]
    found: Values = sum((flags >> (bit + k)) & 1 for k in range(3))
    return found


def _neighbours(world: World, mesh: str) -> Values:
    nodes = _nodes(world, mesh)
    one, _, other, _ = edges_of(node_numbers(nodes)).T
    return np.bincount(np.concatenate([one, other]), minlength=len(nodes))


def _velocity(world: World, mesh: str) -> Values | None:
    """Return the velocity of the nodes, m/s, of a mesh that slides, moves or is a servo."""
    lo, hi = world.meshes.span(mesh)
    own = world.fixes[mesh]
    moves = (
        own.slides
        or own.style.endswith("/servo")
        or any(
            mesh in fix.meshes_used() and fix.style.startswith("move/mesh")
            for fix in world.fixes.values()
        )
    )
    found: Values = world.meshes.table.vel[lo:hi].reshape(-1, 3)
    return found if moves else None


# keyword: names of the arrays and where they come from, in the order of the file
_WORDS: Final[dict[str, tuple[tuple[str, Found], ...]]] = {
    "stress": (
        ("normal_stress_average", lambda world, mesh: _stress(0, world, mesh)),
        ("shear_stress_average", lambda world, mesh: _stress(1, world, mesh)),
    ),
    "stresscomponents": (("stress", _components),),
    "id": (("meshid", _number),),
    "wear": (("wear", _wear),),
    "owner": (("owner", lambda world, mesh: 0 * _number(world, mesh)),),
    "area": (("area", lambda world, mesh: areas(_nodes(world, mesh))),),
    "aedges": (("active_edges", lambda world, mesh: _active(EDGE_BIT, world, mesh)),),
    "acorners": (("active_corners", lambda world, mesh: _active(CORNER_BIT, world, mesh)),),
    "index": (("index", _number),),
    "nneighs": (("nneighs", _neighbours),),
}
# what LIGGGHTS keeps per triangle under a name of its own comes last, numbers before vectors
_KEPT: Final[dict[str, Found]] = {
    "wear_step": _no_wear,
    "sigma_n": lambda world, mesh: _stress(0, world, mesh),
    "sigma_t": lambda world, mesh: _stress(1, world, mesh),
    "f": _force,
}


@DUMPS.register("mesh/vtk", "mesh/gran/VTK")
@record
class DumpMesh(Dump):
    """``dump mesh/vtk``: meshes with values of their triangles.

    Attributes
    ----------
    wanted : tuple of str
        Keywords.
    meshes : tuple of str
        Ids of the meshes, empty for those that there are.
    mode : str
        ``face``, ``interpolate`` or ``original``: whether all values belong to triangles, to
        nodes, or each to its own.
    """

    wanted: tuple[str, ...] = ()
    meshes: tuple[str, ...] = ()
    mode: str = "face"

    keywords: ClassVar[tuple[str, ...]] = (*Dump.keywords, "binary", "compressor")

    def read_rest(self, world: World, words: Words) -> None:
        """Read keywords and ids of meshes, in any order."""
        vtk_format(self, _SUFFIXES)
        wanted, meshes = [], []
        while not words.done():
            word = words.take("a keyword or a mesh")
            if word == "output":
                self.mode = words.choice(("face", "interpolate", "original"), "output")
            elif word in world.meshes.names:
                meshes.append(word)
            elif word == "vel" or word in _WORDS or word in _KEPT or word in _ABSENT:
                wanted.append(word)
            else:
                near = suggest(word, (*_WORDS, "vel", *world.meshes.names))
                msg = f"dump {self.name}: '{word[:40]}' is neither a keyword nor a mesh{near}"
                raise InputError(msg)
        if not wanted:
            msg = f"dump {self.name}: no quantity is asked for; give one of {', '.join(_WORDS)}"
            raise InputError(msg)
        self.wanted = tuple(wanted)
        self.meshes = tuple(meshes or world.meshes.names)

    def write(self, world: World, target: Path) -> None:
        """Write the triangles, mesh after mesh."""
        meshes = [mesh for mesh in self.meshes if mesh in world.meshes.names]
        nodes = np.concatenate([np.empty((0, 3, 3)), *(_nodes(world, mesh) for mesh in meshes)])
        sources = [item for key in _WORDS if key in self.wanted for item in _WORDS[key]]
        sources += [(key, _KEPT[key]) for key in _KEPT if key in self.wanted]
        cells = [
            (name, joined)
            for name, source in sources
            if (joined := _joined(world, meshes, source, 1)) is not None
        ]
        velocity = _joined(world, meshes, _velocity, 3) if "vel" in self.wanted else None
        points = [] if velocity is None else [("v", velocity)]
        if self.mode == "face":
            cells += [(name, _mean(values)) for name, values in points]
            points = []
        elif self.mode == "interpolate":
            points += [(name, _spread(values)) for name, values in cells]
            cells = []
        data = PolyData(nodes.reshape(-1, 3), POLYGONS, points, cells)
        write_snapshot(target, vtk_format(self, _SUFFIXES).text(data))


def _joined(world: World, meshes: list[str], source: Found, rows: int) -> Values | None:
    """Return the values of all meshes, 0 where a mesh has none; None if no mesh has any.

    `rows` is the number of values per triangle.
    """
    parts = [source(world, mesh) for mesh in meshes]
    there = [part for part in parts if part is not None]
    if not there:
        return None
    found: Values = np.concatenate(
        [
            np.zeros((rows * len(_nodes(world, mesh)), *there[0].shape[1:]), there[0].dtype)
            if part is None
            else part
            for mesh, part in zip(meshes, parts, strict=True)
        ]
    )
    return found


def _mean(values: Values) -> Values:
    """Return the means of three nodes each."""
    first, second, third = (values[k::3] for k in range(3))
    found: Values = (first + second + third) * (1.0 / 3.0)
    return found


def _spread(values: Values) -> Values:
    """Return the values of triangles for each of their nodes; whole numbers become float32."""
    found: Values = np.repeat(values, 3, axis=0)
    return found.astype(np.float32) if found.dtype.kind == "i" else found
