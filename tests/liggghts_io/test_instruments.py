"""What an instrument shows wrongly: readings of a finished run, changed as it would show them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from liggghts_io.case.spec import setup_of
from liggghts_io.effects import EFFECTS
from liggghts_io.experiments.setup import Observed

TIMES = np.array([0.0, 1.0, 2.0, 6.0])
MASSES = np.array([0.0, 40.0, 80.0, 240.0])


@pytest.fixture
def conveyor(make_spec):
    setup = setup_of(make_spec("conveyor"))
    target = 1e3 * setup.apparatus["target_mass_kg"]
    table = {"time_s": TIMES, "mass_g": MASSES * target / 160.0}
    return setup, Observed({"t100_s": 4.0, "rate_g_s": 3.0}, {"mass_time.csv": table})


def test_a_fast_clock_stretches_all_times_and_no_mass(conveyor):
    setup, seen = conveyor
    read = EFFECTS["clock_factor"].read(seen, 0.05, setup)
    assert read.values == {"t100_s": pytest.approx(4.2), "rate_g_s": pytest.approx(3.0 / 1.05)}
    assert read.tables["mass_time.csv"]["time_s"] == pytest.approx(1.05 * TIMES)
    assert np.array_equal(
        read.tables["mass_time.csv"]["mass_g"], seen.tables["mass_time.csv"]["mass_g"]
    )
    assert seen.values["t100_s"] == 4.0


def test_a_balance_that_shows_too_much_reaches_the_target_earlier(conveyor):
    setup, seen = conveyor
    read = EFFECTS["balance_factor"].read(seen, 0.05, setup)
    shown = read.tables["mass_time.csv"]["mass_g"]
    assert shown == pytest.approx(1.05 * seen.tables["mass_time.csv"]["mass_g"])
    assert read.values["rate_g_s"] == pytest.approx(3.15)
    # The curve rises by a quarter of the target's mass per second after 2 s.
    assert read.values["t100_s"] == pytest.approx(4.0 / 1.05)


def test_a_balance_scales_what_lies_in_boxes(make_spec):
    setup = setup_of(make_spec("plate_impact"))
    read = EFFECTS["balance_factor"].read(Observed({"m1_g": 30.0, "share": 0.4}), -0.02, setup)
    assert read.values == {"m1_g": pytest.approx(29.4), "share": 0.4}


def test_a_tilted_camera_adds_to_the_angle_and_turns_the_flank(make_spec):
    setup = setup_of(make_spec("heap"))
    flank = {"distance": np.array([0.0, 0.5, 1.0]), "height": np.array([0.7, 0.35, 0.0])}
    seen = Observed({"angle_deg": 35.0}, {"flank.csv": flank})
    read = EFFECTS["camera_tilt_deg"].read(seen, 2.0, setup)
    assert read.values["angle_deg"] == 37.0
    fall = math.tan(math.radians(2.0))
    assert read.tables["flank.csv"]["height"] == pytest.approx([0.7 + fall, 0.35 + 0.5 * fall, 0.0])


def test_a_stretched_picture_scales_tangents(make_spec):
    setup = setup_of(make_spec("heap"))
    read = EFFECTS["camera_scale"].read(Observed({"angle_deg": 45.0}), 0.1, setup)
    assert read.values["angle_deg"] == pytest.approx(math.degrees(math.atan(1.1)))


@pytest.mark.parametrize(
    ("name", "experiment", "parameter", "strength", "how"),
    [
        ("heap_tilt_deg", "heap", "tilt_x_deg", 2.0, "add"),
        ("box_shift_x_m", "plate_impact", "box_shift_x_m", 0.003, "add"),
        ("plate_amplitude", "conveyor", "amplitude_factor", 0.1, "scale"),
    ],
)
def test_an_apparatus_as_it_was_differs_by_one_number(
    make_spec, name, experiment, parameter, strength, how
):
    setup = setup_of(make_spec(experiment))
    real = EFFECTS[name].prepare(setup, strength)
    believed = setup.apparatus[parameter]
    expected = believed + strength if how == "add" else believed * (1.0 + strength)
    assert real.apparatus == {**setup.apparatus, parameter: pytest.approx(expected)}
    assert setup.apparatus[parameter] == believed
