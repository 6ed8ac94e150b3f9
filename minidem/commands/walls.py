"""Meshes, walls, mesh motions and counters."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, inf, pi, sqrt

import numpy as np

from minidem.contact.model import parse_model, parse_settings
from minidem.errors import suggest
from minidem.fixes.massflow import flow_header
from minidem.fixes.wall import MassFlow, MeshSurface, MoveMesh, WallGran
from minidem.kernels.motion.motion import WAVES
from minidem.registry import fix, integer, need, number, one_of, yes_no
from minidem.run.engine import Engine
from minidem.script.paths import inside
from minidem.world.images import drop_images
from minidem.world.mesh.quality import check_angles, drop_duplicates, is_planar
from minidem.world.mesh.stl import read_stl
from minidem.world.mesh.surface import CURVATURE, clean, feature_flags, place
from minidem.world.state import Floats

_MESH_WORDS = (
    "surface_vel", "surface_ang_vel", "curvature", "curvature_tolerant", "verbose", "heal",
    "precision", "min_feature_length", "element_exclusion_list", "cg", "stress", "reference_point",
    "wear",
)  # fmt: skip
_AXES = {"x": 0, "y": 1, "z": 2}


@fix("mesh/surface", "mesh/surface/planar", "mesh/surface/stress")
def _mesh(engine: Engine, name: str, style: str, group: str, words: Sequence[str]) -> object:
    need(words, 4, f"fix ID all {style} file FILE type TYPE")
    world = engine.world
    if words[0] != "file":
        msg = f"expected 'file', found '{words[0]}'"
        raise ValueError(msg)
    if words[2] != "type":
        msg = f"expected 'type' after the file, found '{words[2]}'"
        raise ValueError(msg)
    kind = integer(words[3], "type")
    nodes, rest = place(read_stl(inside(world.root, words[1])), words[4:])
    nodes = clean(nodes)
    made = MeshSurface(name, style, world.bit(group), kind, CURVATURE, stress="stress" in style)
    origin, velocity = _mesh_options(made, rest)
    if made.heal:
        nodes = drop_duplicates(nodes)
    if not made.tolerant:
        check_angles(name, nodes, made.limit)
    flags = feature_flags(nodes, made.limit)
    drop_images(world)
    world.meshes.add(name, nodes, flags)
    lo, hi = world.meshes.span(name)
    table = world.meshes.table
    if style == "mesh/surface/planar" and not is_planar(nodes, table.normal[lo:hi], made.limit):
        world.meshes.remove(name)
        msg = (
            f"mesh {name}: face defined as planar face is in fact not planar; check the "
            "'curvature' setting"
        )
        raise ValueError(msg)
    table.origin[-1] = origin
    if velocity is not None:
        made.slides = True
        _set_surface_velocity(engine, lo, hi, velocity)
    return made


def _mesh_options(
    made: MeshSurface, rest: Sequence[str]
) -> tuple[Floats, tuple[str, list[float]] | None]:
    """Read the options of a mesh; return reference point and surface velocity."""
    origin = np.zeros(3)
    velocity: tuple[str, list[float]] | None = None
    i = 0
    while i < len(rest):
        key = one_of(rest[i], _MESH_WORDS, "mesh/surface keyword")
        need(rest[i:], 2, f"{key} VALUE")
        if key == "surface_vel":
            need(rest[i:], 4, "surface_vel VX VY VZ")
            velocity = (key, [number(word, key) for word in rest[i + 1 : i + 4]])
            i += 4
        elif key == "surface_ang_vel":
            need(rest[i:], 11, "surface_ang_vel origin X Y Z axis AX AY AZ omega W")
            at = [i + 2, i + 3, i + 4, i + 6, i + 7, i + 8, i + 10]
            velocity = (key, [number(rest[k], key) for k in at])
            i += 11
        elif key == "reference_point":
            need(rest[i:], 4, "reference_point X Y Z")
            origin = np.array([number(word, key) for word in rest[i + 1 : i + 4]])
            i += 4
        else:
            _mesh_option(made, key, rest[i + 1])
            i += 2
    return origin, velocity


def _mesh_option(made: MeshSurface, key: str, value: str) -> None:
    """Apply an option with one value."""
    if key == "wear" and value != "off":
        msg = f"wear '{value}' is not supported; use 'wear off'"
        raise ValueError(msg)
    if key == "heal":
        heal = one_of(value, ("auto_remove_duplicates", "no"), key)
        made.heal = heal == "auto_remove_duplicates"
    elif key == "curvature_tolerant":
        made.tolerant = yes_no(value, key)
    elif key == "curvature":
        made.limit = cos(number(value, key) * pi / 180.0)
    elif key == "stress":
        made.stress = one_of(value, ("on", "off"), key) == "on"


def _set_surface_velocity(
    engine: Engine, lo: int, hi: int, velocity: tuple[str, list[float]]
) -> None:
    """Give the nodes the belt velocity, projected on each facet and rescaled."""
    table = engine.world.meshes.table
    key, values = velocity
    for t in range(lo, hi):
        for k in range(3):
            if key == "surface_vel":
                v = np.array(values)
            else:
                axis = np.array(values[3:6]) / np.linalg.norm(values[3:6])
                v = np.cross(values[6] * axis, table.node[t, k] - np.array(values[:3]))
            size = float(np.linalg.norm(v))
            along = v - (v @ table.normal[t]) * table.normal[t]
            left = float(np.linalg.norm(along))
            table.vel[t, k] = along * (size / left) if left > 0.0 else 0.0


@fix("wall/gran")
def _wall(engine: Engine, name: str, style: str, group: str, words: Sequence[str]) -> object:
    switches, rest = parse_model(words)
    wall = WallGran(name, style, engine.world.bit(group), switches)
    if not rest:
        msg = "expected 'mesh' or 'primitive' after the model"
        raise ValueError(msg)
    if rest[0] == "mesh":
        rest = _mesh_wall(engine, wall, rest)
    elif rest[0] == "primitive":
        rest = _primitive_wall(wall, rest)
    else:
        parse_settings(rest[:2], list(switches))
        msg = f"Unknown argument or wrong keyword order: '{rest[0]}'; settings come last"
        raise ValueError(msg)
    parse_settings(rest, switches)
    if not 1 <= wall.kind <= engine.world.types:
        msg = f"wall type {wall.kind} is not between 1 and {engine.world.types}"
        raise ValueError(msg)
    return wall


def _mesh_wall(engine: Engine, wall: WallGran, rest: list[str]) -> list[str]:
    need(rest, 5, "mesh n_meshes N meshes ID ...")
    if rest[1] != "n_meshes" or rest[3] != "meshes":
        msg = "expected 'mesh n_meshes N meshes ID ...'"
        raise ValueError(msg)
    count = integer(rest[2], "n_meshes")
    wall.meshes = rest[4 : 4 + count]
    names = engine.world.meshes.names
    if len(wall.meshes) < count:
        msg = f"n_meshes is {count}, but only {len(wall.meshes)} mesh ids follow"
        raise ValueError(msg)
    for mesh in wall.meshes:
        if mesh not in names:
            msg = f"could not find fix mesh id '{mesh}'{suggest(mesh, names)}"
            raise ValueError(msg)
    if any(other.meshes for other in engine.world.of_kind(WallGran)):
        msg = "only one wall/gran of type mesh is allowed; list all meshes in it with n_meshes"
        raise ValueError(msg)
    return rest[4 + count :]


def _primitive_wall(wall: WallGran, rest: list[str]) -> list[str]:
    need(rest, 5, "primitive type T zplane Z")
    if rest[1] != "type":
        msg = f"expected 'type' after 'primitive', found '{rest[1]}'"
        raise ValueError(msg)
    wall.kind = integer(rest[2], "type")
    shapes = [axis + shape for axis in "xyz" for shape in ("plane", "cylinder")]
    shape = one_of(rest[3], shapes, "primitive wall")
    wall.axis = _AXES[shape[0]]
    wall.shape = int(shape.endswith("cylinder"))
    count = 3 if wall.shape else 1
    need(rest, 4 + count, f"primitive type T {shape} " + "VALUE " * count)
    wall.value[:count] = [number(word, shape) for word in rest[4 : 4 + count]]
    rest = rest[4 + count :]
    if rest and rest[0] == "shear":
        need(rest, 3, "shear x SPEED")
        axis = _AXES[one_of(rest[1], tuple(_AXES), "shear direction")]
        speed = number(rest[2], "shear")
        if wall.shape == 1 and axis == wall.axis:
            wall.value[3 + axis] = speed
        elif wall.shape == 1:
            wall.turning = True
            wall.value[6] = speed  # LIGGGHTS takes the number as spin, rad/s
        else:
            wall.value[3 + axis] = speed
        rest = rest[3:]
    return rest


@fix("move/mesh")
def _move(engine: Engine, name: str, style: str, group: str, words: Sequence[str]) -> object:
    need(words, 3, "fix ID all move/mesh mesh MESH linear VX VY VZ")
    if words[0] != "mesh":
        msg = f"expected 'mesh', found '{words[0]}'"
        raise ValueError(msg)
    names = engine.world.meshes.names
    if words[1] not in names:
        msg = f"could not find fix mesh id '{words[1]}'{suggest(words[1], names)}"
        raise ValueError(msg)
    mesh = engine.world.fixes[words[1]]
    if isinstance(mesh, MeshSurface) and mesh.slides:
        msg = "move/mesh cannot be used on a mesh with surface_vel or surface_ang_vel"
        raise ValueError(msg)
    move = MoveMesh(name, style, engine.world.bit(group), words[1])
    kind = one_of(
        words[2],
        ("linear", "linear/variable", "wiggle", "rotate", "rotate/variable", "riggle", "viblin",
         "vibrot"),
        "move/mesh style",
    )  # fmt: skip
    _MOTIONS[kind](move, list(words[3:]))
    return move


def _take(rest: list[str], word: str, count: int) -> list[float]:
    """Take ``word v1 .. vn`` off the front of `rest`."""
    if not rest or rest[0] != word:
        msg = f"expected '{word}', found '{rest[0] if rest else 'the end of the line'}'"
        raise ValueError(msg)
    need(rest, 1 + count, f"{word} " + "VALUE " * count)
    found = [number(value, word) for value in rest[1 : 1 + count]]
    del rest[: 1 + count]
    return found


def _turns(rest: list[str], count: int) -> list[float]:
    """Take ``period T1 .. Tn`` off the front of `rest`; return angular frequencies, rad/s."""
    periods = _take(rest, "period", count)
    if not all(abs(period) > 1e-100 for period in periods):
        msg = f"period must not be zero, found {' '.join(f'{period:g}' for period in periods)}"
        raise ValueError(msg)
    return [2.0 * pi / period for period in periods]


def _unit(values: list[float]) -> Floats:
    """Return a unit vector; the order of operations is LIGGGHTS'."""
    x, y, z = values
    size = sqrt(x * x + y * y + z * z)
    if not 0.0 < size < inf:
        msg = f"axis {x:g} {y:g} {z:g} has no direction"
        raise ValueError(msg)
    unit: Floats = np.array(values) * (1.0 / size)
    return unit


