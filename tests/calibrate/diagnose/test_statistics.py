"""Error rates of the diagnosis over many imagined studies on the stand-in.

The full table, made by `python benchmarks/diagnosis_statistics.py`, lies in
`tests/data/diagnose/statistics.csv`.
"""

from __future__ import annotations

import pandas as pd
import pytest
from scipy.stats import beta

from tests.calibrate.diagnose import cases, stand_in
from tests.paths import DATA

TABLE = DATA / "diagnose" / "statistics.csv"
# The stored table has 300; these show that the code still does what the table says.
NULLS = 50


def upper_bound(hits: int, total: int) -> float:
    """Upper end of the 95 % Clopper-Pearson interval of a rate."""
    return float(beta.ppf(0.975, hits + 1, total - hits))


@pytest.mark.slow
def test_without_an_effect_a_cause_is_named_in_at_most_one_of_twenty_studies() -> None:
    found = [cases.nothing(10_000 + k) for k in range(NULLS)]
    named = sum(o.kind == "named" for o in found)
    accused = sum(o.kind in {"named", "group"} for o in found)
    assert named / NULLS <= 0.05
    assert accused / NULLS <= 0.05


def test_an_effect_at_four_times_the_limit_is_named_and_sized() -> None:
    name = "mass_flow_factor"
    found = [cases.planted(40 + k, name, cases.strength_at(name, 4.0)) for k in range(3)]
    assert sum(o.kind == "named" and o.names == name for o in found) >= 2
    # Each interval misses with 5 %; two of three missing would happen once in 140 times.
    assert sum(o.covered for o in found) >= 2


def test_an_effect_far_below_the_limit_is_not_named_wrongly() -> None:
    name = "size_distribution"
    found = [cases.planted(60 + k, name, 0.2 * cases.DETECTABLE[name]) for k in range(8)]
    assert sum(o.named_wrong for o in found) <= 1


def test_causes_with_one_signature_are_reported_as_a_group() -> None:
    library = (*stand_in.LIBRARY, stand_in.TWIN)
    found = cases.run(7, {"tilt": 2.6}, library)
    assert found.verdict.kind == "group"
    assert {"plate_tilt_deg", "table_slope_deg"} <= set(found.verdict.names)
    assert "table_slope_deg" in found.absorption.of("plate_tilt_deg").alike


def test_the_stored_table_holds_the_error_rates() -> None:
    table = pd.read_csv(TABLE, comment="#", keep_default_na=False, na_values=["nan"])
    nulls = table[table.what == "nothing"]
    named = int((nulls.kind == "named").sum())
    assert len(nulls) >= 200
    assert upper_bound(named, len(nulls)) <= 0.05
    again = cases.nothing(int(nulls.seed.iloc[0]))
    assert again.p_search == pytest.approx(float(nulls.p_search.iloc[0]), abs=1e-4)
