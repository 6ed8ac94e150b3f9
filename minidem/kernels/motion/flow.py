"""Count particles whose centre passes a mesh to its far side."""

from __future__ import annotations

from typing import Any

from minidem.kernels.contact.triangle import closest
from minidem.kernels.machine.jit import inner

__all__ = ["count_through"]


@inner
def count_through(parts: Any, mesh: Any, flows: Any, count: int, step: int) -> None:
    """Update the markers of particles near flow meshes and note every passage.

    Parameters
    ----------
    parts, mesh, flows : tables
        See `minidem.kernels.tables`.
    count : int
        Number of counters.
    step : int
        The step that is being made.
    """
    row = parts.row
    for p in range(flows.count[0]):
        f = flows.pair[p, 0]
        t = flows.pair[p, 1]
        i = flows.pair[p, 2]
        if not parts.mask[i] & flows.spec[f, 1]:
            continue
        mark = flows.marker[f, i]
        if mark == 2:
            continue
        dot = (
            (row[i, 0] - flows.value[f, 0]) * flows.value[f, 3]
            + (row[i, 1] - flows.value[f, 1]) * flows.value[f, 4]
            + (row[i, 2] - flows.value[f, 2]) * flows.value[f, 5]
        )
        if mark == -1:
            flows.marker[f, i] = 0 if dot <= 0.0 else 1
            continue
        if dot <= 0.0:
            flows.marker[f, i] = 0
            continue
        face = closest(
            mesh.node, mesh.edge, mesh.length, mesh.normal, mesh.flags, mesh.bound, t,
            row[i, 0], row[i, 1], row[i, 2],
        )[7]  # fmt: skip
        if face == 0:
            continue
        if mark == 0 and flows.found[0] < flows.event.shape[0]:
            e = flows.found[0]
            flows.found[0] = e + 1
            flows.event[e, 0] = f
            flows.event[e, 1] = i
            flows.event[e, 2] = step
            for c in range(3):
                flows.event[e, 3 + c] = row[i, c]
                flows.event[e, 6 + c] = row[i, 4 + c]
            flows.event[e, 9] = row[i, 3]
            flows.event[e, 10] = row[i, 7]
        if flows.spec[f, 3] == 1:
            flows.marker[f, i] = -1
        else:
            flows.marker[f, i] = 2 if flows.spec[f, 0] == 1 else 1
