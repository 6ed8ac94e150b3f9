"""Machine code of kernels: kept on disk, loaded without Numba, made anew when damaged."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from minidem.kernels.insertion.random import draw_gaussian, skip
from minidem.kernels.machine.cache import FREE
from minidem.kernels.machine.library import LIBRARY, linker
from minidem.kernels.machine.native import Native
from tests.paths import ROOT

DRAW = """
import sys
from pathlib import Path
import numpy as np
from minidem.kernels.machine import cache
cache.SHIPPED = Path("no machine code came with this package")
from minidem.kernels.insertion.random import draw_gaussian
from minidem.kernels.machine.cache import cache_folder
drawn = draw_gaussian(np.array([1.0, 0.0, 0.0]))
needed = [name for name in ("numba", "llvmlite") if name in sys.modules]
print(drawn, *needed[:1] or ["nothing"], cache_folder())
"""


def polar() -> float:
    """Return the first normal number of the minimal standard generator with seed 1."""
    seed = 1
    while True:
        first, second = (seed := seed * 16807 % 2147483647), (seed := seed * 16807 % 2147483647)
        x, y = (2.0 * one / 2147483647 - 1.0 for one in (first, second))
        if 0.0 < x * x + y * y < 1.0:
            return y * math.sqrt(-2.0 * math.log(x * x + y * y) / (x * x + y * y))


FIRST = pytest.approx(polar(), rel=1e-14)  # the scale of the generator is rounded
LOADER = "llvmlite" if linker() is None else "nothing"
pytestmark = pytest.mark.skipif(not FREE, reason="kernels are not machine code in this process")


def drawing(cache: Path, scratch: Path) -> subprocess.Popen[str]:
    """Start a new process that draws a number."""
    scratch.mkdir(exist_ok=True)
    env = {
        **os.environ, "PYTHONPATH": str(ROOT), "XDG_CACHE_HOME": str(cache),
        "TMPDIR": str(scratch),
    }  # fmt: skip
    return subprocess.Popen(
        [sys.executable, "-c", DRAW], env=env, stdout=subprocess.PIPE, text=True
    )


def drawn(process: subprocess.Popen[str]) -> tuple[float, str, Path]:
    """Return the number, what was imported to compile or load, and the cache."""
    said = process.communicate()[0]
    assert process.returncode == 0
    number, needed, folder = said.split()
    return float(number), needed, Path(folder)


def draw(cache: Path, scratch: Path) -> tuple[float, str, Path]:
    """Draw a number in a new process."""
    return drawn(drawing(cache, scratch))


def test_second_process_needs_no_numba(tmp_path):
    assert draw(tmp_path / "cache", tmp_path)[:2] == (FIRST, "numba")
    assert draw(tmp_path / "cache", tmp_path)[:2] == (FIRST, LOADER)


@pytest.mark.skipif(sys.platform == "win32", reason="this system has no such locks")
def test_of_processes_that_start_at_once_one_compiles(tmp_path):
    started = [drawing(tmp_path / "cache", tmp_path) for _ in range(3)]
    found = [drawn(process) for process in started]
    assert [number for number, _, _ in found] == [FIRST] * 3
    assert [needed for _, needed, _ in found].count("numba") == 1


def test_damaged_machine_code_is_made_anew(tmp_path):
    """The object file serves where the library is damaged, which would end the process."""
    _, _, folder = draw(tmp_path / "cache", tmp_path)
    for end, needed in ((LIBRARY, "llvmlite"), (".bin", "numba")):
        for file in folder.glob(f"draw_gaussian-*{end}"):
            file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])
        assert draw(tmp_path / "cache", tmp_path)[:2] == (FIRST, needed)
    assert draw(tmp_path / "cache", tmp_path)[:2] == (FIRST, LOADER)


def test_without_a_place_to_write_the_temporary_folder_serves(tmp_path):
    (tmp_path / "file").write_text("")  # no folder can be made below a file, root or not
    number, needed, folder = draw(tmp_path / "file", tmp_path / "scratch")
    assert (number, needed) == (FIRST, "numba")
    assert folder.is_relative_to(tmp_path / "scratch")
    assert draw(tmp_path / "file", tmp_path / "scratch") == (FIRST, LOADER, folder)


def test_arrays_are_passed_without_a_copy():
    state = np.array([1.0, 0.0, 0.0])
    skip(state, 2)
    assert state[0] == 16807**2 % 2147483647


def test_array_with_gaps_is_refused():
    with pytest.raises(ValueError, match="C-contiguous"):
        draw_gaussian(np.zeros(6)[::2])


def test_kernels_are_native():
    assert isinstance(draw_gaussian, Native)


ADDERS = """
from __future__ import annotations
from math import sin
from minidem.kernels.machine.jit import inner, kernel

def adder(step):
    @inner
    def plus(x: float) -> float:
        y = x
LINES
        return step if y > 9.0 else step + 0.5

    @kernel
    def add(x: float) -> float:
        return 10.0 * plus(x) + plus(x + 1.0) + plus(x + 2.0)

    return add
""".replace("LINES", "\n".join(f"        y = sin(y + {k}.0) * y" for k in range(60)))
"""Kernels that share a name, with a function too long for the compiler to copy into them."""


def test_kernels_of_one_name_from_several_processes_stay_apart(tmp_path):
    (tmp_path / "adders.py").write_text(ADDERS)
    places = os.pathsep.join([str(tmp_path), str(ROOT)])
    env = {**os.environ, "PYTHONPATH": places, "XDG_CACHE_HOME": str(tmp_path)}

    def results(*steps: float) -> list[float]:
        """Return what the kernel of each step gives in a new process."""
        code = f"from adders import adder; print(*[adder(s)(0.0) for s in {steps!r}])"
        done = subprocess.run(
            [sys.executable, "-c", code], env=env, capture_output=True, text=True, check=True
        )
        return [float(word) for word in done.stdout.split()]

    assert results(1.0) == [18.0]
    assert results(2.0) == [30.0]
    assert results(1.0, 2.0) == [18.0, 30.0]
