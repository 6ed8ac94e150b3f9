"""What in a log of a scale cannot be right is refused, what is odd is said."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibrate.errors import CalibrationError
from calibrate.laboratory.instrument.series import Form
from calibrate.laboratory.scale.doubts import doubts_about, refuse_early_onset
from calibrate.laboratory.scale.log import read_mass_curve
from tests.calibrate.laboratory.logs import curve_of, flow, series, written

POURED_G = 300.0


def log(**changes):
    return flow(np.random.default_rng(31), **changes)[0]


def test_a_good_log_raises_no_doubt():
    assert doubts_about(curve_of(log()), 100.0, POURED_G) == []


@pytest.mark.parametrize(
    ("times", "grams", "words"),
    [
        (
            1.0,
            1e3,
            ["g/s is none of a funnel", "100 g are 0.033 %", "lie on the scale in the"],
        ),
        (1e3, 1.0, ["a flow of 0.0192 g/s is none of a funnel"]),
        (1.0, 1.5, ["450 g lie on the scale in the end, and the experiment pours 300 g"]),
    ],
)
def test_a_wrong_unit_of_the_head_is_said(times: float, grams: float, words: list[str]):
    """Kilograms over grams, milliseconds over seconds, and half as much more than is poured."""
    good = log()
    wrong = series(good.time_s * times, good.values * grams, tick_s=times * 1e-3, tick=grams * 0.01)
    found = doubts_about(curve_of(wrong), 100.0, POURED_G)
    assert len(found) == len(words)
    for one, expected in zip(found, words, strict=True):
        assert expected in one


def test_grains_before_the_funnel_is_open_are_refused():
    refuse_early_onset(curve_of(log(), 4.0))  # it comes at 4.7 s
    with pytest.raises(
        CalibrationError, match=r"grains flow onto the scale 5\.\d+ s before the funnel"
    ):
        refuse_early_onset(curve_of(log(), 10.0))


def test_the_zero_of_the_time_is_said_where_nobody_gave_it(tmp_path: Path):
    path = written(tmp_path / "run.csv", log())
    assert "times count from the zero of its clock" in read_mass_curve(path, Form()).remarks[-1]
    assert not any("times count" in one for one in read_mass_curve(path, Form(), "0.5").remarks)


def test_a_scale_that_grains_leave_is_told_from_one_that_they_reach(tmp_path: Path):
    good = log()
    path = written(tmp_path / "run.csv", replace(good, values=365.0 - good.values))
    with pytest.raises(
        CalibrationError, match=r"the mass falls from 365 to 6[45].* as on a scale that"
    ):
        read_mass_curve(path, Form())


def test_swapped_columns_are_thought_of(tmp_path: Path):
    path = written(tmp_path / "run.csv", log())
    text = path.read_text()
    path.write_text(text.replace("time [s],mass [g]", "mass [g],time [s]"))
    with pytest.raises(CalibrationError, match="or correct the head where columns are swapped"):
        read_mass_curve(path, Form())
