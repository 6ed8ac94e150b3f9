"""``dump ID GROUP euler/vtk N FILE``: the means of a ``fix ave/euler``, cell by cell."""

from __future__ import annotations

from pathlib import Path

from minidem.errors import InputError
from minidem.output.averages.euler import AverageEuler
from minidem.output.dump import DUMPS, Dump, write_snapshot
from minidem.words import Words
from minidem.world.world import World

__all__ = ["DumpEuler"]


@DUMPS.register("euler/vtk")
class DumpEuler(Dump):
    """``dump euler/vtk``: centres of the cells with velocity, volume fraction and so on."""

    def read_rest(self, world: World, words: Words) -> None:
        """Refuse a name that would hold several steps."""
        del world, words
        self.refuse_names("%")
        if "*" not in self.path:
            msg = f"dump euler/vtk: '{self.path[:40]}' needs a * for the step, as in euler_*.vtk"
            raise InputError(msg)

    def write(self, world: World, target: Path) -> None:
        """Write a snapshot to a file of its own."""
        fixes = world.of_kind(AverageEuler)
        if not fixes or fixes[0].cells is None:
            msg = f"dump {self.name} (euler/vtk) needs a fix ave/euler; give one before the run"
            raise InputError(msg)
        cells = fixes[0].cells
        centres = cells.centres()
        count = len(centres)
        lines = [
            "# vtk DataFile Version 2.0", "LIGGGHTS mesh/VTK export", "ASCII", "DATASET POLYDATA",
            f"POINTS {count} float", *(f"{x:f} {y:f} {z:f}" for x, y, z in centres.tolist()),
            f"VERTICES {count} {2 * count}", *(f"1 {k}" for k in range(count)),
            f"POINT_DATA {count}", "VECTORS v_avg float",
            *(f"{x:f} {y:f} {z:f}" for x, y, z in cells.velocity.tolist()),
        ]  # fmt: skip
        for name, values in (
            ("volumefraction", cells.fraction), ("radius", cells.radius),
            ("pressure", cells.pressure),
        ):  # fmt: skip
            lines += [f"SCALARS {name} float 1", "LOOKUP_TABLE default"]
            lines += [f"{value:f}" for value in values.tolist()]
        write_snapshot(target, "\n".join(lines) + "\n")
