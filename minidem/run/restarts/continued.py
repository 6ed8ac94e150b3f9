"""Going on from a restart file of LIGGGHTS.

As with LIGGGHTS the script gives time step, contact model, walls, meshes and fixes again.
Particles, box, groups, contact histories, places of moving meshes and counters are in the file.
"""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt
from typing import Any

import numpy as np

from minidem.errors import InputError
from minidem.kernels.columns import (
    COUNTED,
    FLIGHT_FROM,
    FLIGHT_START,
    FLIGHT_STOP,
    FLIGHT_VELOCITY,
    LIQUID_CONTENT,
    LIQUID_FLUX,
    LIQUID_SOURCE,
    MASS,
    OMEGA,
    POSITION,
    RADIUS,
    UNSEEN,
    VELOCITY,
    three,
)
from minidem.kernels.motion.frames import facet_frames
from minidem.record import record
from minidem.run.loop import history_width
from minidem.run.restarts.fix_states import fix_states
from minidem.run.restarts.histories import restore_contacts
from minidem.run.restarts.liggghts_file import parse_restart
from minidem.run.restarts.liggghts_state import LiggghtsState
from minidem.world.fix import all_fixes
from minidem.world.mesh.facets import areas
from minidem.world.state import Box, Floats
from minidem.world.values.flights import RELEASE
from minidem.world.world import Restored, World

__all__ = ["continue_liggghts"]

_INSERTION = "insert/stream"
_FLIGHT = 14  # numbers of a particle in a stream, the first columns of Particles.flight
_FLOW = "massflow_"
_TRANSFER = "liquidtransfer"
_LIQUID = (
    ("surfaceLiquidContent", LIQUID_CONTENT),
    ("liquidFlux", LIQUID_FLUX),
    ("liquidSource", LIQUID_SOURCE),
)
_NODES = slice(1, 10)  # of the numbers of a triangle
_NUMBER, _WEAR, _LEAST = 10, 11, 11
_FAR = 1e50  # numbers whose products are numbers, too
_LONG = 2.0**50  # steps
_HEAD = 3  # numbers before the triangles: how many, numbers of each, numbers of the mesh
_POINT = slice(1, 4)  # reference point, of the numbers of a mesh with stress
_SERVO = "mesh/surface/stress/servo"


def continue_liggghts(
    world: World, data: bytes, blocks: Callable[[int], bytes] | None = None
) -> None:
    """Take particles, box, groups and step from a restart file of LIGGGHTS.

    Parameters
    ----------
    world : World
        A script before ``create_box``.
    data, blocks : bytes, callable
        See `minidem.run.restarts.liggghts_file.parse_restart`.

    Raises
    ------
    InputError
        If the file is damaged, or of what minidem does not have.
    """
    saved = parse_restart(data, blocks)
    world.boundary = saved.boundary
    world.box = Box(
        saved.lo.copy(), saved.hi.copy(), saved.boundary, saved.lo.copy(), saved.hi.copy()
    )
    world.types, world.step, world.clock = saved.types, saved.step, (saved.step, 0.0)
    if saved.units != world.materials.units:
        world.set_units(saved.units)
    world.groups = dict(saved.groups)
    world.granular = True
    _take_particles(world, saved)
    fixes = fix_states(saved)
    if _LIQUID[0][0] in saved.kept:
        fixes.setdefault(_TRANSFER, {"style": "transportequation/scalar", "state": {}})
    world.restored = Restored(fixes, _Rest(saved))


def _take_particles(world: World, saved: LiggghtsState) -> None:
    """Fill the rows; flights, passages and liquid are there if fixes of the file keep them."""
    state, n = world.state, len(saved.ids)
    state.reserve(max(n, 1))
    state.row[:n, POSITION], state.row[:n, VELOCITY] = saved.position, saved.velocity
    state.row[:n, RADIUS], state.row[:n, MASS] = saved.radius, saved.mass
    state.spin[:n], state.force[:n], state.liquid[:n] = 0.0, 0.0, 0.0
    state.spin[:n, OMEGA] = saved.omega
    state.held[:n], state.image[:n], state.ids[:n] = saved.position, saved.image, saved.ids
    state.kind[:n], state.mask[:n] = saved.kind - 1, saved.mask
    state.rank[:n], state.density[:n] = np.arange(n), saved.density
    state.flight[:n] = 0.0
    state.flight[:n, FLIGHT_STOP] = -1.0
    if RELEASE in saved.kept:
        flight = saved.of_atoms(RELEASE, _FLIGHT)
        sound = (np.abs(flight) < _FAR).all(axis=1)
        flown = sound & (flight[:, FLIGHT_START] != 0.0) & (flight[:, FLIGHT_STOP] >= 0.0)
        state.flight[:n, :_FLIGHT][flown] = flight[flown]
    for name, column in _LIQUID:
        if name in saved.kept:
            state.liquid[:n, column] = saved.of_atoms(name, 1).ravel()
    flows = [name for name in saved.kept if name.startswith(_FLOW)]
    world.flows = tuple(name[len(_FLOW) :] for name in flows)
    state.marker = np.full((len(flows), state.cap), UNSEEN, np.int8)
    for row, name in enumerate(flows):
        state.marker[row, :n] = np.nan_to_num(saved.of_atoms(name, 1).ravel()).clip(UNSEEN, COUNTED)
    state.n = n


