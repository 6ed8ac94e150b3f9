"""Let a child process read VTK files, so that a damaged one ends that process and not ours."""

from __future__ import annotations

import io
import os
import re
import subprocess
import sys
import threading
from pathlib import Path
from types import TracebackType
from typing import Final

import numpy as np
import numpy.typing as npt
import pandas as pd

from liggghts_io.errors import DamagedFile
from liggghts_io.foreign.columns import split_vectors

_PROGRAM: Final = Path(__file__).with_name("vtk_child.py")
_WORD: Final = 8  # bytes of a length
_LIMIT_S: Final = 120.0  # for one file, of gigabytes too
_LINE: Final = re.compile(r"at line (\d+)")
_SELF: Final = re.compile(r"(ERROR|Warning): In \S+ line \d+|vtk\w+ \(0x[0-9a-f]+\): ")
_DECADES: Final = 12.0  # between one and a place of grains, in any unit of length
_SHOWN: Final = 120  # characters of what VTK says
TAKE_OUT: Final = "; take it out"
"""What to do about a damaged file in the midst of others, at the end of messages."""


class VtkReader:
    """Reads one VTK file after the other in a child process that is started at the first one."""

    def __init__(self) -> None:
        self._child: subprocess.Popen[bytes] | None = None

    def __enter__(self) -> VtkReader:
        """Return itself."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """End the child."""
        self._end()

    def read(self, path: Path) -> pd.DataFrame:
        """Return the points of a file with their data, vectors by their components.

        Raises
        ------
        DamagedFile
            If VTK cannot read it.
        """
        if "\n" in str(path.resolve()):
            msg = f"{path!r}: a name with a line break; give the file another one"
            raise DamagedFile(msg)
        answer = self._ask(path)
        with np.load(io.BytesIO(answer), allow_pickle=False) as packed:
            if "error" in packed:
                msg = f"{path}: {packed['error']}{TAKE_OUT}"
                raise DamagedFile(msg)
            if "said" in packed:
                raise DamagedFile(_told(path, str(packed["said"])))
            points = packed["points"]
            arrays = {str(name): packed[str(k)] for k, name in enumerate(packed["names"])}
        if _is_turned(points):
            msg = (
                f"{path}: most places are above 1e{_DECADES:.0f} or below 1e-{_DECADES:.0f}, as "
                "where bytes of numbers stand in the other order; a binary '# vtk' file has the "
                "most significant one first, an XML file says byte_order; write it anew, or as text"
            )
            raise DamagedFile(msg)
        wrong = [name for name, values in arrays.items() if len(values) != len(points)]
        if wrong:
            msg = f"{path}: {len(points)} points, but {len(arrays[wrong[0]])} values of {wrong[0]}"
            raise DamagedFile(msg)
        numbers = {name: np.asarray(values, dtype=np.float64) for name, values in arrays.items()}
        grains = split_vectors(numbers).assign(**dict(zip("xyz", points.T, strict=True)))
        bad = [str(name) for name in grains if not np.isfinite(grains[name]).all()]
        if bad:
            msg = f"{path}: {bad[0]} holds a value that is no finite number{TAKE_OUT}"
            raise DamagedFile(msg)
        return grains.astype(np.float64)

    def _ask(self, path: Path) -> bytes:
        """Return the answer of the child to a path; without one, say that it died or hung."""
        child = self._running()
        timer = threading.Timer(_LIMIT_S, child.kill)
        timer.start()
        try:
            answer = _answer_of(child, path)
        except OSError:  # it died before it read the question
            answer = b""
        finally:
            timer.cancel()
        if not answer:
            self._end()
            msg = f"{path}: VTK gives up on it, the file is damaged{TAKE_OUT}"
            raise DamagedFile(msg)
        return answer

    def _running(self) -> subprocess.Popen[bytes]:
        if self._child is None:
            self._child = subprocess.Popen(
                [sys.executable, "-P", str(_PROGRAM)],
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
            )  # fmt: skip
        return self._child

    def _end(self) -> None:
        if self._child is not None:
            self._child.kill()
            self._child.communicate()
            self._child = None


def _is_turned(points: npt.NDArray[np.float64]) -> bool:
    """Whether places are as far from one as those whose bytes are read in the wrong order."""
    sizes = np.abs(points[(points != 0.0) & np.isfinite(points)])
    return len(sizes) > 0 and bool(np.median(np.abs(np.log10(sizes))) > _DECADES)


def _answer_of(child: subprocess.Popen[bytes], path: Path) -> bytes:
    """Return what the child says of a path, b"" where it ends within its answer."""
    if child.stdin is None or child.stdout is None:
        return b""
    child.stdin.write(os.fsencode(path.resolve()) + b"\n")
    child.stdin.flush()
    size = int.from_bytes(child.stdout.read(_WORD), "little")
    answer = child.stdout.read(size)
    return answer if len(answer) == size else b""


def _told(path: Path, said: str) -> str:
    """Return a message from what VTK says about a file."""
    line = _LINE.search(said)
    words = _SELF.sub("", said)[:_SHOWN].strip()
    place = f"{path}{f':{line[1]}' if line else ''}"
    return f"{place}: VTK cannot read it: {words}{TAKE_OUT}"
