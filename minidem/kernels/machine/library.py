"""Machine code as a shared library, which a process loads without importing llvmlite.

Where the system has a linker, `link` makes the library of an object file beside it; `load_library`
gives its entry. Without one, or where the system will not load it, the object file serves,
`minidem.kernels.machine.objects`.
"""

from __future__ import annotations

import ctypes
import hashlib
import os
import platform
import re
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Final

__all__ = ["ENTRY", "LIBRARY", "entry_name", "link", "linker", "load_library", "write"]

ENTRY: Final = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int64)
"""Type of an entry; the lock of the Python interpreter is released in it."""
LIBRARY: Final = ".so"
"""End of the name of a library."""
LINKERS: Final = ("ld", "ld.lld")
OPTIONS: Final = (
    "-shared", "-z", "defs", "-z", "text", "-z", "now", "-z", "noexecstack", "--build-id=none",
    "--eh-frame-hdr", "--as-needed",
)  # fmt: skip
MAPPED: Final = Path("/proc/self/maps")
LONGEST: Final = 60.0  # seconds that a linker may take; it takes hundredths
_DIGEST = hashlib.sha256().digest_size
_SYSTEM = re.compile(r"(lib[cm](-[\d.]+)?\.so|libc\.musl|ld-musl)")
"""Begin of the names of the C library's files: one, or another for its mathematics."""


def entry_name(path: Path) -> str:
    """Return the name of the function that is called in the machine code of a file."""
    return path.stem.replace("-", "_")


def linker() -> str | None:
    """Return the program that links libraries; None on systems without one or with others."""
    import shutil

    known = sys.platform == "linux" and platform.machine() in ("x86_64", "aarch64")
    return next(filter(None, map(shutil.which, LINKERS)), None) if known else None


def link(code: bytes, path: Path) -> None:
    """Write the library of object code; where that fails there is none.

    Parameters
    ----------
    code : bytes
        Movable, see `minidem.kernels.machine.target`.
    path : Path
        The library, followed by the digest of what comes before it: one that was cut off would end
        the process that loads it.
    """
    import subprocess
    import tempfile

    with suppress(OSError, subprocess.SubprocessError), tempfile.TemporaryDirectory() as scratch:
        source, made = Path(scratch) / "code.o", Path(scratch) / "code.so"
        source.write_bytes(code)
        command = [str(linker()), *OPTIONS, "-o", str(made), str(source), *_system_libraries()]
        subprocess.run(
            command, stdin=subprocess.DEVNULL, capture_output=True, timeout=LONGEST, check=True
        )
        library = made.read_bytes()
        write(path, library + hashlib.sha256(library).digest())


def load_library(path: Path) -> Callable[..., int] | None:
    """Return the entry of a library; None if it is not there, damaged or not for this system."""
    try:
        content = memoryview(path.read_bytes())
        if hashlib.sha256(content[:-_DIGEST]).digest() != content[-_DIGEST:]:
            return None
        return ENTRY((entry_name(path), ctypes.CDLL(str(path))))
    except (OSError, AttributeError):
        return None


def write(path: Path, content: bytes) -> None:
    """Write a file that others see whole or not at all."""
    import tempfile

    handle, name = tempfile.mkstemp(dir=path.parent)
    try:
        with os.fdopen(handle, "wb") as out:
            out.write(content)
        Path(name).replace(path)
    except OSError:
        Path(name).unlink(missing_ok=True)
        raise


def _system_libraries() -> list[str]:
    """Return the files of the C library that this process has loaded.

    A library that names none gets the oldest version of a function that they hold, such as `pow`;
    linked with these it gets the version that the rest of the process gets.
    """
    with MAPPED.open(encoding="utf-8", errors="surrogateescape") as lines:
        mapped = {line.split(maxsplit=5)[5].strip() for line in lines if "/" in line}
    return sorted(file for file in mapped if _SYSTEM.match(file.rpartition("/")[2]))
