"""Kernels stand alone: they import NumPy, Numba and llvmlite, and each other without a circle."""

from __future__ import annotations

import ast
import sys
from graphlib import CycleError, TopologicalSorter

import pytest

from tests.paths import ROOT

KERNELS = ROOT / "minidem" / "kernels"
ALLOWED = {"numpy", "numba", "llvmlite", *sys.stdlib_module_names}


def imports_of(text: str) -> set[str]:
    """Return the modules that a module imports anywhere in its text, late imports too."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            # `from package import module` names a module, or something in one
            found |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    return found


def kernel_imports() -> dict[str, set[str]]:
    """Return the imports of every kernel module."""
    return {
        ".".join(path.relative_to(ROOT).with_suffix("").parts): imports_of(path.read_text())
        for path in KERNELS.rglob("*.py")
        if path.name != "__init__.py"
    }


def test_nothing_else_is_imported():
    for module, names in kernel_imports().items():
        for name in names:
            kernel = name.startswith("minidem.kernels.") or name == "minidem.kernels"
            assert kernel or name.split(".")[0] in ALLOWED, f"{module} imports {name}"


def test_no_circle_not_even_a_late_one():
    graph = kernel_imports()
    order = list(TopologicalSorter({m: names & graph.keys() for m, names in graph.items()})
                 .static_order())  # fmt: skip
    assert len(order) == len(graph) > 20


def test_a_late_circle_is_found():
    late = "def f():\n    from package.a import g\n    g()\n"
    graph = {"package.a": imports_of("import package.b"), "package.b": imports_of(late)}
    with pytest.raises(CycleError):
        TopologicalSorter(graph).prepare()
