"""Errors of the engine: what a user did wrong is typed, everything else surfaces as a fault."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.paths import ROOT

BROAD = {
    "ArithmeticError", "BaseException", "Exception", "IndexError", "KeyError",
    "LookupError", "RuntimeError", "TypeError", "ValueError",
}  # fmt: skip
FILES = [
    path for path in sorted((ROOT / "minidem").rglob("*.py")) if "kernels" not in path.parts
]  # fmt: skip
FOR_PROGRAMMERS = {
    ("simulate.py", "_checked"),  # arguments of `run_script`
    ("registry.py", "__getitem__"),  # a table whose line names the wrong module
    ("in_region.py", "wanted"),  # an inserter that was called without masses
}


def _names(node: ast.expr | None) -> set[str]:
    """Return the plain names in an exception expression."""
    return {part.id for part in ast.walk(node) if isinstance(part, ast.Name)} if node else set()


def _functions(tree: ast.Module) -> Iterator[tuple[str, ast.AST]]:
    """Yield every node with the name of the function around it."""
    for function in ast.walk(tree):
        if isinstance(function, ast.FunctionDef):
            for node in ast.walk(function):
                yield function.name, node


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(ROOT)))
def test_mistakes_of_users_are_raised_by_type(path: Path):
    """Only `minidem.errors.DemError` and its children reach a user as a mistake."""
    for function, node in _functions(ast.parse(path.read_text())):
        if isinstance(node, ast.Raise) and (path.name, function) not in FOR_PROGRAMMERS:
            call = node.exc.func if isinstance(node.exc, ast.Call) else node.exc
            untyped = _names(call) & BROAD
            assert not untyped, f"{path}:{node.lineno}: raise InputError instead of {untyped}"


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(ROOT)))
def test_broad_handlers_guard_one_statement(path: Path):
    """A handler for an untyped error must not cover more than the conversion it is meant for."""
    for node in ast.walk(ast.parse(path.read_text())):
        if not isinstance(node, ast.Try):
            continue
        for handler in node.handlers:
            caught = _names(handler.type) & BROAD if handler.type else {"everything"}
            again = isinstance(handler.body[-1], ast.Raise) and handler.body[-1].exc is None
            if caught and not again:
                calls = sum(
                    isinstance(part, ast.Call) for step in node.body for part in ast.walk(step)
                )
                assert len(node.body) == 1, f"{path}:{node.lineno}: {caught} for several statements"
                assert calls <= 3, f"{path}:{node.lineno}: {caught} for several calls"
