"""Units are converted, or refused when they measure something else."""

from __future__ import annotations

import math
import shutil
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from calibrate.errors import CalibrationError
from calibrate.study.data import load_data
from calibrate.study.resources import bundled_study
from calibrate.study.units import factor, stated_unit
from liggghts_io.experiments import EXPERIMENTS

KINDS = {
    "angle": ["deg", "rad"],
    "time": ["s", "ms", "min", "h"],
    "mass": ["g", "kg", "mg"],
    "length": ["m", "cm", "mm", "um"],
    "number": ["-", "%"],
}
EVERY = [(unit, kind) for kind, units in KINDS.items() for unit in units]


@given(first=st.sampled_from(EVERY), second=st.sampled_from(EVERY))
def test_there_and_back_is_one_and_other_dimensions_are_refused(first, second):
    if first[1] == second[1]:
        assert factor(first[0], second[0]) * factor(second[0], first[0]) == pytest.approx(1.0)
        return
    with pytest.raises(CalibrationError, match=f"'{first[0]}' is a unit of {first[1]}"):
        factor(first[0], second[0])


@pytest.mark.parametrize(
    ("given_", "wanted", "value"),
    [("rad", "deg", 180 / math.pi), ("ms", "s", 1e-3), ("min", "s", 60.0), ("h", "min", 60.0),
     ("kg", "g", 1e3), ("mg", "g", 1e-3), ("mm", "m", 1e-3), ("%", "-", 0.01)],
)  # fmt: skip
def test_factors_are_those_of_the_books(given_, wanted, value):
    assert factor(given_, wanted) == pytest.approx(value)


def test_every_observable_has_a_unit_that_others_can_be_converted_to():
    for experiment in EXPERIMENTS.values():
        for one in experiment.observables:
            assert factor(one.unit, one.unit) == 1.0
            assert one.meaning
            assert one.low < one.high < math.inf


def test_a_column_states_its_unit_at_the_end_of_its_name():
    assert stated_unit("angle_deg") == "deg"
    assert stated_unit("m1_sem") is None
    assert stated_unit("_s") is None


@pytest.fixture
def study(tmp_path: Path):
    """Write the good study with another unit and table of conveyor times; return its data."""
    good = Path(__file__).parents[1] / "studies" / "good.toml"
    for csv in bundled_study().parent.glob("*.csv"):
        shutil.copy(csv, tmp_path)

    def write(column: str, sem_column: str, unit: str, value: str, sem: str, more: str = ""):
        text = good.read_text(encoding="utf-8")
        text = text.replace('unit = "s"', f'unit = "{unit}"')
        text = text.replace('column = "t100_s"', f'column = "{column}"')
        text = text.replace('se_column = "sem_s"', f'se_column = "{sem_column}"')
        text = text.replace('scale = "log"\n', "").replace('"conveyor.csv"', '"times.csv"')
        head = f"particle,surface,{column},{sem_column}\n"
        (tmp_path / "times.csv").write_text(f"{head}Carbo HSP13,glued,{value},{sem}\n")
        (tmp_path / "study.toml").write_text(text + more)
        return load_data(tmp_path / "study.toml")

    return write


@pytest.mark.parametrize(
    ("column", "sem_column", "unit", "value", "sem"),
    [
        ("t100_ms", "sem_ms", "ms", "17900", "20"),
        ("t100_min", "error", "min", "0.298333333", "0.000333333333"),
        ("t100", "sem_ms", "s", "17.9", "20"),
    ],
)
def test_measured_values_are_converted_to_the_unit_of_the_observable(
    study, column, sem_column, unit, value, sem
):
    data = study(column, sem_column, unit, value, sem)
    one = data.scalars["t100_glued"]
    assert one.value == pytest.approx(17.9)
    assert one.se == pytest.approx(0.02)
    target = data.study.target_named("t100_glued")
    # The scale is that of the simulated unit: milliseconds are times, too.
    assert (target.simulated_unit, target.model_scale) == ("s", "log")


def test_a_column_whose_name_contradicts_the_unit_is_refused(study):
    with pytest.raises(CalibrationError, match="column 't100_ms' says 'ms'; correct the unit"):
        study("t100_ms", "sem_ms", "s", "17900", "20")
    with pytest.raises(CalibrationError, match="'g' is a unit of mass"):
        study("t100_s", "sem_g", "s", "17.9", "0.02")


CURVE = """
[[target]]
name = "flow"
experiment = "conveyor"
observable = "mass_time"
file = "curve.csv"
x_column = "time_ms"
column = "mass_kg"
se_column = "sem_mg"
levels = [25.0, 50.0, 75.0, 100.0]
"""


def test_curves_are_converted_too(study, tmp_path: Path):
    rows = "time_ms,mass_kg,sem_mg\n1000,0,0\n2000,0.05,100\n3000,0.1,200\n"
    (tmp_path / "curve.csv").write_text(rows)
    curve = study("t100_s", "sem_s", "s", "17.9", "0.02", CURVE).curves["flow"]
    # The time at a level lies between the rows; its error is that of the mass over the slope.
    assert list(curve.levels) == [25.0, 50.0, 75.0, 100.0]
    assert list(curve.values) == pytest.approx([1.5, 2.0, 2.5, 3.0])
    assert list(curve.se) == pytest.approx([0.05 / 50, 0.1 / 50, 0.15 / 50, 0.2 / 50])
    (tmp_path / "curve.csv").write_text(rows)
    with pytest.raises(CalibrationError, match="are in other units than mass_time"):
        study("t100_s", "sem_s", "s", "17.9", "0.02", CURVE.replace('"time_ms"', '"sem_mg"'))
