"""``fix ID all mesh/surface file FILE type TYPE ...``: triangles from an STL file.

Also ``mesh/surface/planar``, which may serve insertion and counting, and ``mesh/surface/stress``,
whose force and torque are output.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import cos, pi
from typing import Any, ClassVar

import numpy as np

from minidem.errors import InputError
from minidem.fixes.carrier import Carrier
from minidem.insertion.seeds import MESH_SEED, ParkMiller
from minidem.record import field, fields, record
from minidem.registry import Head
from minidem.words import Words, one_of
from minidem.world.fix import FIXES, Fix, all_fixes
from minidem.world.images import drop_images
from minidem.world.mesh.facets import Facets
from minidem.world.mesh.placement import PLACEMENT, placed
from minidem.world.mesh.quality import check_angles, is_planar
from minidem.world.mesh.source import WORDS, MeshFile
from minidem.world.mesh.surface import CURVATURE, feature_flags, whole
from minidem.world.mesh.surface_velocity import SurfaceVelocity
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["MeshSurface", "known_mesh", "planar"]

_LARGEST = 1.0e100  # m; coordinates are squared later
_CURVATURES = (0.0, 60.0)  # degrees, the limits of LIGGGHTS
_OPTIONS = (
    "surface_vel", "surface_ang_vel", "curvature", "curvature_tolerant", "cg", "stress",
    "reference_point", "wear",
)  # fmt: skip
_HEAT = ("temperature", "mass_temperature")


@FIXES.register("mesh/surface", "mesh/surface/planar", "mesh/surface/stress")
@record
class MeshSurface(Fix):
    """A mesh; its triangles are in the world's `MeshStore`.

    Attributes
    ----------
    kind : int
        Atom type, from 1.
    slides : bool
        True with ``surface_vel`` or ``surface_ang_vel``.
    stress : bool
        True for ``mesh/surface/stress``: forces on the mesh are output.
    wears : bool
        True with ``wear finnie``.
    load : ndarray, shape (6,)
        Force, N, and torque, N m, of the particles on the mesh.
    facets : Facets or None
        Values per triangle, of meshes with stress or wear.
    loaded : bool
        Whether a step was made with it.
    random : ParkMiller
        Generator from which streams draw points of it.
    """

    kind: int = 1
    slides: bool = False
    stress: bool = False
    wears: bool = False
    load: Floats = field(default_factory=lambda: np.zeros(6))
    facets: Facets | None = None
    loaded: bool = False
    random: ParkMiller = field(default_factory=lambda: ParkMiller(MESH_SEED))

    extensive: ClassVar[tuple[bool, bool]] = (False, True)  # all of them, as in LIGGGHTS
    keywords: ClassVar[tuple[str, ...]] = ()
    """Keywords that only this style has."""

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> MeshSurface:
        """Read the file and put its triangles where the options say."""
        words.need(4, f"fix ID all {head.style} file FILE type TYPE")
        source = MeshFile.read(world.root, world.regions, words)
        options = _Options(source.nodes)
        made = cls(*head, source.kind, stress="stress" in head.style)
        options.read(made, words)
        if source.odd:
            world.warn(f"mesh {head.name}: LIGGGHTS stops at its file, which {source.odd}")
        for word in options.ignored:
            world.warn(f"mesh {head.name}: '{word}' has no effect, as heat is not computed")
        # What 'scale' makes too small takes no contacts, and its nodes could not be told apart.
        nodes = np.ascontiguousarray(options.nodes[whole(options.nodes, source.equal)])
        if not len(nodes):
            msg = f"after 'scale' no triangle of mesh {head.name} is larger than {source.equal:g} m"
            raise InputError(msg)
        check_angles(head.name, nodes, options.limit, tolerant=options.tolerant)
        drop_images(world)
        flags = feature_flags(nodes, options.limit, equal=source.equal)
        world.meshes.add(head.name, nodes, flags, options.limit, source.equal)
        if head.style == "mesh/surface/planar" and not planar(world, head.name):
            msg = (
                f"mesh {head.name}: face defined as planar face is in fact not planar; check the "
                "'curvature' setting"
            )
            raise InputError(msg)
        world.meshes.table.origin[world.meshes.names.index(head.name)] = options.origin
        if made.stress or made.wears:
            made.facets = Facets(len(nodes))
        made.slides = options.sliding is not None
        if options.sliding is None:
            return made
        made.slide(world, options.sliding, lambda _: 0.0)
        return made.driven(options.sliding) if options.sliding.varies else made

    def driven(self, sliding: SurfaceVelocity) -> MeshSurface:
        """Return a mesh like this whose surface runs as variables say."""
        if type(self) is not MeshSurface:
            msg = f"{self.style}: a variable in surface_vel or surface_ang_vel is not supported"
            raise InputError(msg)
        values = {one.name: getattr(self, one.name) for one in fields(self)}
        return DrivenMesh(**values, sliding=sliding)

    def slide(
        self, world: World, sliding: SurfaceVelocity, variable: Callable[[str], float]
    ) -> None:
        """Set the velocity of its nodes, given the values of variables."""
        table, span = world.meshes.table, slice(*world.meshes.span(self.name))
        table.vel[span] = sliding.of_nodes(table.node[span], table.normal[span], variable)

    def read_own(self, key: str, words: Words) -> None:
        """Read what follows one of `keywords`."""

    def value(self, world: World, index: int) -> float:
        """Return force (1-3), torque (4-6) and reference point (7-9) of the mesh."""
        origin = world.meshes.table.origin[world.meshes.names.index(self.name)]
        given = [*self.load, *origin]
        if "stress" not in self.style or not 1 <= index <= len(given):
            return super().value(world, index)
        return float(given[index - 1])

    def material_types(self) -> tuple[int, ...]:
        """Return its type."""
        return (self.kind,)

    def state(self) -> dict[str, Any]:
        """Return the wear so far."""
        return {"worn": self.facets.worn.tolist()} if self.facets is not None else {}

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Take the wear from a restart file."""
        worn = np.array(saved.get("worn", ()), np.float64)
        if self.facets is not None and worn.shape == self.facets.worn.shape:
            self.facets.worn = worn

    def remove(self, world: World) -> None:
        """Take the triangles out if no wall, motion or counter uses them."""
        for other in all_fixes(world):
            if self.name in other.meshes_used():
                msg = f"fix {other.name} still uses the mesh '{self.name}'; unfix it first"
                raise InputError(msg)
        drop_images(world)
        world.lists.renumber(world.meshes.remove(self.name), None)


