"""What the recorded heaps say of slice, cone and poured mass."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from benchmarks.heap_scales import HEAPS, TRUTH, table
from tests.paths import DATA, ROOT

ROWS = pd.read_csv(DATA / "heap_scales.csv")
LEAST_SCATTER_DEG = 0.3
"""Standard error of one cone from its flanks, for sets of few seeds."""
LITTLE_DEG = 1.0


def angle(heap: str, parameters: str) -> tuple[float, float]:
    """Return the mean angle of a heap and its standard error, both [deg]."""
    found = ROWS[(ROWS["heap"] == heap) & (ROWS["parameters"] == parameters)]["angle_deg"]
    assert len(found), (heap, parameters)
    scatter = max(found.std(ddof=1) if len(found) > 1 else 0.0, LEAST_SCATTER_DEG)
    return float(found.mean()), float(scatter / np.sqrt(len(found)))


def test_the_page_shows_the_table_of_the_recorded_rows() -> None:
    assert "\n".join(table(ROWS)) in (ROOT / "docs/apparatus.md").read_text(encoding="utf-8")


def test_every_heap_was_run_and_no_run_failed() -> None:
    assert set(ROWS["heap"]) == set(HEAPS)
    assert np.isfinite(ROWS["angle_deg"]).all()


@pytest.mark.parametrize("parameters", HEAPS["cone, 80 g"].sets)
def test_beyond_40_g_twice_the_mass_moves_the_angle_by_little(parameters: str) -> None:
    """A degree with its error of 0.4; between 20 and 40 g it is 17 degrees on steel."""
    (one, error), (twice, other) = angle(TRUTH, parameters), angle("cone, 80 g", parameters)
    assert abs(twice - one) < LITTLE_DEG + 2.0 * np.hypot(error, other)


def test_a_cone_of_few_grains_is_no_heap_on_steel() -> None:
    assert angle("cone, 20 g", "steel, published")[0] < 15.0


@pytest.mark.parametrize("parameters", HEAPS["slice, quick"].sets)
def test_a_slice_that_grows_is_steeper_than_a_cone_by_much_the_same(parameters: str) -> None:
    above = angle("slice, quick", parameters)[0] - angle(TRUTH, parameters)[0]
    assert 6.5 < above < 10.5
