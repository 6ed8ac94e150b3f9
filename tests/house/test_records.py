"""Plain data of minidem are records, which take less time to load than data classes."""

from __future__ import annotations

import ast

import pytest

from minidem.record import field, fields, record, replace
from tests.paths import ROOT

MINIDEM = ROOT / "minidem"
FOR_USERS = {"simulate.py", "script/check/finding.py"}
"""What `run_script` and `check_script` return, which users may compare and print."""
MODULES = sorted(
    path
    for path in MINIDEM.rglob("*.py")
    if path.relative_to(MINIDEM).as_posix() not in FOR_USERS | {"record.py"}
)


@record
class Grain:
    """A record with a default."""

    radius: float
    marks: list[int] = field(default_factory=list)


class Marked(Grain):
    """Adds no field."""


@pytest.mark.parametrize("kind", [Grain, Marked])
def test_a_record_is_made_and_changed_as_a_data_class(kind):
    one, other = kind(0.5), kind(radius=0.5)
    other.marks.append(1)
    assert (one.radius, one.marks, other.marks) == (0.5, [], [1])
    assert [item.name for item in fields(one)] == ["radius", "marks"]
    assert replace(one, radius=2.0).radius == 2.0


def test_a_record_is_compared_as_an_object():
    one, other = Grain(0.5), Grain(0.5)
    assert one != other
    assert len({one, other}) == 2


def is_field(statement: ast.stmt) -> bool:
    """Tell whether a statement in a class declares a field."""
    if not isinstance(statement, ast.AnnAssign):
        return False
    return "ClassVar" not in ast.unparse(statement.annotation)


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.relative_to(MINIDEM).as_posix())
def test_minidem_has_records(path):
    tree = ast.parse(path.read_text())
    imported = [node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    assert "dataclasses" not in imported, "import from minidem.record"
    for node in ast.walk(tree):
        decorators = [ast.unparse(one) for one in getattr(node, "decorator_list", ())]
        if any(one.startswith("record") for one in decorators):
            assert any(map(is_field, node.body)), f"{node.name} adds no field: needs no decorator"