@record(kw_only=True)
class DrivenMesh(MeshSurface, Carrier):
    """A mesh whose surface runs as fast as variables say.

    As in LIGGGHTS they are asked in every step, and count as 0 before the first one.

    Attributes
    ----------
    sliding : SurfaceVelocity
    """

    sliding: SurfaceVelocity

    def variables_asked(self) -> tuple[str, ...]:
        """Return the names of the variables that it asks in a run."""
        return tuple(one for one in self.sliding.values if isinstance(one, str))

    def before(self, world: World) -> None:
        """Set the velocity of the step that begins."""
        world.step += 1
        try:
            self.slide(world, self.sliding, world.interpreter.value)
        finally:
            world.step -= 1


@record
class _Options:
    """What follows the file and the words about it.

    Attributes
    ----------
    nodes : ndarray, shape (n, 3, 3)
        Triangles, scaled, moved and rotated in the order of the words, m.
    limit : float
        Cosine above which facets are coplanar.
    tolerant : bool
        ``curvature_tolerant yes``.
    origin : ndarray, shape (3,)
        Reference point of torques, m.
    ignored : list of str
        Keywords without effect, as heat is not computed.
    sliding : SurfaceVelocity or None
        Of a surface that rubs and stays in place.
    """

    nodes: Floats
    limit: float = CURVATURE
    tolerant: bool = False
    origin: Floats = field(default_factory=lambda: np.zeros(3))
    ignored: list[str] = field(default_factory=list)
    sliding: SurfaceVelocity | None = None

    def read(self, mesh: MeshSurface, words: Words) -> None:
        """Read all options, in the order in which LIGGGHTS wants them."""
        while words.peek() in (*PLACEMENT, *_HEAT):
            if words.peek() in PLACEMENT:
                self.nodes = placed(self.nodes, words.take("a keyword"), words)
            else:
                self.ignored.append(words.take("a keyword"))
                words.number()
        while not words.done():
            if words.peek() in (*WORDS, *PLACEMENT, *_HEAT):
                place = "beside 'type'" if words.peek() in WORDS else "right behind 'type'"
                msg = f"'{words.peek()}' has to stand {place}, as in LIGGGHTS"
                raise InputError(msg)
            self.option(mesh, words)
        if not (np.abs(self.nodes) < _LARGEST).all():
            msg = "after 'scale', 'move' and 'rotate' some nodes are too far away"
            raise InputError(msg)

    def option(self, mesh: MeshSurface, words: Words) -> None:
        """Read one of the options behind those that place the mesh."""
        key = words.choice((*_OPTIONS, *mesh.keywords))
        if key in mesh.keywords:
            mesh.read_own(key, words)
        elif key == "surface_vel":
            self.sliding = SurfaceVelocity.belt(words)
        elif key == "surface_ang_vel":
            self.sliding = SurfaceVelocity.turning(words)
        elif key == "reference_point":
            self.origin = np.array(words.numbers(3))
        elif key == "stress":
            mesh.stress = words.choice(("on", "off"), key) == "on"
        elif key == "wear":
            mesh.wears = words.choice(("finnie", "off"), key) == "finnie"
        elif key == "curvature":
            degrees = words.number()
            least, most = _CURVATURES
            if not least < degrees <= most:
                msg = f"curvature {degrees:g} is not above {least:g} and at most {most:g} degrees"
                raise InputError(msg)
            self.limit = cos(degrees * pi / 180.0)
        elif key == "curvature_tolerant":
            self.tolerant = words.yes_no()
        else:
            words.take(f"a value of '{key}'")


def known_mesh(world: World, name: str) -> str:
    """Return the id of a mesh if there is one.

    Raises
    ------
    InputError
        With the nearest id.
    """
    return one_of(name, tuple(world.meshes.names), "mesh")


def planar(world: World, name: str) -> bool:
    """Return True if all triangles of a mesh lie in one plane, as its curvature setting sees it."""
    store = world.meshes
    lo, hi = store.span(name)
    limit = store.limits[store.names.index(name)]
    return is_planar(store.table.node[lo:hi], store.table.normal[lo:hi], limit)
