"""What Linux tells of a processor is what LLVM asks it."""

from __future__ import annotations

from pathlib import Path

import llvmlite.binding as llvm
import pytest

from minidem.kernels.machine import processor
from minidem.kernels.machine.processor import has, identity
from minidem.ship import CLASSES

LINES = """processor\t: 0
vendor_id\t: GenuineIntel
cpu family\t: 6
model\t\t: 85
model name\t: a processor
cpu MHz\t\t: 2596.122
flags\t\t: fpu avx bmi1 abm
bogomips\t: 5192.24

"""
ARM = """processor\t: 0
Features\t: fp asimd
CPU implementer\t: 0x41
CPU architecture: 8
CPU variant\t: 0x3
CPU part\t: 0xd0c

"""


@pytest.fixture
def told(tmp_path, monkeypatch):
    """Return a function that lets the system tell something else of the processor."""

    def tell(text):
        (tmp_path / "cpuinfo").write_text(text)
        monkeypatch.setattr(processor, "FILE", str(tmp_path / "cpuinfo"))
        processor._told.cache_clear()

    monkeypatch.delenv("NUMBA_CPU_NAME", raising=False)
    yield tell
    processor._told.cache_clear()


def here():
    """Return what LLVM says of this processor."""
    return f"{llvm.get_host_cpu_name()} {llvm.get_host_cpu_features().flatten()}"


@pytest.mark.parametrize("name", CLASSES["x86-64-v3"])
def test_a_feature_is_there_if_llvm_says_so(name):
    assert has([name]) == llvm.get_host_cpu_features().get(name, False)


def test_features_are_those_of_the_flags(told):
    told(LINES)
    assert has([])
    assert has(["avx", "bmi", "lzcnt"])
    assert not has(["avx", "avx2"])


@pytest.mark.parametrize("text", [LINES, ARM])
def test_processors_are_told_apart(text, told):
    told(text)
    one = identity()
    told(text + text.replace(": 0\n", ": 1\n").replace("2596", "800"))
    assert identity() == one
    for old, new in ((" 85", " 86"), ("avx", "avx avx2"), ("0xd0c", "0xd40"), ("asimd", "sve")):
        if old in text:
            told(text.replace(old, new))
            assert identity() != one


@pytest.mark.parametrize("text", ["", "cpu\t: POWER9\n", LINES[: LINES.index("abm")]])
def test_what_the_system_does_not_tell_llvm_does(text, told):
    told(text)
    assert identity() == here()
    assert has(["avx"]) == llvm.get_host_cpu_features().get("avx", False)


def test_who_names_another_processor_is_believed(told, monkeypatch):
    told(LINES)
    monkeypatch.setenv("NUMBA_CPU_NAME", "x86-64")
    processor.processor.cache_clear()
    assert identity() == "x86-64 "
    processor.processor.cache_clear()


def test_a_machine_of_many_cores_is_known_by_its_first(told):
    told(LINES)
    one = identity()
    told(LINES * 300)
    assert identity() == one
    assert Path(processor.FILE).stat().st_size > 10 * processor._ENOUGH
