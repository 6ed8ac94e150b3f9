"""``dump ID GROUP mesh/stl N FILE [MESH ...]``: meshes where they are now."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from minidem.output.dump import DUMPS, Dump, write_whole
from minidem.output.text import stl_file
from minidem.words import Words, one_of
from minidem.world.world import World

__all__ = ["DumpStl"]


@DUMPS.register("mesh/stl", "stl")
@dataclass
class DumpStl(Dump):
    """``dump mesh/stl``: meshes where they are now.

    Attributes
    ----------
    meshes : tuple of str
        Ids of the meshes, empty for all.
    """

    meshes: tuple[str, ...] = ()

    def read_rest(self, world: World, words: Words) -> None:
        """Read the ids of meshes."""
        self.meshes = tuple(words.rest())
        for mesh in self.meshes:
            one_of(mesh, tuple(world.meshes.names), "mesh")

    def write(self, world: World, target: Path) -> None:
        """Write the triangles, mesh after mesh."""
        store = world.meshes
        spans = [store.span(name) for name in self.meshes or store.names]
        nodes = [store.table.node[lo:hi] for lo, hi in spans]
        write_whole(target, stl_file(np.concatenate([np.empty((0, 3, 3)), *nodes])))
