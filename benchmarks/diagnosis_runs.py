"""Record the engine runs behind the tests of the diagnosis.

    python benchmarks/diagnosis_runs.py RUNS_DIR tests/data/diagnose/engine_runs.csv [--again]

Runs what the table does not hold yet (a quick run takes about five seconds) and writes one row
per run: what it depends on, and its observables. With --again every run is made anew.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Iterable, Mapping
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

import pandas as pd

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from calibrate.cli.diagnose_study import ENGINE_DESIGN
from calibrate.diagnose.from_study import problem_of
from calibrate.diagnose.local import design
from calibrate.study.data import load_data
from liggghts_io import CaseSpec, execute
from tests.calibrate.diagnose import engine as recorded
from tests.calibrate.diagnose.points import observed


def fitter_specs() -> list[CaseSpec]:
    """Return the runs of a local design around the published parameters, and of a second one."""
    path = recorded.CASES / "hsp13_steel.toml"
    problem = problem_of(load_data(path), recorded.PUBLISHED)
    found: list[CaseSpec] = []
    for experiment in problem.order():
        points = design.plan(problem, experiment, problem.start, ENGINE_DESIGN)
        found += design.specify(problem, experiment, points)
        points = design.extend(problem, experiment, problem.unit(recorded.SECOND), ENGINE_DESIGN)
        found += design.specify(problem, experiment, points)
    return found


def data_specs() -> list[CaseSpec]:
    """Return the runs from which data are made, of every hidden case and of the blind studies."""
    hidden = [recorded.Hidden(), *recorded.every_case().values()]
    return [one.spec(where, seed) for one in hidden for where in recorded.EXPERIMENTS
            for seed in one.seeds]  # fmt: skip


def main(root: Path, table: Path, *, again: bool) -> None:
    """Run what is missing and write the table."""
    known = {} if again or not table.exists() else recorded.read_runs(table)
    specs = {recorded.key(s): s for s in [*fitter_specs(), *data_specs()]}
    missing = [s for k, s in specs.items() if k not in known]
    print(f"{len(specs)} runs, {len(missing)} of them missing", flush=True)
    found = {k: known[k] for k in specs if k in known}
    began = time.monotonic()
    with ProcessPoolExecutor(2) as pool:
        results = pool.map(partial(execute, root=root), missing)
        for count, (spec, result) in enumerate(zip(missing, results, strict=True), 1):
            if result.status == "ok":
                found[recorded.key(spec)] = observed(result, spec)
            if count % 20 == 0:
                print(f"{count} of {len(missing)}, {time.monotonic() - began:.0f} s", flush=True)
                write(found, table)
    write(found, table)


def write(found: Mapping[str, Mapping[str, float]], table: Path) -> None:
    """Write one row per successful run."""
    rows: Iterable[Mapping[str, float]] = found.values()
    shown = [json.dumps({k: round(v, 6) for k, v in one.items()}) for one in rows]
    frame = pd.DataFrame({"run": list(found), "observables": shown})
    with table.open("w", encoding="utf-8") as file:
        file.write(f"# python benchmarks/diagnosis_runs.py RUNS_DIR {table}\n")
        frame.to_csv(file, index=False)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]), again="--again" in sys.argv)
