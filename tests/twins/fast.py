"""The engine on a scene. The only place here that knows how the engine keeps its data."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np

from minidem import run_script, simulate
from minidem.kernels.columns import SPENT, WIDE
from tests.twins.scene import Scene, stl_text
from tests.twins.slow.step import Key, Outcome
from tests.twins.slow.touch import History


def run(scene: Scene, folder: Path) -> Outcome:
    """Run a scene in a folder with minidem and return what its engine holds at the end."""
    for k, mesh in enumerate(scene.meshes):
        (folder / f"mesh{k}.stl").write_text(stl_text(mesh))
    (folder / "in.script").write_text(scene.script())
    made: list[Any] = []

    class Kept(simulate.Engine):
        """An engine that is still there when the script is over."""

        def __init__(self, *words: Any, **more: Any) -> None:
            super().__init__(*words, **more)
            made.append(self)

    with patch.object(simulate, "Engine", Kept):
        summary = run_script(folder / "in.script", root=folder, log=None)
    return _outcome(made[0].world, summary.builds)


def _outcome(world: Any, builds: int) -> Outcome:
    state, lists = world.state, world.lists
    n = state.n
    ids = state.ids[:n]
    order = np.argsort(ids)
    pairs, near_pairs = _pairs(lists.pairs, n, ids)
    walls, near_walls = _walls(lists.walls, n, ids, world.meshes.table.base)
    return Outcome(
        world.unwrapped()[order],
        state.row[order, 4:7],
        state.spin[order, :3],
        state.force[order, :3],
        state.force[order, 3:6],
        pairs,
        {(i, -1 - code): found for (i, code), found in walls.items() if code < 0},
        {(i, code): found for (i, code), found in walls.items() if code >= 0},
        near_pairs,
        {(i, -1 - code) for i, code in near_walls if code < 0},
        {(i, code) for i, code in near_walls if code >= 0},
        state.held[order],
        builds,
        float(world.law[0].real[WIDE]),
        bool(world.law[0].real[SPENT] > 0.0),
    )


def _history(row: np.ndarray, sign: float) -> History:
    """Return a row of a history table, see `minidem.kernels.columns`."""
    wide = np.zeros(10)
    wide[: len(row[:10])] = row[:10]
    loaded = (float(value) for value in wide[7:])
    return History(sign * wide[:3], sign * wide[3:6], abs(float(wide[6])), *loaded)


def _pairs(pairs: Any, n: int, ids: np.ndarray) -> tuple[dict[Key, History], set[Key]]:
    """Return the histories of pairs that have touched, and all pairs of the list."""
    touched, near = {}, set()
    for i in range(n):
        for k in range(pairs.start[i], pairs.start[i + 1]):
            a, b = int(ids[i]), int(ids[pairs.other[k]])
            key = (min(a, b), max(a, b))
            near.add(key)
            if pairs.touch[k]:
                touched[key] = _history(pairs.hist[k], 1.0 if a < b else -1.0)
    return touched, near


def _walls(
    walls: Any, n: int, ids: np.ndarray, base: np.ndarray
) -> tuple[dict[Key, History], set[Key]]:
    """Return the histories of walls in contact and all candidates; primitives as -1 - number."""
    touched, near = {}, set()
    for i in range(n):
        for k in range(walls.start[i], walls.start[i + 1]):
            code = int(walls.code[k])
            key = (int(ids[i]), code if code < 0 else int(base[code]))
            near.add(key)
            if walls.touch[k]:
                touched[key] = _history(walls.hist[k], 1.0)
    return touched, near
