"""``dump ID GROUP xyz N FILE``: positions; ``image`` and ``movie`` are skipped with a warning."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np

from minidem.kernels.columns import POSITION
from minidem.output.dump import DUMPS, Dump, TextDump
from minidem.output.text import format_rows
from minidem.words import Words
from minidem.world.world import World

__all__ = ["DumpPicture", "DumpXyz"]


@DUMPS.register("xyz")
@dataclass
class DumpXyz(TextDump):
    """``dump xyz``: type and position of the particles, sorted by id."""

    def write(self, world: World, target: Path) -> None:
        """Append a snapshot, or write it to a file of its own."""
        state = world.state
        who = np.flatnonzero(world.member(self.bit))
        who = who[np.argsort(state.ids[who])]
        at = state.row[who, POSITION]
        columns = [state.kind[who].astype(np.int64) + 1, *(at[:, c] for c in range(3))]
        rows = "".join(
            line.removesuffix(" \n") + "\n"
            for line in format_rows(columns, ["%d", "%g", "%g", "%g"]).splitlines(keepends=True)
        )
        text = f"{len(who)}\nAtoms. Timestep: {world.step}\n{rows}"
        self.put(target, text)


@DUMPS.register("image", "movie")
@dataclass
class DumpPicture(Dump):
    """``dump image``: pictures, which are not made."""

    keywords: ClassVar[tuple[str, ...]] = (
        *Dump.keywords, "acolor", "adiam", "amap", "backcolor", "bcolor", "bdiam", "boxcolor",
        "bitrate", "color", "framerate", "thresh", "region", "sort",
    )  # fmt: skip

    def read_rest(self, world: World, words: Words) -> None:
        """Pass over all words and say what becomes of them."""
        words.rest()
        world.warn(
            f"dump {self.name}: minidem makes no pictures; '{self.style}' is skipped. "
            "ParaView shows the files of 'dump custom/vtk'"
        )

    def modify(self, key: str, words: Words) -> None:
        """Pass over all words."""
        del key
        words.rest()

    def act(self, world: World) -> None:
        """Write nothing."""
        self.last = world.step
