"""The processor that machine code is made for, told without LLVM where the system tells it.

Importing LLVM is a seventh of what a short script takes. Linux tells in a file what LLVM asks the
processor itself.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from functools import cache
from typing import Final

__all__ = ["has", "identity", "processor"]

FILE: Final = "/proc/cpuinfo"
_ENOUGH: Final = 4096
"""Bytes that hold a core at least; the file of a machine with many takes milliseconds."""
_X86: Final = ("vendor_id", "cpu family", "model", "flags")
_ARM: Final = ("CPU implementer", "CPU architecture", "CPU variant", "CPU part", "Features")
_FLAGS: Final = {"bmi": "bmi1", "lzcnt": "abm"}
"""Features that Linux names otherwise than LLVM, of those that machine code is shipped for."""


@cache
def processor() -> tuple[str, str]:
    """Return name and features of the processor that machine code is made for.

    That of this machine, but for what the variables say by which Numba is told of another.
    """
    import llvmlite.binding as llvm

    name = os.environ.get("NUMBA_CPU_NAME")
    if name:
        return name, os.environ.get("NUMBA_CPU_FEATURES", "")
    return llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()


def identity() -> str:
    """Return what tells the processor that machine code is made for from others."""
    told = None if os.environ.get("NUMBA_CPU_NAME") else _told()
    return " ".join(processor()) if told is None else told


def has(features: Iterable[str]) -> bool:
    """Return True if the processor of this machine has all of these features of LLVM."""
    wanted = set(features)
    told = _told() or ""
    flags = [line.split(":")[1].split() for line in told.splitlines() if line.startswith("flags")]
    if flags:
        # a feature of another name than Linux has for it counts as lacking, which is safe
        return all({_FLAGS.get(name, name) for name in wanted} <= set(core) for core in flags)
    if not wanted:
        return True
    import llvmlite.binding as llvm

    return wanted <= {name for name, there in llvm.get_host_cpu_features().items() if there}


@cache
def _told() -> str | None:
    """Return the lines by which LLVM would know this processor; None if they are not all there."""
    try:
        handle = os.open(FILE, os.O_RDONLY)
    except OSError:
        return None
    try:
        text = os.read(handle, _ENOUGH).decode(errors="replace")
    except OSError:
        return None
    finally:
        os.close(handle)
    whole = text[: text.rfind("\n") + 1].splitlines()  # the last may be cut
    parts = [line.partition(":") for line in whole]
    found = {(name.strip(), value.strip()) for name, _, value in parts}
    names = {name for name, _ in found}
    kind = next((kind for kind in (_X86, _ARM) if names.issuperset(kind)), None)
    if kind is None:
        return None
    # cores of one kind give one line each
    return "".join(f"{name}: {value}\n" for name, value in sorted(found) if name in kind)
