"""Passages through flow meshes: from the kernel's event buffer to counters and files."""

from __future__ import annotations

from minidem.fixes.wall import MassFlow
from minidem.kernels.tables import Flows
from minidem.world.world import World

__all__ = ["drain", "flow_header", "flow_row"]


def flow_header(*, write_time: bool) -> str:
    """Return the first line of a massflow file."""
    return "# ID" + (" time " if write_time else "") + " diameter x y z u v w  (ex ey ez, color)\n"


def flow_row(number: int, time: float | None, values: tuple[float, ...]) -> str:
    """Return one line: id, time if wanted, diameter, position, velocity."""
    shown = f"{number:d}" + ("" if time is None else f"  {time:4.4g} ")
    return shown + " " + " ".join(f"{v:4.4g}" for v in values) + "\n"


def drain(world: World, flows: Flows) -> None:
    """Book all passages noted since the last call."""
    count = int(flows.found[0])
    flows.found[0] = 0
    if count == 0:
        return
    fixes = world.of_kind(MassFlow)
    for event in flows.event[:count]:
        fix = fixes[int(event[0])]
        number = int(world.state.ids[int(event[1])])
        fix.mass += float(event[10])
        fix.number += 1
        if fix.delete:
            fix.doomed.add(number)
        if fix.file is not None:
            time = float(event[2]) * world.dt if fix.write_time else None
            values = (2.0 * float(event[9]), *(float(v) for v in event[3:9]))
            fix.file.write(flow_row(number, time, values))
