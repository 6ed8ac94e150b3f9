"""Which rows of a table are those of a wall and a material: never a mean over several of them."""

from __future__ import annotations

from pathlib import Path

import pytest

from calibrate.errors import CalibrationError
from calibrate.study.data import StudyData, load_data
from calibrate.study.measured.assigned import Around
from calibrate.study.measured.scalars import Measured, measured_value
from calibrate.study.measured.tables import read_table
from calibrate.study.schema.materials import Material
from calibrate.study.schema.targets import Target
from tests.calibrate.study.two import FREE, TWO

WALLS = ("steel", "brass")
MATERIALS = ("coarse", "fine")
ANGLES = {"steel": (26.1, 26.5, 25.9), "brass": (33.0, 33.4, 32.9)}
MEANS = {wall: sum(values) / 3 for wall, values in ANGLES.items()}
SAND = Material(name="Sand", d32_um=1000.0, density_kg_m3=2500.0)


def target(material: str, wall: str, column: str = "angle_deg") -> str:
    return f"""
[[target]]
name = "angle_{material}_{wall}"
material = "{material}"
surface = "{wall}"
experiment = "heap"
observable = "angle_deg"
unit = "deg"
file = "angles.csv"
column = "{column}"
"""


def table_of(head: str, names: dict[str, str] | None = None) -> str:
    """Return repeats on two walls, their column called `head`, and what stands in it."""
    names = names or dict(zip(WALLS, WALLS, strict=True))
    rows = [
        f"{names[wall]},{run},{one}"
        for wall, values in ANGLES.items()
        for run, one in enumerate(values)
    ]
    return "\n".join([f"{head},run,angle_deg", *rows, ""])


@pytest.fixture
def loaded(tmp_path: Path):
    """Return a function that loads a study of two walls with a table of angles."""

    def load(table: str, *targets: str) -> StudyData:
        two = [*(target("coarse", wall) for wall in WALLS), target("fine", "steel", "other_deg")]
        (tmp_path / "angles.csv").write_text(table, encoding="utf-8")
        text = TWO + "".join(targets or two[:2]) + FREE
        if not any("fine" in one for one in targets):
            text = text.replace(text[text.index('[[material]]\nname = "fine"') :
                                     text.index("[[surface]]")], "")  # fmt: skip
        path = tmp_path / "study.toml"
        path.write_text(text, encoding="utf-8")
        return load_data(path)

    return load


@pytest.mark.parametrize("head", ["surface", "Surface", "SURFACE", " Surface "])
def test_rows_of_a_wall_are_found_whatever_the_capitals(loaded, head: str):
    found = loaded(table_of(head)).scalars
    for wall, mean in MEANS.items():
        one = found[f"angle_coarse_{wall}"]
        assert (one.value, one.repeats) == (pytest.approx(mean), 3)


def test_what_stands_in_the_column_may_have_capitals_too(loaded):
    found = loaded(table_of("surface", {"steel": "Steel", "brass": "BRASS"})).scalars
    assert found["angle_coarse_steel"].value == pytest.approx(MEANS["steel"])


@pytest.mark.parametrize(
    ("head", "names"),
    [
        ("Wand", None),  # a head that says it in other words
        ("test piece", None),  # a head that nobody knows, over names of the study
        ("Wand", {"steel": "Stahl", "brass": "Messing"}),
        ("wall", {"steel": "St", "brass": "Ms"}),
    ],
)
def test_walls_under_another_head_are_not_averaged(loaded, head: str, names):
    with pytest.raises(CalibrationError) as caught:
        loaded(table_of(head, names))
    for wall in WALLS:
        assert f"angles.csv: column '{head}' holds " in str(caught.value)
        assert f"rows of '{wall}' cannot be told from others; call the column 'surface'" in str(
            caught.value
        )


def test_a_column_of_one_word_tells_nothing_apart(loaded):
    """All rows are of one wall, whatever it is called there."""
    table = "Wand,angle_deg\nStahl,26.1\nStahl,26.5\n"
    text = target("coarse", "steel") + target("coarse", "brass").replace(
        'file = "angles.csv"\ncolumn = "angle_deg"', "value = 33.0\nse = 0.2"
    )
    assert loaded(table, text).scalars["angle_coarse_steel"].repeats == 2


def test_rows_of_nobody_are_refused_where_several_walls_take_them(loaded):
    table = "run,angle_deg\n1,26.1\n2,26.5\n"
    with pytest.raises(CalibrationError) as caught:
        loaded(table)
    assert "has no column 'surface', and targets of 'steel', 'brass' take its" in str(caught.value)
    assert "add the column, or give each its own file or column" in str(caught.value)