def _linear(move: MoveMesh, rest: list[str]) -> None:
    need(rest, 3, "linear VX VY VZ")
    move.value[:3] = [number(word, "linear") for word in rest[:3]]


def _linear_variable(move: MoveMesh, rest: list[str]) -> None:
    need(rest, 3, "linear/variable v_VX v_VY v_VZ")
    move.kind = 6
    move.variables = [_variable(word) for word in rest[:3]]


def _variable(word: str) -> str:
    if not word.startswith("v_"):
        msg = f"expected a variable v_NAME, found '{word}'"
        raise ValueError(msg)
    return word[2:]


def _wiggle(move: MoveMesh, rest: list[str]) -> None:
    move.kind = 1
    move.value[:3] = _take(rest, "amplitude", 3)
    move.value[3] = _turns(rest, 1)[0]


def _rotate(move: MoveMesh, rest: list[str]) -> None:
    move.kind = 2
    move.value[:3] = _take(rest, "origin", 3)
    move.value[3:6] = _unit(_take(rest, "axis", 3))
    move.value[6] = _turns(rest, 1)[0]


def _rotate_variable(move: MoveMesh, rest: list[str]) -> None:
    move.kind = 7
    move.value[:3] = _take(rest, "origin", 3)
    move.value[3:6] = _unit(_take(rest, "axis", 3))
    if not rest or rest[0] != "omega":
        msg = "expected 'omega v_NAME'"
        raise ValueError(msg)
    need(rest, 2, "omega v_NAME")
    move.variables = [_variable(rest[1])]


