"""Curves that a run did not end are drawn on as whole ones go on."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from calibrate.questions.core.forms import Emulated, Form
from calibrate.questions.core.outputs import drawn_on, outputs_of
from calibrate.scales import forward

LEVELS = np.arange(1.0, 9.0)


def _curves(count, rng):
    """Return curves of two numbers each, which their first levels tell."""
    start, bend = rng.normal(2.0, 0.5, count), rng.normal(0.1, 0.03, count)
    return start[:, None] + 0.5 * LEVELS + bend[:, None] * LEVELS**2


def test_what_a_run_did_not_reach_follows_from_what_it_reached(rng):
    whole = _curves(100, rng)
    cut = whole.copy()
    cut[0, 7:], cut[1, 4:], cut[2, 3:] = np.nan, np.nan, np.nan
    found = drawn_on(cut)
    # Of the size of what each level is given for itself.
    assert found[:2] == pytest.approx(whole[:2], abs=0.02)
    np.testing.assert_array_equal(found[2], cut[2])  # less than half
    np.testing.assert_array_equal(found[3:], whole[3:])


def test_slow_grains_are_not_made_faster_by_the_end_of_their_runs(rng):
    """The mean over all runs, of which a tenth does not end, is that of all curves."""
    whole = _curves(2000, rng) + 0.05 * rng.standard_normal((2000, 8)).cumsum(axis=1)
    end = np.quantile(whole[:, -1], 0.9)
    seen = np.where(whole <= end, whole, np.nan)
    lucky = seen[np.isfinite(seen).all(axis=1), -1].mean()
    bias, mean = lucky - whole[:, -1].mean(), whole[:, -1].mean()
    # A tenth that is left out, 1.75 spreads above the mean (the upper tenth of a normal one).
    assert bias == pytest.approx(-0.195 * whole[:, -1].std(), rel=0.1)
    # The unfinished curves scatter by 0.1 about what is expected; a few percent of the bias stay.
    assert drawn_on(seen)[:, -1].mean() == pytest.approx(mean, abs=0.1 * abs(bias))


def test_a_hole_in_a_curve_and_too_few_whole_ones_stay(rng):
    curves = _curves(100, rng)
    curves[0, 6] = np.nan
    np.testing.assert_array_equal(drawn_on(curves), curves)
    few = curves[1:21]
    few[0, 7:] = np.nan
    np.testing.assert_array_equal(drawn_on(few), few)


def test_outputs_of_a_form(rng):
    levels = tuple(map(float, LEVELS))
    outputs = (
        Emulated("mass_time", "log", slice(0, 8), levels),
        Emulated("m1_g", "linear", slice(8, 9)),
    )
    form = Form("conveyor", "flat", (), (), outputs)
    curves = np.exp(_curves(60, rng))
    table = pd.DataFrame(curves, columns=outputs[0].table_columns)
    table["status"], table["m1_g"] = "ok", np.arange(60.0)
    table.loc[0, "status"], table.loc[1, "mass_time@8"] = "failed", np.nan
    y = outputs_of(form, table)
    assert np.isnan(y[0]).all()
    np.testing.assert_array_equal(y[2:, :8], forward("log", curves[2:]))
    np.testing.assert_array_equal(y[1:, 8], np.arange(1.0, 60.0))
    # Of the size of what each level is given for itself.
    assert y[1, 7] == pytest.approx(np.log(curves[1, 7]), abs=0.02)
