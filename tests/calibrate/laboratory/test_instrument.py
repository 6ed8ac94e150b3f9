"""Files of scales and sensors, in every dress in which programs write them."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from calibrate.errors import CalibrationError
from calibrate.laboratory.instrument.cells import number_and_unit, seconds_in
from calibrate.laboratory.instrument.quantities import ACCELERATION, MASS, POSITION
from calibrate.laboratory.instrument.series import Form, read_series

TIMES = (0.0, 0.5, 1.0, 2.5)
MASSES = (0.02, -0.01, 12.34, 100.5)


def read(tmp_path: Path, text: str | bytes, quantities=(MASS,), **form):
    path = tmp_path / "log.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_series(path, quantities, Form(**form))


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
@pytest.mark.parametrize("separator", [";", "\t", "|", " ", ","])
@pytest.mark.parametrize("mark", [".", ","])
def test_one_log_in_every_dress(tmp_path, encoding, separator, mark):
    """Lines of the scale before, units in the head or behind numbers, a line about the end."""
    for about, head, unit in itertools.product(
        ("", "Model: XS-2000 für Büro\nMax 3200 g; d = 0.01 g\n\n"),
        ("Zeit [s]{0}Masse [g]\n", "t / s{0}m / g\n", "time_s{0}net_g\n", "time [s]{0}mass\n"),
        ("", " g"),
    ):
        if ("mass\n" in head) != bool(unit) or (separator == " " and "/" in head):
            continue
        rows = []
        for time, mass in zip(TIMES, MASSES, strict=True):
            cells = [f"{time:.2f}".replace(".", mark), f"{mass:+.2f}".replace(".", mark) + unit]
            if separator == "," and mark == ",":
                cells = [f'"{cell}"' for cell in cells]
            rows.append(separator.join(cells))
        text = about + head.format(separator) + "\n".join(rows) + "\r\nEnde der Aufzeichnung\n"
        found = read(tmp_path, text.encode(encoding))
        assert found.time_s.tolist() == list(TIMES)
        assert found.values.tolist() == list(MASSES)
        assert found.tick_s == pytest.approx(0.01)


def test_a_log_without_a_head_and_options_that_say_what_it_does_not(tmp_path):
    found = read(tmp_path, "0;12,5\n500;13,5\n900;14,5\n", time_unit="ms", unit="kg")
    assert found.time_s.tolist() == [0.0, 0.5, 0.9]
    assert found.values.tolist() == [12500.0, 13500.0, 14500.0]


def test_signs_that_stand_apart_and_a_column_of_units(tmp_path):
    found = read(tmp_path, "nr;time [s];net;u;state\n1;0.0;-   0.5;g;S\n2;1.0;+  1.5;g;D\n")
    assert found.values.tolist() == [-0.5, 1.5]


def test_units_below_the_head(tmp_path):
    found = read(tmp_path, "Zeit;Masse\n[ms];[kg]\n0;0,1\n1500;0,2\n")
    assert found.time_s.tolist() == [0.0, 1.5]
    assert found.values.tolist() == [100.0, 200.0]


def test_time_stamps_with_dates_and_past_midnight(tmp_path):
    text = "stamp;mass [g]\n2026-05-01 23:59:59.5;0.0\n2026-05-02 00:00:00.0;1.0\n"
    text += "2026-05-02 00:00:01.25;2.0\n"
    found = read(tmp_path, text)
    assert np.diff(found.time_s).tolist() == [0.5, 1.25]
    assert found.stamped
    assert found.tick_s == pytest.approx(0.01)


@given(st.integers(0, 23), st.integers(0, 59), st.floats(0.0, 59.99))
def test_any_stamp_is_its_seconds(hours, minutes, seconds):
    text = f"{hours}:{minutes:02d}:{seconds:05.2f}"
    assert seconds_in(text) == pytest.approx(3600.0 * hours + 60.0 * minutes + round(seconds, 2))
    assert seconds_in(f"01.05.2026 {text}".replace(".", ",", 0)) == seconds_in(text)


@given(st.text(max_size=15))
def test_any_cell_is_a_time_or_a_reason_and_a_number_or_none(text):
    assert isinstance(seconds_in(text), float | str)
    found = number_and_unit(text)
    assert found is None or found[0]


@pytest.mark.parametrize(
    ("stamp", "tick"), [("14:00:0{}.2Z", 0.1), ("2:00:0{}.25 PM", 0.01), ("14:00:0{}+02:00", 1.0)]
)
def test_what_stands_behind_a_time_is_no_decimal(tmp_path, stamp, tick):
    rows = "".join(f"{stamp.format(k)};{k}.5\n" for k in range(3))
    found = read(tmp_path, f"time;mass [g]\n{rows}")
    assert found.tick_s == pytest.approx(tick)
    assert np.diff(found.time_s).tolist() == [1.0, 1.0]


def test_a_line_of_a_balance_with_a_word_before_the_sign(tmp_path):
    rows = "".join(f"2026-05-01 14:00:0{k}.2  N  +  {k}.50 g\n" for k in range(3))
    assert read(tmp_path, rows).values.tolist() == [0.5, 1.5, 2.5]


@pytest.mark.parametrize(("unit", "grams"), [("lb", 453.59237), ("oz", 28.349523125)])
def test_pounds_and_ounces(tmp_path, unit, grams):
    found = read(tmp_path, f"time [s],mass [{unit}]\n0,1\n1,2\n")
    assert found.values.tolist() == pytest.approx([grams, 2.0 * grams])


def test_the_afternoon():
    assert seconds_in("1:00:00 PM") == 13 * 3600.0
    assert seconds_in("12:00:01 AM") == 1.0


def test_of_several_columns_the_one_that_is_named_or_said(tmp_path):
    text = "time [s];gross [g];net [g]\n0;10.0;1.0\n1;11.0;2.0\n"
    assert read(tmp_path, text).values.tolist() == [1.0, 2.0]
    assert read(tmp_path, text, column="gross").values.tolist() == [10.0, 11.0]


def test_a_sensor_tells_by_its_unit_what_it_measures(tmp_path):
    both = (POSITION, ACCELERATION)
    found = read(tmp_path, "t [s],x [mm]\n0.0,1.0\n0.1,2.0\n", both)
    assert (found.quantity.name, found.values.tolist()) == ("position", [0.001, 0.002])
    found = read(tmp_path, "time_s,a_m_s2\n0.0,1.0\n0.1,2.0\n", both)
    assert (found.quantity.name, found.values.tolist()) == ("acceleration", [1.0, 2.0])
    found = read(tmp_path, "t,signal\n0,1.0\n1,2.0\n", both, time_unit="ms", unit="g")
    assert found.values.tolist() == pytest.approx([9.80665, 19.6133])


WRONG = {
    "empty": ("", "holds no rows of time and a measured number"),
    "words": ("a,b\nc,d\n", "holds no rows of time"),
    "no unit of mass": ("time [s],mass\n0,1\n1,2\n", "column 'mass' does not say its unit"),
    "no unit of time": ("time,mass [g]\n0,1\n1,2\n", "column 'time' does not say its unit"),
    "backwards": ("time [s],mass [g]\n0,1\n2,2\n1,3\n", "log.csv:4: time [s] = '1' is earlier"),
    "no number": ("time [s],mass [g]\n0,1.5\n1,2.5\n2,--\n3,4.5\n", "log.csv:4: mass [g] = '--'"),
    "overload": ("time [s];mass [g]\n0;1.5\n1;OL\n2;2.5\n", "log.csv:3: mass [g] = 'OL' is not"),
    "empty cell": ("time [s];mass [g]\n0;1.5\n1;\n2;2.5\n", "log.csv:3: mass [g] = '' is empty"),
    "two units": ("time [s];mass\n0;1.5 g\n1;2.5 kg\n", "several units, g, kg"),
    "two masses": ("time [s];m 1 [g];m 2 [g]\n0;1.5;1\n1;2.5;2\n", "may all be the mass"),
    "hours?": ("time;mass [g]\n12:01;1.5\n12:02;2.5\n", "may be hours and minutes or minutes"),
    "no minute": ("time;mass [g]\n12:61:00;1.5\n12:62:00;2.5\n", "minutes and seconds go to 59"),
    "cells": ("time [s];mass [g]\n0;1.5\n1;2.5\n2;3.5;4\n3;4.5\n", "log.csv:4: 3 cells under 2"),
    "commas twice": (
        "Zeit [s],Masse [g]\n0,0,35,20\n1,0,35,24\n2,0,35,17\n",
        "log.csv:2: 4 cells under 2 column names: commas stand in the numbers and between",
    ),
    "thousand?": ("time [s];mass [g]\n0;1,500\n1;2,500\n", "may be 1.500 or 1500"),
    "binary": (b"\0\1\2,\3\n", "holds the character"),
}  # fmt: skip


@pytest.mark.parametrize("name", WRONG)
def test_what_cannot_be_read_is_told_with_place_and_remedy(tmp_path, name):
    text, words = WRONG[name]
    with pytest.raises(CalibrationError) as caught:
        read(tmp_path, text)
    assert words in str(caught.value)
    assert "log.csv" in str(caught.value)


def test_a_unit_that_contradicts_the_head_is_refused(tmp_path):
    with pytest.raises(CalibrationError, match="is in g, and --mass-unit says kg"):
        read(tmp_path, "time [s],mass [g]\n0,1\n1,2\n", unit="kg")
    with pytest.raises(CalibrationError, match=r"--mass-unit gg: unknown name 'gg'; did you mean"):
        read(tmp_path, "time [s],mass\n0,1\n1,2\n", unit="gg")


@given(st.binary(max_size=60))
def test_any_bytes_are_a_log_or_one_refusal(tmp_path_factory, raw):
    folder = tmp_path_factory.mktemp("any")
    told = ""
    try:
        found = read(folder, raw, time_unit="s", unit="g")
        told = "log.csv" if len(found.time_s) == len(found.values) >= 1 else "nothing"
    except CalibrationError as err:
        told = str(err)
    assert "log.csv" in told
