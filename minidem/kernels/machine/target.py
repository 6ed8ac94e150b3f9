"""The processor that machine code is made for."""

from __future__ import annotations

from functools import cache
from typing import Any

import llvmlite.binding as llvm

from minidem.kernels.machine.processor import processor

__all__ = ["target_machine"]


@cache
def target_machine(*, movable: bool = False) -> Any:
    """Return the code generator for the processor that machine code is made for.

    Parameters
    ----------
    movable : bool
        True for code that does not mind where it lies, as a shared library asks for. llvmlite
        links the other kind, whose parts may lie far from each other.
    """
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    name, features = processor()
    return llvm.Target.from_default_triple().create_target_machine(
        cpu=name, features=features, opt=3, jit=True,
        reloc="pic" if movable else "default", codemodel="small" if movable else "jitdefault",
    )  # fmt: skip
