"""Which runs of causes the programs in benchmarks/causes ask for."""

from __future__ import annotations

from benchmarks.causes import again, twins
from calibrate.runs.table import read_rows
from tests.paths import ROOT

CASES = ROOT / "cases" / "challenge"
TABLE = CASES / "runs" / "one_material.csv.gz"
CAUSE = "cohesion_J_m3"


def test_once_more_is_the_same_case_with_another_seed():
    asked = again.cases([TABLE], CAUSE, ["heap"])
    good = [row.spec for row in read_rows(TABLE) if row.result.status == "ok"]
    known = {
        spec.seed + again.OTHER_SEED: spec
        for spec in good
        if spec.effects.get(CAUSE) and spec.experiment == "heap"
    }
    assert len(asked) == len(known) > 0
    for spec in asked:
        assert spec.parameters == known[spec.seed].parameters
        assert spec.effects == known[spec.seed].effects


def test_further_twins_are_of_runs_that_have_none_at_strengths_of_all_sizes():
    asked = twins.cases(CASES / "one_material.toml", [TABLE], CAUSE, "plate_impact", 20)
    rows = [row.spec for row in read_rows(TABLE) if row.spec.experiment == "plate_impact"]
    have = {spec.seed for spec in rows if spec.effects.get(CAUSE)}
    plain = {spec.seed: spec for spec in rows if not any(spec.effects.values())}
    assert len({spec.seed for spec in asked}) == 20
    assert not have & {spec.seed for spec in asked}
    for spec in asked:
        assert spec.parameters == plain[spec.seed].parameters
    sizes = sorted(spec.effects[CAUSE] for spec in asked)
    # From a twelfth of five ordinary strengths, 15 kJ/m3 each, evenly by their logarithms.
    assert 75e3 / 12.0 <= sizes[0] < 75e3 / 8.0
    assert 75e3 / 1.5 < sizes[-1] <= 75e3
