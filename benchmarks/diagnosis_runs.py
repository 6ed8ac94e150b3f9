"""Record the engine runs behind the tests of the diagnosis.

    python benchmarks/diagnosis_runs.py RUNS_DIR tests/data/diagnose/engine_runs.csv

Runs what RUNS_DIR does not hold yet (about 250 quick runs, an hour on one core) and writes one row
per run: what it depends on, and its observables.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable
from pathlib import Path

import pandas as pd

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "calibrate"))
import diagnose_engine as recorded

from calibrate.diagnose import design
from calibrate.diagnose.command import ENGINE_DESIGN
from calibrate.diagnose.library import problem_of
from calibrate.diagnose.running import with_curve
from calibrate.study import load_study
from liggghts_io import CaseSpec, execute

COHESION, TILT, PERIOD = 25000.0, 5.0, 1.08


def fitter_specs() -> list[CaseSpec]:
    """Return the runs of a local design around the published parameters, and of a second one."""
    path = recorded.CASES / "hsp13_steel.toml"
    problem = problem_of(load_study(path), path, recorded.PUBLISHED)
    found: list[CaseSpec] = []
    for experiment in problem.order():
        points = design.plan(problem, experiment, problem.start, ENGINE_DESIGN)
        found += design.specify(problem, experiment, points)
        points = design.extend(problem, experiment, problem.unit(recorded.SECOND), ENGINE_DESIGN)
        found += design.specify(problem, experiment, points)
    return found


def data_specs() -> list[CaseSpec]:
    """Return the runs from which data are made: nothing hidden, tilt, period, cohesion."""
    conveyors = [w for w in recorded.EXPERIMENTS if w[0] == "conveyor"]
    first = range(501, 504)
    found = [recorded.spec(w, s) for s in first for w in recorded.EXPERIMENTS]
    tilt, cohesion = {"plate_tilt_deg": TILT}, {"cohesion_J_m3": COHESION}
    found += [recorded.spec(w, s, tilt) for s in first for w in conveyors]
    found += [recorded.spec(w, s, {}, {"period_factor": PERIOD}) for s in first for w in conveyors]
    found += [recorded.spec(w, s, cohesion) for s in first for w in recorded.EXPERIMENTS]
    return found


def main(root: Path, table: Path) -> None:
    """Run what is missing and write the table."""
    write(((s, execute(s, root)) for s in [*fitter_specs(), *data_specs()]), table)


def write(runs: Iterable[tuple], table: Path) -> None:
    """Write one row per successful run."""
    rows = {}
    for spec, result in runs:
        if result.status == "ok":
            shown = with_curve(result).observables
            rows[recorded.key(spec)] = json.dumps({k: round(v, 6) for k, v in shown.items()})
    frame = pd.DataFrame({"run": rows.keys(), "observables": rows.values()})
    with table.open("w", encoding="utf-8") as file:
        file.write(f"# python benchmarks/diagnosis_runs.py RUNS_DIR {table}\n")
        frame.to_csv(file, index=False)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
