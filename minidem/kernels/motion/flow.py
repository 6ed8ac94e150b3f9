"""Count particles whose centre passes a mesh to its far side."""

from __future__ import annotations

from typing import Any

from minidem.kernels.columns import (  # isort: skip
    X, Y, Z, ONLY, RADIUS, VX, MASS, NEAR_FLOW, NEAR_TRIANGLE, NEAR_PARTICLE, FLOW_ONCE,
    FLOW_GROUP, FLOW_DELETE, FLOW_OUTLET, FLOW_POINT, FLOW_NORMAL, UNSEEN, BEFORE, BEHIND, COUNTED,
    EVENT_FLOW, EVENT_ID, EVENT_STEP, EVENT_POSITION, EVENT_VELOCITY, EVENT_RADIUS,
    EVENT_MASS,
)  # fmt: skip
from minidem.kernels.contact.triangle import closest
from minidem.kernels.machine.jit import inner

__all__ = ["count_through"]


@inner
def count_through(parts: Any, ids: Any, mesh: Any, flows: Any, count: int, step: int) -> None:
    """Update the markers of particles near flow meshes and note every passage.

    Parameters
    ----------
    parts, mesh, flows : tables
        See `minidem.kernels.tables`.
    ids : int64 (cap,)
        Particle ids.
    count : int
        Number of counters.
    step : int
        The step that is being made.
    """
    row = parts.row
    for p in range(flows.count[ONLY]):
        f = flows.pair[p, NEAR_FLOW]
        t = flows.pair[p, NEAR_TRIANGLE]
        i = flows.pair[p, NEAR_PARTICLE]
        if not parts.mask[i] & flows.spec[f, FLOW_GROUP]:
            continue
        mark = flows.marker[f, i]
        if mark == COUNTED:
            continue
        ax = row[i, X] - flows.value[f, FLOW_POINT + X]
        ay = row[i, Y] - flows.value[f, FLOW_POINT + Y]
        az = row[i, Z] - flows.value[f, FLOW_POINT + Z]
        if flows.spec[f, FLOW_OUTLET]:
            # behind the mesh its nearest point lies on the way from the outlet to the particle
            spot = closest(mesh, t, row[i, X], row[i, Y], row[i, Z])
            if spot.distance - row[i, RADIUS] >= row[i, RADIUS]:
                continue
            dot = -flows.spec[f, FLOW_OUTLET] * (spot.dx * ax + spot.dy * ay + spot.dz * az)
        else:
            dot = (
                ax * flows.value[f, FLOW_NORMAL + X]
                + ay * flows.value[f, FLOW_NORMAL + Y]
                + az * flows.value[f, FLOW_NORMAL + Z]
            )
        if mark == UNSEEN:
            flows.marker[f, i] = BEFORE if dot <= 0.0 else BEHIND
            continue
        if dot <= 0.0:
            flows.marker[f, i] = BEFORE
            continue
        face = closest(mesh, t, row[i, X], row[i, Y], row[i, Z]).face
        if face == 0:
            continue
        if mark == BEFORE and flows.found[ONLY] < flows.event.shape[0]:
            e = flows.found[ONLY]
            flows.found[ONLY] = e + 1
            flows.event[e, EVENT_FLOW] = f
            flows.event[e, EVENT_ID] = ids[i]
            flows.event[e, EVENT_STEP] = step
            for c in range(3):
                flows.event[e, EVENT_POSITION + c] = row[i, c]
                flows.event[e, EVENT_VELOCITY + c] = row[i, VX + c]
            flows.event[e, EVENT_RADIUS] = row[i, RADIUS]
            flows.event[e, EVENT_MASS] = row[i, MASS]
        if flows.spec[f, FLOW_DELETE] == 1:
            flows.marker[f, i] = UNSEEN
        else:
            flows.marker[f, i] = COUNTED if flows.spec[f, FLOW_ONCE] == 1 else BEHIND
