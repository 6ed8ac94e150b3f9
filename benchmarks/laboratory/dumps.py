"""How fast text dumps become tables, against pandas alone and against the former reader.

    python benchmarks/laboratory/dumps.py [--mb 200] [--grains 20000] [--gzip]

A file of many frames is generated in a temporary folder, in the words and digits of LIGGGHTS.
Printed are megabytes of text per second of processor time, the best of three, and the memory that
reading takes at its most. `pandas.read_csv` gets the rows of all frames in pieces, without their
heads and without a check; the former reader split the text of a frame into Python's words.
"""

from __future__ import annotations

import argparse
import gzip
import io
import tempfile
import time
import tracemalloc
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd

from liggghts_io.foreign import read_output
from liggghts_io.measure.text_dump.blocks import Block, blocks_of
from liggghts_io.measure.text_dump.head import head_of

COLUMNS = ("id", "type", "x", "y", "z", "vx", "vy", "vz", "fx", "fy", "fz", "radius")
REPEATS = 3
MB = 1e6


def write_dump(path: Path, size_mb: float, grains: int) -> None:
    """Write frames of moving grains until the file has its size."""
    rng = np.random.default_rng(20191111)
    numbers = rng.normal(scale=0.01, size=(grains, len(COLUMNS) - 3))
    rows = [
        f"{k} 1 " + " ".join(f"{value:g}" for value in row) + " 0.0015 \n"
        for k, row in enumerate(numbers, start=1)
    ]
    body = "".join(rng.permutation(np.array(rows, dtype=object)))
    with path.open("w") as file:
        for frame in range(max(round(size_mb * MB / len(body)), 1)):
            file.write(
                f"ITEM: TIMESTEP\n{1000 * frame}\nITEM: NUMBER OF ATOMS\n{grains}\n"
                "ITEM: BOX BOUNDS ff ff ff\n-0.1 0.1\n-0.1 0.1\n-0.1 0.1\n"
                f"ITEM: ATOMS {' '.join(COLUMNS)} \n{body}"
            )


def ours(path: Path) -> int:
    """Return the number of rows, read as `bulkcal post` reads them: all frames, checked."""
    return sum(len(frame.grains) for frame in read_output(path).frames())


def rows_in(block: Block) -> bytes:
    """Return the rows of a frame as bytes."""
    return block.content[head_of(block).size :]


def pandas_alone(path: Path) -> int:
    """Return the number of rows, read by pandas without heads and checks."""
    count = 0
    for block in blocks_of(path):
        rows = io.BytesIO(rows_in(block))
        count += len(pd.read_csv(rows, sep=" ", header=None, usecols=range(len(COLUMNS))))
    return count


def former(path: Path) -> int:
    """Return the number of rows, read word by word."""
    count = 0
    for block in blocks_of(path):
        lines = rows_in(block).decode("ascii").splitlines()
        table = np.array(" ".join(lines).split(), dtype=np.float64)
        count += len(table.reshape(-1, len(COLUMNS)))
    return count


def seconds_of(read: Callable[[Path], int], path: Path) -> float:
    """Return the least processor time of a few readings [s]."""
    times = []
    for _ in range(REPEATS):
        started = time.process_time()
        read(path)
        times.append(time.process_time() - started)
    return min(times)


def peak_mb(read: Callable[[Path], int], path: Path) -> float:
    """Return the most memory that reading takes [MB]."""
    tracemalloc.start()
    read(path)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    return most / MB


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--mb", type=float, default=200.0, help="size of the text")
    parser.add_argument("--grains", type=int, default=20_000, help="rows of a frame")
    parser.add_argument("--gzip", action="store_true", help="read it compressed")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "run.dump"
        write_dump(path, asked.mb, asked.grains)
        size = path.stat().st_size / MB
        if asked.gzip:
            packed = Path(f"{path}.gz")
            packed.write_bytes(gzip.compress(path.read_bytes(), compresslevel=1))
            path.unlink()
            path = packed
        print(f"{size:.0f} MB in frames of {asked.grains} grains{', gzip' if asked.gzip else ''}")
        speeds = {}
        for name, read in {"bulkcal": ours, "pandas alone": pandas_alone, "former": former}.items():
            speeds[name] = size / seconds_of(read, path)
            ratio = speeds["bulkcal"] / speeds[name]
            print(f"{name:14s} {speeds[name]:7.1f} MB/s   bulkcal is {ratio:.2f} times as fast")
        print(f"memory of bulkcal: {peak_mb(ours, path):.0f} MB at most")


if __name__ == "__main__":
    main()
