"""Column ``height_mm`` of ``dump custom``: height of the lowest point of a particle in mm."""

from __future__ import annotations

from minidem.output.columns import column
from minidem.world.state import Floats
from minidem.world.world import World


@column("height_mm")
def height_mm(world: World) -> Floats:
    """Return the height of each particle."""
    row = world.state.row[: world.state.n]
    return 1000.0 * (row[:, 2] - row[:, 3])
