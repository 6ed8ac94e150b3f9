"""The processor that machine code is made for."""

from __future__ import annotations

from functools import cache
from typing import Any

import llvmlite.binding as llvm

from minidem.kernels.machine.cache import processor

__all__ = ["target_machine"]


@cache
def target_machine() -> Any:
    """Return the code generator for the processor that machine code is made for."""
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    name, features = processor()
    return llvm.Target.from_default_triple().create_target_machine(
        cpu=name, features=features,
        opt=3, reloc="default", codemodel="jitdefault", jit=True,
    )  # fmt: skip
