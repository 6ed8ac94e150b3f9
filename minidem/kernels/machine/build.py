"""Compile kernels with Numba to object code that needs neither Numba nor its runtime.

A kernel is called through a shim of one argument, the address of a block of 64-bit words that
hold the address and shape of every array and the value of every number, in order. The result
goes into the first word. Kernels allocate no arrays, so that nothing of Numba's memory manager is
left in the object code.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from types import FunctionType
from typing import Any

import llvmlite.binding as llvm
import numba as _numba
import numpy as np
from numba.core import types

from minidem.kernels.machine import space
from minidem.kernels.machine.cache import OPTIONS, cache_folder
from minidem.kernels.machine.intrinsics import REPLACED, pointer
from minidem.kernels.machine.library import LIBRARY, entry_name, link, linker
from minidem.kernels.machine.objects import write_object
from minidem.kernels.machine.target import target_machine

__all__ = ["build", "dispatcher"]

numba: Any = _numba  # its annotations do not know all options of njit

_RESULTS = {
    "None": "{call}",
    "Any": "{call}",
    "int": "whole[0] = {call}",
    "bool": "whole[0] = 1 if {call} else 0",
    "float": "real[0] = {call}",
    "tuple[int, int]": "whole[0], whole[1] = {call}",
}


@cache
def dispatcher(function: Callable[..., Any]) -> Any:
    """Return Numba's function for a kernel or a function that kernels call."""
    options = OPTIONS[function]
    cells = [cell.cell_contents for cell in function.__closure__ or ()]
    if any(callable(cell) for cell in cells):
        options = {**options, "cache": False}  # Numba cannot tell which functions these are
    before = numba.config.CACHE_DIR
    if not before:
        # our own cache folder holds only while Numba looks for one
        numba.config.CACHE_DIR = str(cache_folder())
    try:
        return numba.njit(error_model="numpy", no_cfunc_wrapper=True, _nrt=False, **options)(
            function
        )
    finally:
        numba.config.CACHE_DIR = before


@contextmanager
def _numba_functions() -> Iterator[None]:
    """Let the kernel modules see Numba's functions instead of the plain ones."""
    changed: list[tuple[dict[str, Any], str, Any]] = []
    for name, module in list(sys.modules.items()):
        if not name.startswith("minidem.kernels.") or module is space:
            continue
        names = vars(module)
        for key, value in list(names.items()):
            new = _of_numba(value)
            if new is not None:
                changed.append((names, key, value))
                names[key] = new
    cells = [cell for function in OPTIONS for cell in function.__closure__ or ()]
    inside = [(cell, cell.cell_contents) for cell in cells]
    for cell, value in inside:
        cell.cell_contents = _of_numba(value) or value
    try:
        yield
    finally:
        for names, key, value in changed:
            names[key] = value
        for cell, value in inside:
            cell.cell_contents = value


def _of_numba(value: Any) -> Any:
    """Return what Numba knows of a function that kernels call, None for anything else."""
    plain = getattr(value, "__wrapped__", value)  # a kernel that was compiled has it
    if not isinstance(plain, FunctionType):
        return None
    if plain.__module__ == space.__name__:
        return REPLACED.get(plain.__name__)
    return dispatcher(plain) if plain in OPTIONS else None


def build(function: Callable[..., Any], codes: tuple[Any, ...], target: Path) -> None:
    """Compile a kernel for arguments of these codes, write its library and its object file.

    Parameters
    ----------
    function : callable
        The kernel, plain Python.
    codes : tuple
        One per argument: ``("i",)``, ``("f",)``, ``("b",)``, ``("a", dtype, dimensions)``, or
        ``(class, codes)`` of a named tuple.
    target : Path
        Object file to write; the library stands beside it.
    """
    with _numba_functions():
        text, names = _shim(function, codes)
        exec(text, names)  # text made above from dtypes and counts only
        shim = numba.njit(
            numba.void(types.int64),
            error_model="numpy",
            no_cfunc_wrapper=True,
            no_cpython_wrapper=True,
        )(names["shim"])
        (made,) = shim.overloads.values()
        module = llvm.parse_assembly(shim.inspect_llvm(made.signature.args))
    _isolate(module, made.fndesc.llvm_func_name, entry_name(target))
    needs = [f.name for f in module.functions if f.is_declaration and f.name[:5] != "llvm."]
    if linker() is not None:
        code = target_machine(movable=True).emit_object(module.clone())
        link(code, target.with_suffix(LIBRARY))
    write_object(target_machine().emit_object(module), needs, target)


def _isolate(module: Any, old: str, entry: str) -> None:
    """Hide all names of a module but that of the entry, which becomes `entry`.

    Numba numbers functions anew in every process, so that two object files may use one name for
    the loops of different models; the linker would take the first for both.
    """
    for item in (*module.functions, *module.global_variables):
        if item.name == old:
            item.name = entry
        elif not item.is_declaration:
            item.linkage = llvm.Linkage.internal
    _shorten(module)


def _shorten(module: Any) -> None:
    """Leave out what nothing calls, and what calls hand over and the function called never reads.

    Nothing calls what Numba brings along for arrays that are dropped, which needs its runtime.
    An array is seven words and more, of which most functions need its address only: a call with all
    tables of a step was two hundred words on the stack, which took longer than two grains.
    """
    passes = llvm.create_new_module_pass_manager()
    passes.add_global_dead_code_eliminate_pass()
    passes.add_dead_arg_elimination_pass()
    options = llvm.create_pipeline_tuning_options()
    passes.run(module, llvm.create_pass_builder(target_machine(), options))


def _shim(function: Callable[..., Any], codes: tuple[Any, ...]) -> tuple[str, dict[str, Any]]:
    """Return the text of the shim and the names that it uses."""
    names: dict[str, Any] = {
        "target": dispatcher(function), "carray": numba.carray, "pointer": pointer,
        "int64": numba.int64, "float64": numba.float64,
    }  # fmt: skip
    args, count = [], 0
    for code in codes:
        arg, count = _argument(code, count, names)
        args.append(arg)
    wanted = str(function.__annotations__.get("return", "None"))
    line = _RESULTS[wanted].format(call=f"target({', '.join(args)})")
    text = (
        "def shim(address):\n"
        f"    whole = carray(pointer(address), ({count + 2},), int64)\n"
        f"    real = carray(pointer(address), ({count + 2},), float64)\n"
        f"    {line}\n"
    )
    return text, names


def _argument(code: Any, at: int, names: dict[str, Any]) -> tuple[str, int]:
    """Return the expression of an argument that starts at word `at`, and the word after it."""
    if code[0] == "i":
        return f"whole[{at}]", at + 1
    if code[0] == "b":
        return f"whole[{at}] != 0", at + 1
    if code[0] == "f":
        return f"real[{at}]", at + 1
    if code[0] == "a":
        kind = f"type_{np.dtype(code[1]).name}"
        names[kind] = numba.from_dtype(np.dtype(code[1]))
        shape = "".join(f"whole[{at + 1 + d}], " for d in range(code[2]))
        return f"carray(pointer(whole[{at}]), ({shape}), {kind})", at + 1 + code[2]
    owner = f"class_{len(names)}"
    names[owner] = code[0]
    parts = []
    for part in code[1]:
        text, at = _argument(part, at, names)
        parts.append(text)
    return f"{owner}({', '.join(parts)})", at
