"""CSV as people have it: read where it leaves no doubt, refused by name where it does."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from calibrate.errors import CalibrationError
from calibrate.study.measured.tables import read_table
from calibrate.study.units import bare_name, stated_unit
from liggghts_io.decimals import mark_of, number_in

HEAD = ["particle", "surface", "t100_s", "sem_s"]
ROWS = [["Müller sand", "glued", "17.9", "0.02"], ["Müller sand", "steel", "10.13", "0.06"]]


def table(path: Path, raw: bytes):
    file = path / "times.csv"
    file.write_bytes(raw)
    return read_table(file)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "latin-1", "cp1252"])
@pytest.mark.parametrize("separator", [",", ";", "\t"])
@pytest.mark.parametrize("comma", [False, True])
def test_one_table_in_every_dress(tmp_path: Path, encoding: str, separator: str, comma: bool):
    """A comma between columns leaves no room for one in numbers, unless they are in quotes."""
    mark = "," if comma else "."
    quoted = '"{}"' if comma and separator == "," else "{}"
    lines = [separator.join(HEAD)]
    for row in ROWS:
        cells = [quoted.format(cell.replace(".", mark)) for cell in row]
        lines.append(separator.join(cells) + separator)  # as a spreadsheet ends its lines
    text = "\r\n".join(lines) + "\r\n" + separator * 3 + "\r\n"
    found = table(tmp_path, text.encode(encoding))
    assert found.columns == tuple(HEAD)
    assert [row.cells["particle"] for row in found.rows] == ["Müller sand"] * 2
    assert [[row.number("t100_s"), row.number("sem_s")] for row in found.rows] == [
        [17.9, 0.02], [10.13, 0.06],
    ]  # fmt: skip
    assert found.rows[1].place.endswith("times.csv:3")


@given(value=st.floats(-1e12, 1e12))
def test_a_number_is_the_same_with_either_mark(value: float):
    """Not 1,234: three digits behind a comma may stand behind a thousand."""
    point = repr(value)
    comma = point.replace(".", ",")
    assert number_in(point, mark_of([point])) == value
    found = number_in(comma, mark_of([comma]))
    if isinstance(found, str):
        assert len(comma.partition(",")[2]) == 3
    else:
        assert found == value
    assert number_in(comma, ",") == value


@given(text=st.text(max_size=12), mark=st.sampled_from(["", ".", ","]))
def test_any_cell_is_a_number_or_a_reason(text: str, mark):
    found = number_in(text, mark)
    assert isinstance(found, str) or math.isfinite(found)


@pytest.mark.parametrize(
    ("cells", "cell", "expected"),
    [
        (["1,234"], "1,234", "may be 1.234 or 1234"),
        (["1,234", "38,28"], "1,234", 1.234),
        (["38.28", "1,5"], "1,5", "has a decimal comma in a table with decimal points"),
        (["38,28", "1.5"], "1.5", "has a decimal point in a table with decimal commas"),
        (["0,250"], "0,250", 0.25),
        (["1.234,5"], "1.234,5", 1234.5),
        (["1,234,567.5"], "1,234,567.5", 1234567.5),
        (["1e-3"], "1e-3", 1e-3),
        ([""], "", "is empty"),
        (["1_000"], "1_000", "is not a number"),
        (["inf"], "inf", "is not a number"),
        (["17.9 s"], "17.9 s", "is not a number"),
    ],
)
def test_what_may_be_two_numbers_is_none(cells, cell: str, expected):
    found = number_in(cell, mark_of(cells))
    assert found == expected if isinstance(expected, float) else expected in str(found)


@pytest.mark.parametrize(
    ("column", "unit", "bare"),
    [
        ("t100 [s]", "s", "t100"), ("t100[ms]", "ms", "t100"), ("Masse (g)", "g", "Masse"),
        ("t100_ms", "ms", "t100_ms"), ("force [N]", "N", "force"), ("mass (box 1)", None, None),
        ("angle", None, "angle"), ("[s]", None, "[s]"),
    ],
)  # fmt: skip
def test_units_stand_in_brackets_too(column: str, unit: str | None, bare: str | None):
    assert stated_unit(column) == unit
    assert bare_name(column) == (bare or column)


def test_a_column_is_found_without_its_unit_in_brackets(tmp_path: Path):
    found = table(tmp_path, b"Masse (g);Fehler [mg]\n1,5;20\n")
    assert found.column("Masse") == "Masse (g)"
    with pytest.raises(CalibrationError, match=r"no column 'Fehlr'; did you mean"):
        found.column("Fehlr")