def _riggle(move: MoveMesh, rest: list[str]) -> None:
    _rotate(move, rest)
    move.kind = 3
    move.value[7] = _take(rest, "amplitude", 1)[0] * pi / 180.0


def _waves(move: MoveMesh, rest: list[str]) -> None:
    """Read ``order n amplitude .. phase .. period ..``."""
    move.order = int(_take(rest, "order", 1)[0])
    if not 1 <= move.order <= 30:
        msg = f"order {move.order} is not between 1 and 30"
        raise ValueError(msg)
    for column, word in enumerate(("amplitude", "phase", "period")):
        values = _turns(rest, move.order) if word == "period" else _take(rest, word, move.order)
        move.value[WAVES + column : WAVES + 3 * move.order : 3] = values


def _viblin(move: MoveMesh, rest: list[str]) -> None:
    move.kind = 4
    move.value[3:6] = _unit(_take(rest, "axis", 3))
    _waves(move, rest)


def _vibrot(move: MoveMesh, rest: list[str]) -> None:
    move.kind = 5
    move.value[:3] = _take(rest, "origin", 3)
    move.value[3:6] = _unit(_take(rest, "axis", 3))
    _waves(move, rest)


_MOTIONS = {
    "linear": _linear,
    "linear/variable": _linear_variable,
    "wiggle": _wiggle,
    "rotate": _rotate,
    "rotate/variable": _rotate_variable,
    "riggle": _riggle,
    "viblin": _viblin,
    "vibrot": _vibrot,
}


