"""Effects hidden in data that the engine itself made, found from the CSV files alone.

Runs are recorded in `tests/data/diagnose/engine_runs.csv` (the command that made them stands in
its first line); data come from other parameters and other seeds than the fitter's runs.
"""

from __future__ import annotations

from pathlib import Path

import diagnose_engine as recorded
import numpy as np
import pytest

from calibrate.diagnose import Diagnosis, Options, diagnose
from calibrate.diagnose.command import ENGINE_DESIGN
from calibrate.diagnose.running import with_curve
from liggghts_io import CaseSpec, execute

# Recorded runs only: no further designs and no runs at fitted points.
OPTIONS = Options(design=ENGINE_DESIGN, rounds=1, confirm=0)
SEEDS = (501, 502, 503)
RUNS = recorded.read_runs()


def find(directory: Path, hidden: recorded.Hidden, seed: int, *, curve: bool = True) -> Diagnosis:
    problem = recorded.problem(directory, RUNS, hidden, seed, curve=curve)
    rng = np.random.default_rng(seed)
    found = diagnose(problem, recorded.Recorded(RUNS), rng=rng, options=OPTIONS)
    assert not found.local.failed
    return found


def test_a_tilted_plate_is_found_and_sized(tmp_path: Path) -> None:
    found = find(tmp_path, recorded.Hidden({"plate_tilt_deg": 3.0}, {}, SEEDS), 11)
    assert found.verdict.kind == "named"
    assert found.verdict.names == ("plate_tilt_deg",)
    low, high = found.verdict.intervals["plate_tilt_deg"].interval95
    assert low <= 3.0 <= high
    assert low > 0.0


def test_cohesion_is_found(tmp_path: Path) -> None:
    found = find(tmp_path, recorded.Hidden({"cohesion_J_m3": 25000.0}, {}, SEEDS), 12)
    assert "cohesion_J_m3" in found.verdict.names


@pytest.mark.parametrize("seed", [21, 22, 23, 24])
def test_nothing_hidden_nothing_named(tmp_path: Path, seed: int) -> None:
    chosen = tuple(s for k, s in enumerate(SEEDS) if k != seed % 3)
    found = find(tmp_path, recorded.Hidden({}, {}, chosen), seed)
    assert found.verdict.kind == "none"


def test_a_cause_outside_the_library_is_not_misnamed(tmp_path: Path) -> None:
    """The plate's period is 8 % too long; no candidate does that."""
    wrong_clock = {"conveyor": {"period_factor": 1.08}}
    found = find(tmp_path, recorded.Hidden({}, wrong_clock, SEEDS), 13)
    assert found.verdict.kind != "named"


def test_with_one_time_instead_of_the_curve_causes_form_a_group(tmp_path: Path) -> None:
    """Tilt and flow both change t100; only the curve tells a delay from a rate."""
    hidden = recorded.Hidden({"plate_tilt_deg": 3.0}, {}, SEEDS)
    found = find(tmp_path, hidden, 11, curve=False)
    assert found.verdict.kind in {"group", "none"}


@pytest.mark.slow
@pytest.mark.parametrize("where", [("plate_impact", "steel"), ("conveyor", "steel")])
def test_recorded_runs_are_still_what_the_engine_gives(
    tmp_path: Path, where: tuple[str, str]
) -> None:
    spec = CaseSpec(where[0], "Carbo HSP13", where[1], "quick", recorded.MATERIAL, seed=SEEDS[0])
    stored = RUNS[recorded.key(spec)]
    again = with_curve(execute(spec, tmp_path)).observables
    scatter = recorded.seed_scatter(RUNS)
    for name in recorded.TABLE_SEM[where]:
        # Another processor may round differently, and a granular flow then goes its own way:
        # equal within four standard deviations between seeds.
        assert abs(again[name] - stored[name]) <= 4.0 * scatter[(*where, name)]
