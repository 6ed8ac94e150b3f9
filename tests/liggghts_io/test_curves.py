"""Curves of the built-in experiments at fixed levels, and what they have in common with numbers."""

from dataclasses import replace

import numpy as np
import pytest

from liggghts_io import CaseError, execute, read_curve
from liggghts_io.experiments import EXPERIMENTS
from liggghts_io.measure.levels import at_levels


def test_a_level_is_where_the_curve_first_reaches_it():
    x = np.array([1.0, 3.0, 2.0, 5.0])
    found = at_levels(x, np.array([10.0, 30.0, 35.0, 50.0]), np.array([0.5, 1.0, 2.0, 4.0, 6.0]))
    np.testing.assert_allclose(found, [np.nan, 10.0, 20.0, 45.0, np.nan], rtol=1e-12)


def test_a_curve_of_no_rows_reaches_nothing():
    assert np.isnan(at_levels(np.array([]), np.array([]), np.array([1.0]))).all()


@pytest.mark.parametrize("one", EXPERIMENTS.values(), ids=lambda one: one.name)
def test_every_curve_rises_in_its_levels_and_numbers_name_their_curve(one):
    for curve in one.curves:
        assert list(curve.levels) == sorted(set(curve.levels))
        assert one.curve_named(curve.name) is curve
    for observable in one.observables:
        assert observable.part_of in ("", *(curve.name for curve in one.curves))
    with pytest.raises(CaseError, match="unknown curve"):
        one.curve_named("cruve")


def test_the_time_at_the_target_lies_on_the_mass_time_curve(timed_spec, tmp_path):
    result = execute(timed_spec(), tmp_path)
    curve = replace(EXPERIMENTS["conveyor"].curves[0], levels=(5.0, 10.0, 20.0, 1e6))
    times = read_curve(result, curve)
    assert times[2] == pytest.approx(result.observables["t100_s"], rel=1e-4)  # 20 g is the target
    assert times[0] < times[1] < times[2]
    assert np.isnan(times[3])


def test_the_flank_falls_from_the_middle(small_spec, tmp_path):
    height = read_curve(execute(small_spec("heap"), tmp_path), EXPERIMENTS["heap"].curves[0])
    assert np.isfinite(height).all()
    assert height[0] > height[4] > height[-1] > 0.0


def test_a_failed_run_has_no_curve(timed_spec, tmp_path):
    result = replace(execute(timed_spec(), tmp_path), status="failed")
    assert np.isnan(read_curve(result, EXPERIMENTS["conveyor"].curves[0])).all()
