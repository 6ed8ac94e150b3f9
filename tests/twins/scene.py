"""A small scene: spheres, walls and contact models, and the script that says the same.

Both the engine and its twin are given a `Scene`; nothing else passes between them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

Vector = tuple[float, float, float]
NOWHERE = (0.0, 0.0, 0.0)
AXES = "xyz"


@dataclass(frozen=True)
class Model:
    """A contact model as a script names it.

    Attributes
    ----------
    names : mapping of str to str
        Keyword (``model``, ``tangential``, ...) to the name chosen.
    on : frozenset of str
        Settings that are on.
    off : frozenset of str
        Settings that are off; they are written too.
    """

    names: Mapping[str, str]
    on: frozenset[str] = frozenset()
    off: frozenset[str] = frozenset()

    def words(self) -> str:
        """Return the words of the models, in the order of the registry."""
        return " ".join(f"{key} {name}" for key, name in self.names.items())

    def settings(self) -> str:
        """Return the words of the settings."""
        rows = [f"{key} on" for key in sorted(self.on)] + [f"{key} off" for key in sorted(self.off)]
        return " ".join(rows)


@dataclass(frozen=True)
class Sphere:
    """A sphere: position, velocity, spin, size, density, type from 1, m, m/s, rad/s, kg/m3."""

    x: Vector
    v: Vector
    w: Vector
    radius: float
    density: float
    kind: int

    @property
    def mass(self) -> float:
        """Mass, kg."""
        return 4.0 / 3.0 * np.pi * self.radius**3 * self.density


@dataclass(frozen=True)
class Primitive:
    """A plane (offset) or cylinder (radius and the two coordinates of its axis).

    Attributes
    ----------
    shape : str
        ``xplane`` to ``zcylinder``.
    values : tuple of float
        m.
    kind : int
        Atom type, from 1.
    shear : tuple or None
        Axis and speed, m/s, or rad/s for a cylinder that turns.
    part : bool
        True if it acts on the group ``part`` only.
    """

    model: Model
    shape: str
    values: tuple[float, ...]
    kind: int = 1
    shear: tuple[str, float] | None = None
    part: bool = False


@dataclass(frozen=True)
class Motion:
    """A motion of a mesh: style and the words of a script with their numbers."""

    style: str
    numbers: Mapping[str, tuple[float, ...]]

    def words(self) -> str:
        """Return the words after ``mesh ID``."""
        rows = [f"{key} {' '.join(map(repr, values))}" for key, values in self.numbers.items()]
        return " ".join([self.style, *rows]).replace("velocity ", "")


@dataclass(frozen=True)
class Mesh:
    """Triangles.

    Attributes
    ----------
    nodes : tuple
        Shape (n, 3, 3), m.
    kind : int
        Atom type, from 1.
    curvature : float or None
        Degrees, below which facets count as coplanar.
    belt : tuple or None
        ``surface_vel``, m/s.
    motion : Motion or None
        How it moves; not together with a belt.
    """

    nodes: tuple[tuple[Vector, Vector, Vector], ...]
    kind: int = 1
    curvature: float | None = None
    belt: Vector | None = None
    motion: Motion | None = None


@dataclass(frozen=True)
class Scene:
    """All of a small simulation.

    Attributes
    ----------
    model, mesh_model : Model
        Of pairs, and of the wall made of all meshes.
    materials : mapping
        Name to values: one number, one per type, or one per pair of types.
    size : tuple
        Half the box, which is centred at the origin, m.
    periodic : tuple of bool
        Per direction.
    skin, factor, delay, every, check
        ``neighbor`` and ``neigh_modify``.
    part, frozen, loose : tuple of int
        Ids in the group ``part``, in the group that is frozen, and not integrated at all.
    moves_first : bool
        True if motions are defined before the wall.
    runs : tuple of int
        Steps of each run.
    """

    model: Model
    materials: Mapping[str, np.ndarray]
    spheres: tuple[Sphere, ...]
    mesh_model: Model
    primitives: tuple[Primitive, ...] = ()
    meshes: tuple[Mesh, ...] = ()
    types: int = 2
    size: Vector = (0.05, 0.05, 0.05)
    periodic: tuple[bool, bool, bool] = (False, False, False)
    skin: float = 0.001
    factor: float = 1.0
    delay: int = 0
    every: int = 1
    check: bool = True
    dt: float = 1e-5
    gravity: Vector = NOWHERE
    part: tuple[int, ...] = ()
    frozen: tuple[int, ...] = ()
    loose: tuple[int, ...] = ()
    moves_first: bool = True
    runs: tuple[int, ...] = field(default=(1,))

    def script(self, output: tuple[str, ...] = ()) -> str:
        """Return the script, with lines for output; meshes are read from ``mesh0.stl`` etc."""
        faces = " ".join("p" if flag else "f" for flag in self.periodic)
        box = " ".join(f"{-half!r} {half!r}" for half in self.size)
        lines = [
            "atom_style granular", "atom_modify map array sort 0 0", f"boundary {faces}",
            "newton off", "communicate single vel yes", "units si",
            f"region box block {box} units box", f"create_box {self.types} box",
            f"neighbor {self.skin!r} bin",
            f"neigh_modify delay {self.delay} every {self.every} check "
            f"{'yes' if self.check else 'no'} contact_distance_factor {self.factor!r}",
            *(self._property(*item) for item in self.materials.items()),
            f"pair_style gran {self.model.words()} {self.model.settings()}", "pair_coeff * *",
            f"timestep {self.dt!r}",
        ]  # fmt: skip
        for number, sphere in enumerate(self.spheres, start=1):
            lines += _sphere_lines(number, sphere)
        lines += self._groups()
        strength = float(np.linalg.norm(self.gravity))
        if strength > 0.0:
            way = " ".join(map(repr, self.gravity))
            lines.append(f"fix g part gravity {strength!r} vector {way}")
        lines += [self._primitive(k, wall) for k, wall in enumerate(self.primitives)]
        lines += self._mesh_lines()
        if self.frozen:
            lines.append("fix still frozen freeze")
        lines += ["fix integr free nve/sphere", "thermo_modify lost error norm no", *output]
        return "\n".join([*lines, *(f"run {steps}" for steps in self.runs), ""])

    def _property(self, name: str, values: np.ndarray) -> str:
        style = ("scalar", "peratomtype", f"peratomtypepair {self.types}")[np.ndim(values)]
        numbers = " ".join(repr(float(value)) for value in np.ravel(values))
        return f"fix p_{name} all property/global {name} {style} {numbers}"

    def _groups(self) -> list[str]:
        free = [k for k in range(1, len(self.spheres) + 1) if k not in self.loose]
        found = []
        for name, ids in (("part", self.part), ("frozen", self.frozen), ("free", free)):
            # all without all: a group of nobody
            chosen = f"id {' '.join(map(str, ids))}" if ids else "subtract all all"
            found.append(f"group {name} {chosen}")
        return found

    def _primitive(self, number: int, wall: Primitive) -> str:
        group = "part" if wall.part else "all"
        values = " ".join(map(repr, wall.values))
        shear = f"shear {wall.shear[0]} {wall.shear[1]!r}" if wall.shear else ""
        return (
            f"fix wall{number} {group} wall/gran {wall.model.words()} primitive type {wall.kind} "
            f"{wall.shape} {values} {shear} {wall.model.settings()}"
        )

    def _mesh_lines(self) -> list[str]:
        if not self.meshes:
            return []
        lines, moves = [], []
        for k, mesh in enumerate(self.meshes):
            words = f"fix mesh{k} all mesh/surface file mesh{k}.stl type {mesh.kind}"
            if mesh.belt:
                words += f" surface_vel {' '.join(map(repr, mesh.belt))}"
            if mesh.curvature is not None:
                words += f" curvature {mesh.curvature!r} curvature_tolerant yes"
            lines.append(words)
            if mesh.motion:
                moves.append(f"fix move{k} all move/mesh mesh mesh{k} {mesh.motion.words()}")
        names = " ".join(f"mesh{k}" for k in range(len(self.meshes)))
        wall = [
            f"fix walls all wall/gran {self.mesh_model.words()} mesh n_meshes {len(self.meshes)} "
            f"meshes {names} {self.mesh_model.settings()}"
        ]
        return lines + (moves + wall if self.moves_first else wall + moves)


def _sphere_lines(number: int, sphere: Sphere) -> list[str]:
    x, v, w = (tuple(map(repr, vector)) for vector in (sphere.x, sphere.v, sphere.w))
    return [
        f"create_atoms {sphere.kind} single {x[0]} {x[1]} {x[2]} units box",
        f"set atom {number} density {sphere.density!r} diameter {2.0 * sphere.radius!r}",
        f"set atom {number} vx {v[0]} vy {v[1]} vz {v[2]} "
        f"omegax {w[0]} omegay {w[1]} omegaz {w[2]}",
    ]


def stl_text(mesh: Mesh) -> str:
    """Return a mesh as an ASCII STL file."""
    rows = ["solid m"]
    for triangle in mesh.nodes:
        rows += ["facet normal 0 0 1", "outer loop"]
        rows += ["vertex " + " ".join(map(repr, map(float, point))) for point in triangle]
        rows += ["endloop", "endfacet"]
    return "\n".join([*rows, "endsolid m", ""])
