"""Both engines measure the same, within what seeds scatter."""

from __future__ import annotations

import pandas as pd
import pytest

from benchmarks.engine.engines_agree import (
    ENGINES,
    GRAINS,
    ONE_SIZE,
    RUN,
    SAME,
    compared,
    pairs,
    stored,
    table,
    together,
)
from liggghts_io import execute
from liggghts_io.experiments import EXPERIMENTS
from tests.paths import ROOT

ROWS = stored()
COMPARED = compared(ROWS)
FEWEST_FREEDOM = 4
"""Of a pooled scatter: with less, three of its standard errors would be no bound."""
PAIRS = {(one.experiment, one.wall, one.grains): one for one in pairs()}
SEEDS = ROWS.pivot_table("seed", [*RUN[:3], "observable"], "engine", aggfunc=set).dropna()


def test_every_experiment_was_run_on_both_engines():
    found = SEEDS.reset_index().groupby(list(RUN[:3]))["observable"].agg(set)
    assert {experiment for experiment, *_ in found.index} == set(EXPERIMENTS)
    assert set(found.index) <= set(PAIRS)
    for (experiment, *_), names in found.items():
        assert names == {one.name for one in EXPERIMENTS[experiment].observables}


def test_grains_of_measured_sizes_of_every_material_were_run():
    assert {name for *_, name, _ in SEEDS.index} == set(GRAINS)


@pytest.mark.parametrize("key", list(ROWS.groupby(SAME, sort=False).groups))
def test_means_agree_within_three_standard_errors(key):
    """Each particle, and all of them together: that shows a bias that no particle shows alone."""
    found = COMPARED[(COMPARED[SAME] == list(key)).all(axis=1)]
    assert found["freedom"].min() >= FEWEST_FREEDOM
    assert found["z"].abs().max() <= 3.0, found.to_string()
    assert together(found).abs().max() <= 3.0, found.to_string()


def test_the_comparison_finds_engines_that_differ():
    """One part in ten more angle on every cone: no seed makes that."""
    other = ROWS.copy()
    wrong = (other["experiment"] == "heap") & (other["engine"] == "liggghts")
    other.loc[wrong, "value"] *= 1.1
    heaps = compared(other[other["experiment"] == "heap"])
    assert together(heaps).abs().min() > 3.0


def test_the_page_shows_the_table_of_the_stored_rows():
    assert "\n".join(table(ROWS)) in (ROOT / "docs/verification.md").read_text(encoding="utf-8")


def reproduced(key: tuple[str, str, str], engine: str, tmp_path) -> tuple[pd.Series, pd.Series]:
    """Return stored and found values of a case with seed 1, by observable."""
    known = ROWS[(ROWS[list(RUN)] == [*key, engine, 1]).all(axis=1)]
    found = execute(PAIRS[key].spec(engine, 1), tmp_path)
    assert found.status == "ok", found.reason
    return known.set_index("observable")["value"], pd.Series(found.observables)


@pytest.mark.liggghts
@pytest.mark.parametrize("engine", ENGINES)
def test_a_stored_tilting_plate_is_reproduced(tmp_path, engine):
    """Grains that only touch a plate do not amplify rounding: all digits that matter come again."""
    known, found = reproduced(("tilting_plate", "flat", "Carbo HSP13"), engine, tmp_path)
    assert found[known.index].to_numpy() == pytest.approx(known.to_numpy(), abs=1e-5)


@pytest.mark.parametrize(
    "engine",
    ["minidem", pytest.param("liggghts", marks=[pytest.mark.liggghts, pytest.mark.slow])],
)
@pytest.mark.parametrize("experiment", ["drum", "plate_impact"])
def test_a_stored_run_is_reproduced(tmp_path, experiment, engine):
    """Another compiler may round otherwise, and collisions amplify it: then only seeds bind."""
    key = (experiment, "flat", ONE_SIZE)
    known, found = reproduced(key, engine, tmp_path)
    rows = COMPARED[(COMPARED[list(RUN[:3])] == list(key)).all(axis=1)]
    allowed = 4.0 * rows.set_index("observable")["error"]
    assert set(found.index) == set(known.index)
    for name, value in known.items():
        assert found[name] == pytest.approx(value, abs=allowed[name])
