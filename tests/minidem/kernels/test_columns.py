"""Kernels name the columns of their tables: no literal number in a subscript."""

from __future__ import annotations

import ast
from collections.abc import Iterator

import pytest

from tests.paths import ROOT

KERNELS = ROOT / "minidem" / "kernels"
MODULES = sorted(
    path
    for path in KERNELS.rglob("*.py")
    # how kernels become machine code: it handles syntax and arguments, no tables
    if path.relative_to(KERNELS).parts[0] != "machine"
)

STARTS = {"start", "first", "bound", "child_start", "condition_start", "leaf_start"}
"""Arrays that say where the entries of row i start, so that ``start[i + 1]`` is where they end.

They have no columns; a number in their subscript counts rows."""

TEXT = {"text"}
"""Bytes of text; a number in their subscript counts characters."""


def name_of(array: ast.expr) -> str:
    """Return the last word of the array's name, an empty string if it has none."""
    if isinstance(array, ast.Attribute):
        return array.attr
    return array.id if isinstance(array, ast.Name) else ""


def numbers_in(index: ast.expr) -> Iterator[ast.Constant]:
    """Yield the literal numbers of an index, not those of subscripts within it."""
    if isinstance(index, ast.Subscript):
        return
    if isinstance(index, ast.Constant) and type(index.value) in (int, float):
        yield index
    for child in ast.iter_child_nodes(index):
        if isinstance(child, ast.expr):
            yield from numbers_in(child)


def is_size(node: ast.Subscript) -> bool:
    """Return True for ``array.shape[0]``: NumPy's tuple, and no table."""
    return (
        isinstance(node.value, ast.Attribute)
        and node.value.attr == "shape"
        and isinstance(node.slice, ast.Constant)
    )


def literal_subscripts(text: str, name: str) -> list[str]:
    """Return ``file:line: subscript`` of every subscript with a literal number."""
    return [
        f"{name}:{node.lineno}: {ast.unparse(node)}"
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Subscript)
        and name_of(node.value) not in STARTS | TEXT
        and not is_size(node)
        and any(numbers_in(node.slice))
    ]


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.relative_to(KERNELS).as_posix())
def test_columns_have_names(path):
    found = literal_subscripts(path.read_text(), str(path))
    assert not found, "name the column in minidem/kernels/columns.py:\n" + "\n".join(found)


def test_all_kernels_are_read():
    assert {path.parent.name for path in MODULES} >= {"contact", "lists", "motion", "step"}


@pytest.mark.parametrize(
    "line",
    [
        "row[i, 3]",
        "row[3]",
        "parts.row[i, 3] = 0.0",
        "table.value[p, VX + 1]",
        "b[17 * BLOCK + c]",
        "node[t, 0, X]",
        "whole[-1]",
        "m[WALL_MODEL : WALL_MODEL + 11]",
        "hist[k, min(c, 2)]",
        "force[order[i], 2]",
        "closest(t)[7]",
        "start[row[i, 3] + 1]",
        "table.shape[k, 2]",
    ],
)
def test_a_literal_number_is_found(line):
    assert len(literal_subscripts(f"def kernel():\n    {line}\n", "bad.py")) == 1
    assert literal_subscripts(f"def kernel():\n    {line}\n", "bad.py")[0].startswith("bad.py:2: ")


@pytest.mark.parametrize(
    "line",
    [
        "row[i, MASS]",
        "cells[CELL_SIZE + c]",
        "b[LEVER + X, c]",
        "force[order[i], c]",
        "row.shape[0]",
        "pairs.start[i + 1]",
        "1.0 + row[i, X] * 3.0",
    ],
)
def test_names_and_loop_indices_pass(line):
    assert literal_subscripts(f"def kernel():\n    {line}\n", "good.py") == []