@record
class _Rest:
    """What fixes do not do for themselves.

    Attributes
    ----------
    saved : LiggghtsState
        The restart file.
    timed : bool
        Whether flights have been timed anew.
    """

    saved: LiggghtsState
    timed: bool = False

    def __call__(self, world: World, last: bool) -> None:
        """Time flights anew; at the first run put meshes where they were, let contacts go on."""
        if not self.timed:
            _time_flights(world)
            self.timed = True
        if last:
            _finish(self.saved, world)


def _time_flights(world: World) -> None:
    """Work out when particles of a stream are set free, with the time step of the script.

    LIGGGHTS finds the old time step from the way they have made; its rounding may make a flight
    one step shorter. Without a stream in the script they are free at once.
    """
    state, n = world.state, world.state.n
    flight = state.flight[:n]
    if all(fix.style != _INSERTION for fix in all_fixes(world)):
        flight[:, FLIGHT_STOP] = -1.0
        return
    for row in np.flatnonzero(flight[:, FLIGHT_STOP] > world.step):
        way = _length(state.row[row, POSITION] - flight[row, three(FLIGHT_FROM)])
        speed = _length(flight[row, three(FLIGHT_VELOCITY)])
        passed = world.step - flight[row, FLIGHT_START]
        left = flight[row, FLIGHT_STOP] - world.step
        if speed * passed > 0.0:
            ratio = way / (speed * passed) / world.dt
            flight[row, FLIGHT_STOP] = world.step + int(min(ratio * left, _LONG))


def _length(vector: Floats) -> float:
    x, y, z = vector.tolist()
    return float(sqrt(x * x + y * y + z * z))


def _finish(saved: LiggghtsState, world: World) -> None:
    """Put the triangles where they were, and let contacts go on, at the first run."""
    for mesh in map(world.fixes.__getitem__, world.meshes.names):
        style, wrote = saved.fixes.get(mesh.name, ("", np.zeros(0)))
        if style == mesh.style:
            _place(world, mesh, wrote)
    restore_contacts(world, saved, history_width(world))


def _place(world: World, mesh: Any, wrote: Floats) -> None:
    """Put the triangles of a mesh where they were, with its reference point and its wear."""
    lo, hi = world.meshes.span(mesh.name)
    count = hi - lo
    size = int(wrote[1]) + 1 if len(wrote) > _HEAD and 0.0 < wrote[1] < _FAR else 0
    end = _HEAD + count * size
    known = size >= _LEAST and wrote[0] == count and end <= len(wrote)
    if not known or not (np.abs(wrote[:end]) < _FAR).all():
        msg = f"mesh '{mesh.name}' is not the one of the restart file; give the meshes as before"
        raise InputError(msg)
    rows = wrote[_HEAD:end].reshape(count, size)
    rows = rows[np.argsort(rows[:, _NUMBER], kind="stable")]
    table = world.meshes.table
    table.node[lo:hi] = table.held[lo:hi] = rows[:, _NODES].reshape(count, 3, 3)
    facet_frames(table, lo, hi)
    own = wrote[end:]
    if mesh.stress and len(own) > _POINT.stop:
        table.origin[world.meshes.names.index(mesh.name)] = own[_POINT]
    if mesh.wears and mesh.facets is not None and size > _WEAR:
        mesh.facets.worn = rows[:, _WEAR] * areas(table.node[lo:hi])
    if mesh.style == _SERVO:
        world.warn(
            f"mesh {mesh.name}: restart files of LIGGGHTS do not keep what a servo remembers; its "
            "controller begins anew, and the mesh is where it was"
        )
