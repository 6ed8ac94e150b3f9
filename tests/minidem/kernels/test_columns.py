"""Columns of tables have names, in kernels and in Python: no literal number in a subscript."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator

import pytest

from minidem.kernels import columns, tables
from minidem.kernels.contact.records import Switches
from tests.paths import ROOT

MINIDEM = ROOT / "minidem"
KERNELS = MINIDEM / "kernels"
MODULES = sorted(
    path
    for path in KERNELS.rglob("*.py")
    # how kernels become machine code: it handles syntax and arguments, no tables
    if path.relative_to(KERNELS).parts[0] != "machine"
)

PYTHON = sorted(
    path
    for path in MINIDEM.rglob("*.py")
    # the language of scripts knows no tables
    if path.relative_to(MINIDEM).parts[0] not in {"kernels", "script"}
)

WORDS = {"base", "kind", "mesh"}
"""Fields of tables that words are called in Python; two indices are found all the same."""

PACKED = {field for name in tables.__all__ for field in getattr(tables, name)._fields} | {
    "numbers",  # a row of Posts.value, Motions.value or Walls.value in its fix
    "before",  # BodyForce.before
    "coef", "coefficients", "switches", "s",  # contact models
    "period", "sphere", "spheres", "bounds", "extent", "_extent", "velocity", "state", "shape",
}  # fmt: skip
"""Arrays that Python shares with kernels, by their fields and by what else they are called.

Other things in Python that a single number may stand behind are lists of words."""

STARTS = {"start", "first", "bound", "child_start", "condition_start", "leaf_start"}
"""Arrays that say where the entries of row i start, so that ``start[i + 1]`` is where they end.

They have no columns; a number in their subscript counts rows."""

TEXT = {"text"}
"""Bytes of text; a number in their subscript counts characters."""


def name_of(array: ast.expr) -> str:
    """Return the last word of the array's name, an empty string if it has none."""
    if isinstance(array, ast.Call):
        return name_of(array.func)
    if isinstance(array, ast.Attribute):
        return array.attr
    return array.id if isinstance(array, ast.Name) else ""


def numbers_in(index: ast.expr) -> Iterator[ast.Constant]:
    """Yield the literal numbers of an index, not those of subscripts and masks within it."""
    if isinstance(index, ast.Subscript | ast.Compare):
        return
    if isinstance(index, ast.Constant) and type(index.value) in (int, float):
        yield index
    for child in ast.iter_child_nodes(index):
        if isinstance(child, ast.expr):
            yield from numbers_in(child)


def is_size(node: ast.Subscript) -> bool:
    """Return True for ``array.shape[0]`` and ``array.shape[1:]``: NumPy's tuple, and no table."""
    return (
        isinstance(node.value, ast.Attribute)
        and node.value.attr == "shape"
        and isinstance(node.slice, ast.Constant | ast.Slice)
    )


def of_table(node: ast.Subscript) -> bool:
    """Return True for a subscript in Python that has to do with a table.

    Only an array has several indices; with one the name of the array decides, also if rows of it
    were chosen before: ``row[who][0]``.
    """
    array = node.value
    while isinstance(array, ast.Subscript):
        array = array.value
    return isinstance(node.slice, ast.Tuple) or name_of(array) in PACKED - WORDS


def literal_subscripts(
    text: str, name: str, concerned: Callable[[ast.Subscript], bool] = lambda node: True
) -> list[str]:
    """Return ``file:line: subscript`` of the subscripts concerned that have a literal number."""
    return [
        f"{name}:{node.lineno}: {ast.unparse(node)}"
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Subscript)
        and concerned(node)
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
        "m[WALL_MODEL : WALL_MODEL + 13]",
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


# -- Python ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("path", PYTHON, ids=lambda path: path.relative_to(MINIDEM).as_posix())
def test_columns_have_names_in_python(path):
    found = literal_subscripts(path.read_text(), str(path), of_table)
    assert not found, "name the column, see minidem/kernels/columns.py:\n" + "\n".join(found)


def test_all_of_python_is_read():
    assert {path.parent.name for path in PYTHON} >= {"contact", "fixes", "insertion", "world"}


@pytest.mark.parametrize(
    "line",
    [
        "row[:, 7]",
        "row[at, 4:7]",
        "row[who][0]",
        "anything[i, 5 + c]",
        "state.flight[: state.n, 4]",
        "made.numbers[3:6]",
        "switches[9]",
        "box.period()[3:]",
        "needs[0]",
    ],
)
def test_a_literal_number_is_found_in_python(line):
    assert len(literal_subscripts(f"{line} = 0.0\n", "bad.py", of_table)) == 1


@pytest.mark.parametrize(
    "line",
    [
        "row[:, VELOCITY]",
        "flight[:, three(FLIGHT_FROM)]",
        "more.first[start[i] + c]",
        "code[code >= 0]",
        "old.shape[1:]",
        "words[0]",
        "name[:40]",
    ],
)
def test_names_and_lists_of_words_pass_in_python(line):
    assert literal_subscripts(f"{line} = 0.0\n", "good.py", of_table) == []


# -- names and records -----------------------------------------------------------------------------


def test_switches_have_the_order_of_their_record():
    places = {
        "static_friction": columns.WEAKENS,
        "velocity_restitution": columns.SLOWS,
        "restitution_scatter": columns.SCATTERS,
        "tangential_stiffness": columns.SOFTENS,
    }
    for at, name in enumerate(Switches._fields):
        assert places.get(name, getattr(columns, name.upper(), None)) == at
    assert len(Switches._fields) == columns.SWITCHES
