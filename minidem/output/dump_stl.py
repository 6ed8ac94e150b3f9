"""``dump ID GROUP mesh/stl N FILE [MESH|WORD ...]``: meshes where they are now."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from minidem.errors import InputError
from minidem.output.dump import DUMPS, Dump, write_snapshot
from minidem.output.text.stl import binary_stl_file, stl_file
from minidem.record import record
from minidem.words import Words, one_of
from minidem.world.world import World

__all__ = ["DumpStl"]


@DUMPS.register("mesh/stl", "stl")
@record
class DumpStl(Dump):
    """``dump mesh/stl``: meshes where they are now.

    Attributes
    ----------
    meshes : tuple of str
        Ids of the meshes, empty for all.
    region : str
        Only triangles whose centre is in this region; empty for all.
    binary : bool
        Whether the file is binary.
    """

    meshes: tuple[str, ...] = ()
    region: str = ""
    binary: bool = False

    def read_rest(self, world: World, words: Words) -> None:
        """Read ids of meshes, and words among them as LIGGGHTS does."""
        while not words.done():
            word = words.take("a mesh")
            if word.startswith("binary"):
                self.binary = True
            elif word == "region":
                self.region = one_of(words.take("a region"), tuple(world.regions), "region")
            elif word in ("all", "ghost"):
                _refuse_images(world, word)
            elif word != "local":
                self.meshes += (one_of(word, tuple(world.meshes.names), "mesh"),)

    def write(self, world: World, target: Path) -> None:
        """Write the triangles, mesh after mesh."""
        store = world.meshes
        spans = [store.span(name) for name in self.meshes or store.names]
        nodes = [store.table.node[lo:hi] for lo, hi in spans]
        triangles = self._chosen(world, np.concatenate([np.empty((0, 3, 3)), *nodes]))
        if self.binary:
            write_snapshot(target, binary_stl_file(triangles))
        else:
            write_snapshot(target, stl_file(triangles))

    def _chosen(self, world: World, triangles: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the triangles whose centres are in the region."""
        if not self.region:
            return triangles
        if self.region not in world.regions:
            msg = f"Region ID '{self.region}' for dump {self.style} does not exist"
            raise InputError(msg)
        inside: NDArray[np.bool_] = world.regions[self.region].match(triangles.mean(axis=1))
        return triangles[inside]


def _refuse_images(world: World, word: str) -> None:
    """Refuse images of meshes through periodic faces; without such a face ``all`` has none."""
    if word == "ghost" or world.need_box().period().any():
        msg = (
            f"dump mesh/stl: '{word}' asks for images of meshes beyond periodic faces, which are "
            "not written; write 'local' or leave it out"
        )
        raise InputError(msg)
