"""Dumps made of known grains, in the words of `dump custom`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from tests.paths import ROOT

DATA = ROOT / "tests" / "data" / "foreign"
"""What LIGGGHTS 3.8.0 wrote for `in.make` there."""


def known(count: int, seed: int = 1) -> dict[str, np.ndarray]:
    """Return columns of grains with numbers that six digits hold."""
    rng = np.random.default_rng(seed)
    columns = {name: np.round(rng.uniform(-0.1, 0.1, count), 5) for name in ("x", "y", "z")}
    columns |= {name: np.round(rng.normal(size=count), 4) for name in ("vx", "vy", "vz")}
    columns["radius"] = np.full(count, 0.003)
    return {"id": 1.0 + np.arange(count), "type": np.ones(count)} | columns


def frame_text(
    step: int,
    columns: Mapping[str, np.ndarray],
    names: Sequence[str] = (),
    *,
    behind: str = " ",
    between: str = " ",
) -> str:
    """Return a frame as LIGGGHTS writes it, with the columns in the order of `names`."""
    names = list(names or columns)
    rows = zip(*(columns[name] for name in names), strict=True)
    lines = [between.join(f"{value:g}" for value in row) + behind + "\n" for row in rows]
    count = len(columns[names[0]])
    return (
        f"ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n{count}\nITEM: BOX BOUNDS ff ff ff\n"
        f"-0.1 0.1\n-0.1 0.1\n-0.2 0.2\nITEM: ATOMS {' '.join(names)} \n{''.join(lines)}"
    )


def write_frames(folder: Path, counts: Sequence[int] = (5, 5, 5)) -> list[Path]:
    """Write one file for each frame, with so many grains, and return them."""
    folder.mkdir(parents=True, exist_ok=True)
    paths = [folder / f"f_{1000 * k}.dump" for k in range(len(counts))]
    for k, path in enumerate(paths):
        path.write_text(frame_text(1000 * k, known(counts[k], k)))
    return paths
