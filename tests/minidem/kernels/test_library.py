"""Machine code as a shared library: the same function, or none."""

from __future__ import annotations

import ctypes
import math
import shutil

import pytest

from minidem.kernels.machine import library, native
from minidem.kernels.machine.cache import FREE, OPTIONS
from minidem.kernels.machine.library import LIBRARY, linker
from minidem.kernels.machine.native import Native

pytestmark = pytest.mark.skipif(not FREE, reason="kernels are not machine code in this process")
linked = pytest.mark.skipif(linker() is None, reason="this system has no linker that is known")


def power(base: float, exponent: float) -> float:
    """Return what the C library computes."""
    return math.pow(base, exponent) + math.sin(base)


OPTIONS[power] = {"no_cpython_wrapper": True}


def build(*words):
    """Compile; only now Numba is imported."""
    from minidem.kernels.machine.build import build

    build(*words)


def no_build(*words):
    """Refuse to compile."""
    raise AssertionError(words)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Let kernels look for their machine code in an empty folder only."""
    monkeypatch.setattr(native, "cache_folder", lambda: tmp_path)
    monkeypatch.setattr(native, "shipped_folder", lambda: None)
    return tmp_path


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Return a folder with the machine code of `power`."""
    place = tmp_path_factory.mktemp("made")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(native, "cache_folder", lambda: place)
        patch.setattr(native, "shipped_folder", lambda: None)
        Native(power, build)(2.0, 0.5)
    return place


def files(folder):
    """Return the ends of the names of the files of a folder."""
    return {file.suffix for file in folder.iterdir()} - {".lock"}


@linked
def test_library_and_object_file_give_the_same_bits(made, folder):
    bases = [0.1 * k + 1e-3 for k in range(200)]
    found = []
    for end in (LIBRARY, ".bin"):
        for file in folder.iterdir():
            file.unlink()
        shutil.copy(next(made.glob(f"*{end}")), folder)
        found.append([Native(power, no_build)(base, 2.7) for base in bases])
    assert found[0] == found[1]
    assert found[0][10] == pytest.approx(bases[10] ** 2.7 + math.sin(bases[10]), rel=1e-15)


@linked
@pytest.mark.parametrize("size", [0, 40, 3000, -33, -1])
def test_a_library_that_was_cut_off_is_not_loaded(size, made, folder, monkeypatch):
    file = next(made.glob(f"*{LIBRARY}"))
    (folder / file.name).write_bytes(file.read_bytes()[:size])
    monkeypatch.setattr(library.ctypes, "CDLL", no_build)
    assert library.load_library(folder / file.name) is None


@linked
def test_a_sound_file_that_the_system_refuses_is_no_library(folder):
    text = b"no machine code"
    (folder / "power.so").write_bytes(text + library.hashlib.sha256(text).digest())
    assert library.load_library(folder / "power.so") is None


@pytest.mark.parametrize("programs", [(), ("false",), ("true",), ("no such program",)])
def test_without_a_linker_that_works_the_object_file_serves(programs, folder, monkeypatch):
    monkeypatch.setattr(library, "LINKERS", programs)
    assert Native(power, build)(4.0, 0.5) == pytest.approx(2.0 + math.sin(4.0))
    assert files(folder) == {".bin"}
    assert Native(power, no_build)(4.0, 0.5) == pytest.approx(2.0 + math.sin(4.0))


@linked
def test_a_library_asks_for_the_functions_of_this_process():
    def address(file, name):
        return ctypes.cast(getattr(ctypes.CDLL(file), name), ctypes.c_void_p).value

    for name in ("pow", "memset"):
        offered = [file for file in library._system_libraries() if hasattr(ctypes.CDLL(file), name)]
        assert address(None, name) in [address(file, name) for file in offered]
