"""Many independent cases in one script, so that a campaign costs few starts of LIGGGHTS."""

from __future__ import annotations

import hashlib
import re
import subprocess
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from minidem import run_script

SCRIPT = "in.script"
NUMBER = re.compile(r"-?\d+\.\d+(?:e[-+]\d+)?")
Tables = dict[str, np.ndarray]


@dataclass(frozen=True)
class Batch:
    """A script with all that it reads.

    Attributes
    ----------
    name : str
        Unique within a family.
    script : str
        Runs unchanged on both engines.
    files : mapping of str to str
        Name and text of files beside it.
    outputs : tuple of str
        Dump files that it writes, all frames in one file.
    cases : int
        How many independent cases it holds.
    """

    name: str
    script: str
    outputs: tuple[str, ...]
    cases: int
    files: Mapping[str, str] = field(default_factory=dict)

    def digest(self) -> str:
        """Return a digest of the inputs, with numbers to nine digits.

        The last digits of a sine depend on the processor that NumPy finds.
        """
        texts = [self.script, *(f"{name}\n{text}" for name, text in sorted(self.files.items()))]
        rounded = NUMBER.sub(lambda found: f"{float(found[0]):.9g}", "\0".join(texts))
        return hashlib.sha256(rounded.encode()).hexdigest()


def run(batch: Batch, engine: str) -> Tables:
    """Run a batch with ``minidem`` or ``liggghts`` and return its dumps.

    Returns
    -------
    dict
        Name of the dump to its rows, shape (rows, 1 + columns); the first column is the step.
    """
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file, text in {**batch.files, SCRIPT: batch.script}.items():
            (folder / file).write_text(text)
        if engine == "liggghts":
            # stdbuf: else some errors are lost; timeout: where coordinates are no numbers it hangs
            command = ["timeout", "120", "stdbuf", "-oL", "liggghts", "-in", SCRIPT]
            done = subprocess.run(command, cwd=folder, capture_output=True, check=False)
            assert done.returncode == 0, done.stdout.decode(errors="replace")[-2000:]
        else:
            run_script(folder / SCRIPT, root=folder, log=None)
        return {output: _read(folder / output) for output in batch.outputs}


def _read(path: Path) -> np.ndarray:
    """Return the rows of a dump, or of a text file of numbers."""
    return read_frames(path) if path.suffix == ".dump" else read_numbers(path)


def read_numbers(path: Path) -> np.ndarray:
    """Return the rows of a text file of numbers with comments."""
    lines = path.read_text().splitlines() if path.exists() else []
    rows = [list(map(float, line.split())) for line in lines if not line.startswith("#")]
    return np.array(rows).reshape(len(rows), -1 if rows else 0)


def read_frames(path: Path) -> np.ndarray:
    """Return all rows of a dump with several frames, each row after the step of its frame."""
    rows: list[list[float]] = []
    width, step = 0, 0.0
    lines = iter(path.read_text().splitlines())
    for line in lines:
        if line.startswith("ITEM: TIMESTEP"):
            step = float(next(lines))
        elif line.startswith("ITEM: NUMBER"):
            next(lines)
        elif line.startswith("ITEM: BOX"):
            for _ in range(3):
                next(lines)
        elif line.startswith("ITEM: ATOMS"):
            width = len(line.split()) - 1
        else:
            rows.append([step, *map(float, line.split())])
    return np.array(rows).reshape(len(rows), -1 if rows else width)
