r"""Runs with one cause on once more, with other seeds: they tell luck from what an answer has.

    python -m benchmarks.causes.again OUT.csv.gz --cause cohesion_J_m3 --experiment heap \
        --of cases/challenge/runs/one_material.csv.gz cases/challenge/runs/small_strengths.csv.gz

With one run at each set of parameters, an answer that differs there from what is smooth and a run
that scatters look the same. Started again, it goes on where it was.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

from rich.console import Console

from calibrate.cli.running import running
from calibrate.cli.show.progress import RunsBar
from calibrate.runs.executors.run_options import RunOptions
from calibrate.runs.stored import RUNS
from calibrate.runs.table import finished_rows, read_rows, write_rows
from liggghts_io import CaseSpec

OTHER_SEED = 500_000
"""What is added to a seed; far from those of designs and of suites."""


def cases(tables: list[Path], cause: str, experiments: list[str]) -> list[CaseSpec]:
    """Return the finished runs of tables that have one cause on, with other seeds."""
    rows = [row for one in tables for row in read_rows(one) if row.result.status == "ok"]
    return [
        replace(row.spec, seed=row.spec.seed + OTHER_SEED)
        for row in rows
        if row.spec.effects.get(cause) and row.spec.experiment in experiments
    ]


def main() -> None:
    """Run them, and write the table."""
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("out", type=Path, help="table that is written")
    words.add_argument("--cause", required=True)
    words.add_argument("--experiment", nargs="+", required=True)
    words.add_argument("--of", nargs="+", type=Path, required=True, help="tables of runs")
    words.add_argument("--folder", type=Path, required=True, help="where the runs lie meanwhile")
    words.add_argument("--workers", type=int, default=0)
    asked = words.parse_args()
    specs = cases(asked.of, asked.cause, asked.experiment)
    asked.folder.mkdir(parents=True, exist_ok=True)
    bar = RunsBar("runs", Console(stderr=True))
    with running(asked.folder, RunOptions(workers=asked.workers), bar) as campaign:
        campaign(specs, "again")
    made = finished_rows(asked.folder / RUNS)
    write_rows(asked.out, made, "python -m benchmarks.causes.again")
    print(f"{asked.out}: {len(made)} of {len(specs)} runs")


if __name__ == "__main__":
    main()
