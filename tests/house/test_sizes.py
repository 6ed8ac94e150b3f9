"""The limits that keep the house readable: sizes of modules, functions and folders."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.paths import ROOT

PLACES = ("benchmarks", "calibrate", "docs", "liggghts_io", "minidem", "tests")
KERNELS = ROOT / "minidem" / "kernels"
MODULE_LINES = 300
FUNCTION_LINES = 60
FOLDER_MODULES = 15


def modules() -> list[Path]:
    """Return every Python file of the project."""
    return sorted(path for place in PLACES for path in (ROOT / place).rglob("*.py"))


def functions(path: Path) -> Iterator[tuple[str, int]]:
    """Yield name and length in lines of every function of a file, decorators not counted."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield node.name, (node.end_lineno or node.lineno) - node.lineno + 1


def test_modules_are_short():
    lengths = {path: len(path.read_text(encoding="utf-8").splitlines()) for path in modules()}
    long = [f"{p.relative_to(ROOT)}: {n} lines" for p, n in lengths.items() if n > MODULE_LINES]
    assert not long, f"more than {MODULE_LINES} lines: {long}"
    assert len(lengths) > 200  # the search did find the project


def test_functions_are_short_outside_kernels():
    long = [
        f"{path.relative_to(ROOT)}: {name} has {length} lines"
        for path in modules()
        if not path.is_relative_to(KERNELS)
        for name, length in functions(path)
        if length > FUNCTION_LINES
    ]
    assert not long, f"more than {FUNCTION_LINES} lines: {long}"


def test_folders_hold_few_loose_modules():
    counts = Counter(path.parent for path in modules() if path.name != "__init__.py")
    full = [f"{p.relative_to(ROOT)}: {n}" for p, n in counts.items() if n > FOLDER_MODULES]
    assert not full, f"more than {FOLDER_MODULES} loose modules: {full}"


@pytest.mark.parametrize("head", ["def f():", "async def f():"])
def test_a_long_function_would_be_found(tmp_path: Path, head: str):
    path = tmp_path / "long.py"
    path.write_text(head + "\n" + "    pass\n" * 61)
    assert [length for _, length in functions(path)] == [62]