def test_a_column_for_each_wall_needs_no_column_of_walls(loaded):
    table = "run,steel_deg,brass_deg\n1,26.1,33.0\n2,26.5,33.4\n"
    targets = [target("coarse", wall, f"{wall}_deg") for wall in WALLS]
    found = loaded(table, *targets).scalars
    assert found["angle_coarse_brass"].value == pytest.approx(33.2)


def test_materials_are_told_apart_in_the_same_way(loaded):
    targets = [target(one, wall) for one in MATERIALS for wall in WALLS]
    rows = [f"{one},{wall},{20 + k}" for one in MATERIALS for wall in WALLS for k in range(3)]
    head = "material,surface,angle_deg"
    assert (
        loaded("\n".join([head.title(), *rows]), *targets).scalars["angle_fine_brass"].value == 21
    )
    with pytest.raises(CalibrationError, match=r"column 'Schüttgut' holds 'coarse', 'fine'"):
        loaded("\n".join([head.replace("material", "Schüttgut"), *rows]), *targets)
    bare = [row.partition(",")[2] for row in rows]
    with pytest.raises(
        CalibrationError, match=r"no column 'material', and targets of 'coarse', 'f"
    ):
        loaded("\n".join(["surface,angle_deg", *bare]), *targets)


def test_an_empty_cell_is_no_wall(loaded):
    """As a spreadsheet saves cells that were joined: the repeats below the first would be lost."""
    table = "surface,angle_deg\nsteel,26.1\nsteel,26.5\n,25.9\nbrass,33.0\nbrass,33.1\n"
    with pytest.raises(
        CalibrationError, match=r"angles.csv:4: surface = '' is empty: nobody knows"
    ):
        loaded(table)


def test_capitals_count_where_two_names_differ_in_them_only(tmp_path: Path):
    path = tmp_path / "a.csv"
    path.write_text("material,a\nS1,1.0\nS1,1.2\ns1,5.0\ns1,5.2\n")
    both = [Material(name=name, d32_um=1000.0, density_kg_m3=2500.0) for name in ("S1", "s1")]
    for material, mean in zip(both, (1.1, 5.1), strict=True):
        asked = _target(material=material.name)
        around = Around((asked,), tuple(both))
        assert measured_value(asked, material, read_table(path), around).value == pytest.approx(
            mean
        )


def _target(**changes) -> Target:
    words = {
        "name": "t", "material": "Sand", "surface": "steel", "experiment": "conveyor",
        "observable": "t100_s", "unit": "s", "file": "a.csv", "column": "a",
    }  # fmt: skip
    return Target.model_validate(words | changes)


def _read(tmp_path: Path, text: str, **changes) -> Measured:
    path = tmp_path / "a.csv"
    path.write_text(text)
    return measured_value(_target(**changes), SAND, read_table(path))


def test_a_column_of_units_is_heeded_without_one_of_targets(tmp_path: Path):
    text = "a,unit\n10.0,s\n10.2,s\n"
    assert _read(tmp_path, text).value == pytest.approx(10.1)
    with pytest.raises(
        CalibrationError, match=r"a.csv:2: unit = 's' but the study says unit = 'ms'"
    ):
        _read(tmp_path, text, unit="ms")
    with pytest.raises(CalibrationError, match=r"a.csv:3: unit = 'ms'"):
        _read(tmp_path, "a,Unit\n10.0,s\n10200,ms\n")


def test_names_of_samples_do_not_say_how_decimals_are_written(tmp_path: Path):
    text = "ID;a\n1.1;26,1\n1.2;26,5\n"
    assert _read(tmp_path, text).value == pytest.approx(26.3)
    with pytest.raises(
        CalibrationError, match="has a decimal point in a table with decimal commas"
    ):
        _read(tmp_path, "a;b\n1.234;0,5\n2.500;0,6\n")  # may be thousands


@pytest.mark.parametrize(("other", "apart"), [((33.0, 33.4), True), ((26.0, 26.6), False)])
def test_repeats_in_groups_that_are_far_apart_are_told(tmp_path: Path, other, apart: bool):
    """Nobody knows what stands in that column; operators differ less than several walls do."""
    rows = [f"Probe A,{one}" for one in (26.1, 26.5)] + [f"Probe B,{one}" for one in other]
    doubt = _read(tmp_path, "\n".join(["Kommentar,a", *rows, ""])).doubt
    assert ("repeats of 'Probe A' and 'Probe B' in column 'Kommentar'" in doubt) == apart
    assert bool(doubt) == apart
