"""Restart files: everything a script needs to go on as if it had not been interrupted.

The format is minidem's own: a line with its version, the SHA-256 digest of all that follows, and an
uncompressed ``.npz`` archive (zip of numpy arrays, no pickled objects) with

- ``meta``: JSON text: step, types, groups, boundary, counters, and per fix its
  style and `Fix.state` (generators and counters of insertion, clocks of moving meshes ...);
- ``box``: (4, 3) corners now and as created, m;
- ``state_*``: per-particle arrays in internal order, see `minidem.world.state.State`;
- ``pairs_*`` and ``walls_*``: neighbour lists with contact histories;
- ``mesh_*``: triangles of all meshes where they are now.

After ``read_restart`` the script gives its fixes again, as with LIGGGHTS; the states are handed to
the fixes of the same name at the next run, which then is bit for bit a second run of the first
script.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from minidem.errors import InputError
from minidem.files import whole_file
from minidem.kernels.columns import REMEMBERED
from minidem.kernels.tables import Pairs
from minidem.world.fix import all_fixes
from minidem.world.settings import UNITS
from minidem.world.state import Box
from minidem.world.world import Restored, World

__all__ = ["MAGIC", "read_own", "write_restart"]

MAGIC: Final = b"minidem restart 5\n"
"""How a file begins; the number is that of the format."""
_FAMILY: Final = MAGIC[: MAGIC.rindex(b" ")]
_ARCHIVE: Final = b"PK"  # the first versions were bare archives
_DIGEST: Final = hashlib.sha256().digest_size
_PARTICLE: Final = (
    *("row", "spin", "force", "held", "flight", "image", "liquid"),
    *("kind", "mask", "ids", "rank", "density"),
)
_MESH: Final = ("node", "vel", "edge", "length", "normal", "held", "origin")


def write_restart(world: World, path: Path) -> None:
    """Write a restart file; it is complete or not there.

    Parameters
    ----------
    world : World
        State of the running script.
    path : Path
        Full path of the file.
    """
    arrays = _arrays(world)
    meta = json.dumps(_meta(world)).encode("utf-8")
    arrays["meta"] = np.frombuffer(meta, dtype=np.uint8)
    with whole_file(path, durable=True) as file:
        file.write(MAGIC + bytes(_DIGEST))
        np.savez(file, allow_pickle=False, **arrays)
        file.seek(len(MAGIC) + _DIGEST)
        digest = hashlib.file_digest(file, "sha256").digest()
        file.seek(len(MAGIC))
        file.write(digest)


def _meta(world: World) -> dict[str, Any]:
    return {
        "step": world.step,
        "units": world.materials.units,
        "dt": world.dt,
        "types": world.types,
        "particles": world.state.n,
        "lost": world.lost,
        "groups": world.groups,
        "boundary": list(world.need_box().boundary),
        "newton": world.newton,
        "ghost_velocity": world.ghost_velocity,
        "before": world.lists.before,
        "meshes": {name: list(world.meshes.span(name)) for name in world.meshes.names},
        "flows": list(world.flows),
        "fixes": {fix.name: {"style": fix.style, "state": fix.state()} for fix in all_fixes(world)},
    }


def _arrays(world: World) -> dict[str, NDArray[Any]]:
    state, lists, box = world.state, world.lists, world.need_box()
    n, before = state.n, lists.before
    arrays = {f"state_{name}": getattr(state, name)[:n] for name in _PARTICLE}
    arrays["state_marker"] = state.marker[:, :n]
    arrays["box"] = np.array([box.lo, box.hi, box.least_lo, box.least_hi])
    for kind, table, names in (
        ("pairs", lists.pairs, ("other", "touch", "hist")),
        ("walls", lists.walls, ("code", "touch", "hist")),
    ):
        used = int(table.start[before]) if before else 0
        arrays[f"{kind}_start"] = table.start[: before + 1]
        for name in names:
            arrays[f"{kind}_{name}"] = getattr(table, name)[:used]
    for name in _MESH:
        rows = getattr(world.meshes.table, name)
        arrays[f"mesh_{name}"] = rows if name == "origin" else rows[: world.meshes.count]
    # contacts with images are kept under the triangle itself
    code = arrays["walls_code"].copy()
    code[code >= 0] = world.meshes.table.base[code[code >= 0]]
    arrays["walls_code"] = code
    return arrays


def read_own(world: World, path: Path, name: str) -> None:
    """Take particles, box, groups and step from a restart file.

    Parameters
    ----------
    world : World
        A script before ``create_box``.
    path : Path
        Full path of the file.
    name : str
        Its name, as the script has it.

    Raises
    ------
    InputError
        If the file is missing, damaged or of another format.
    """
    arrays = _load(path, name)
    meta = json.loads(arrays["meta"].tobytes().decode("utf-8"))
    _restore(world, meta, arrays)
    world.restored = Restored(meta["fixes"], partial(_finish, meta, arrays))


def _load(path: Path, name: str) -> dict[str, NDArray[Any]]:
    """Read all arrays of a file that is as it was written; nothing in them is executed."""
    try:
        with path.open("rb") as file:
            head = file.read(len(MAGIC))
            digest = file.read(_DIGEST)
            intact = head == MAGIC and hashlib.file_digest(file, "sha256").digest() == digest
            if not intact:
                raise InputError(_fault(name[:80], head))
            file.seek(len(MAGIC) + _DIGEST)
            with np.load(file, allow_pickle=False) as archive:
                return {name: archive[name] for name in archive.files}
    except OSError as err:
        msg = f"cannot read restart file '{name[:80]}': {err.strerror}"
        raise InputError(msg) from err


def _fault(name: str, head: bytes) -> str:
    """Say why a file cannot be used."""
    if head == MAGIC:
        return (
            f"restart file '{name}' is damaged: it is cut or was changed after it was written; "
            "use an earlier one, or run again"
        )
    if head.startswith((_FAMILY, _ARCHIVE)):
        return f"restart file '{name}' is of another version of minidem; write it again with this"
    return f"'{name}' is no restart file of minidem or of LIGGGHTS"


def _restore(world: World, meta: Mapping[str, Any], arrays: dict[str, NDArray[Any]]) -> None:
    """Take particles, box and lists out of the arrays, each but once: they fill the memory."""
    state, lists = world.state, world.lists
    n, before = int(meta["particles"]), int(meta["before"])
    state.reserve(max(n, 1))
    for name in _PARTICLE:
        getattr(state, name)[:n] = arrays.pop(f"state_{name}")
    flows = len(meta["flows"])
    world.flows = tuple(str(name) for name in meta["flows"])
    state.marker = np.full((flows, state.cap), -1, np.int8)
    state.marker[:, :n] = arrays.pop("state_marker")
    state.n = n
    corners = np.asarray(arrays["box"], dtype=np.float64).reshape(4, 3)
    world.boundary = tuple(str(face) for face in meta["boundary"])
    world.box = Box(
        corners[0].copy(), corners[1].copy(), world.boundary, corners[2].copy(), corners[3].copy()
    )
    world.types, world.step, world.lost = (int(meta[key]) for key in ("types", "step", "lost"))
    # as in LIGGGHTS: a new clock, and units that differ bring their time step and skin
    world.clock = (world.step, 0.0)
    if (units := str(meta.get("units", world.materials.units))) != world.materials.units:
        world.set_units(units)
    world.groups = {str(name): int(bit) for name, bit in meta["groups"].items()}
    world.newton = bool(meta["newton"])
    world.granular = True
    world.ghost_velocity = bool(meta["ghost_velocity"])
    start = np.zeros(state.cap + 2, np.int64)
    start[: before + 1] = arrays.pop("pairs_start")
    other = arrays.pop("pairs_other")
    owner = np.zeros(len(other), np.uint32)
    owner[: start[before]] = np.repeat(np.arange(before), np.diff(start[: before + 1]))
    lists.all_pairs[lists.turned] = Pairs(
        start=start,
        owner=owner,
        other=other,
        touch=arrays.pop("pairs_touch"),
        hist=arrays.pop("pairs_hist"),
        soon=np.zeros_like(owner),
        found=np.zeros_like(start),
    )
    start = np.zeros(state.cap + 2, np.int64)
    start[: before + 1] = arrays.pop("walls_start")
    code = arrays.pop("walls_code")
    lists.all_walls[lists.turned] = lists.walls._replace(
        start=start,
        code=code,
        touch=arrays.pop("walls_touch"),
        hist=_widened(arrays.pop("walls_hist")),
        free=np.zeros(len(code)),
    )
    lists.before = before


def _widened(hist: NDArray[Any]) -> NDArray[Any]:
    """Return histories with all columns; files of earlier versions have fewer."""
    found = np.zeros((len(hist), REMEMBERED))
    found[:, : hist.shape[1]] = hist
    return found


def _finish(meta: Mapping[str, Any], arrays: Mapping[str, Any], world: World, last: bool) -> None:
    """Put the triangles where they were at the beginning of the first run."""
    if not last:
        return
    if world.dt == UNITS[world.materials.units][0] != meta["dt"]:
        world.warn(
            f"the time step is {world.dt:g}, as in LIGGGHTS, since restart files tell none; it "
            f"was {meta['dt']:g} when this one was written ('timestep {meta['dt']:g}')"
        )
    _restore_meshes(world, meta, arrays)


def _restore_meshes(world: World, meta: Mapping[str, Any], arrays: Mapping[str, Any]) -> None:
    """Put the triangles where they were."""
    meshes = world.meshes
    spans = {name: tuple(span) for name, span in meta["meshes"].items()}
    for name, span in spans.items():
        if name in meshes.names and meshes.span(name) != span:
            msg = f"mesh '{name}' is not the one of the restart file; give the meshes as before"
            raise InputError(msg)
    if list(spans) == meshes.names:
        for name in _MESH:
            rows = getattr(meshes.table, name)
            rows[: len(arrays[f"mesh_{name}"])] = arrays[f"mesh_{name}"]
