"""Object code, linked into the process by llvmlite: what serves where a library does not."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import llvmlite.binding as llvm

from minidem.kernels.machine.library import ENTRY, entry_name, write
from minidem.kernels.machine.target import target_machine

__all__ = ["load_object", "write_object"]

_LIBRARY = ("cos", "exp", "log", "memcpy", "memmove", "memset", "pow", "sin")
"""Functions of the C library that the code generator may call."""


def write_object(code: bytes, needs: list[str], path: Path) -> None:
    """Write object code after a line of JSON that tells what it needs, and its digest."""
    digest = hashlib.sha256(code).hexdigest()
    head = json.dumps({"needs": [*needs, *_LIBRARY], "digest": digest})
    write(path, head.encode() + b"\n" + code)


def load_object(path: Path) -> Callable[..., int] | None:
    """Return the entry of object code that `write_object` wrote; None if it is damaged."""
    try:
        head, code = path.read_bytes().split(b"\n", 1)
        found = json.loads(head)
    except (OSError, ValueError):
        return None
    if found.get("digest") != hashlib.sha256(code).hexdigest():
        return None
    linker = _linker()
    missing = [name for name in found["needs"] if not llvm.address_of_symbol(name)]
    if missing:
        msg = f"{path}: this system lacks {', '.join(missing)}"
        raise OSError(msg)
    linker.add_object_file(llvm.ObjectFileRef.from_data(code))
    linker.finalize_object()
    return ENTRY(linker.get_function_address(entry_name(path)))


@cache
def _linker() -> Any:
    """Return what links object code into this process."""
    return llvm.create_mcjit_compiler(llvm.parse_assembly(""), target_machine())