_FLOW_WORDS = (
    "mesh", "count", "vec_side", "file", "writeTime", "screen", "delete_atoms",
    "point_at_outlet", "sum_property",
)  # fmt: skip


@fix("massflow/mesh")
def _massflow(engine: Engine, name: str, style: str, group: str, words: Sequence[str]) -> object:
    need(words, 4, "fix ID all massflow/mesh mesh MESH count once vec_side X Y Z")
    flow = MassFlow(name, style, engine.world.bit(group))
    rest = list(words)
    while rest:
        key = one_of(rest[0], _FLOW_WORDS, "massflow/mesh keyword")
        used = {"vec_side": 4, "writeTime": 1}.get(key, 2)
        need(rest, used, f"{key} " + "VALUE " * (used - 1))
        _flow_option(engine, flow, key, rest[1:used])
        rest = rest[used:]
    names = engine.world.meshes.names
    if flow.mesh not in names:
        msg = f"could not find fix mesh id '{flow.mesh}'{suggest(flow.mesh, names)}"
        raise ValueError(msg)
    if not flow.side.any():
        msg = "massflow/mesh needs 'vec_side X Y Z'"
        raise ValueError(msg)
    lo, hi = engine.world.meshes.span(flow.mesh)
    mesh = engine.world.fixes[flow.mesh]
    table = engine.world.meshes.table
    if isinstance(mesh, MeshSurface) and not is_planar(
        table.node[lo:hi], table.normal[lo:hi], mesh.limit
    ):
        msg = f"Fix massflow/mesh (id {name}): requires a planar face mass flow measurement"
        raise ValueError(msg)
    if abs(float(engine.world.meshes.table.normal[lo] @ flow.side)) < 1e-6:
        msg = "need to change 'vec_side', it is currently in or too close to the mesh plane"
        raise ValueError(msg)
    if flow.delete and not flow.once:
        msg = f"Fix massflow/mesh (id {name}): using 'delete_atoms yes' requires 'count once'"
        raise ValueError(msg)
    if flow.file is not None:
        flow.file.write(flow_header(write_time=flow.write_time))
    return flow


def _flow_option(engine: Engine, flow: MassFlow, key: str, values: Sequence[str]) -> None:
    """Apply one keyword of ``massflow/mesh``."""
    if key == "mesh":
        flow.mesh = values[0]
    elif key == "count":
        flow.once = one_of(values[0], ("once", "multiple"), "count") == "once"
    elif key == "vec_side":
        flow.side = _unit([number(word, key) for word in values])
    elif key == "file":
        flow.file = engine.open_text(values[0])
    elif key == "writeTime":
        flow.write_time = True
    elif key == "delete_atoms":
        flow.delete = yes_no(values[0], key)
    elif key != "screen":
        msg = f"massflow/mesh {key} is not supported"
        raise ValueError(msg)
