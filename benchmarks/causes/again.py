r"""Runs with one cause on once more, with other seeds: they tell luck from what an answer has.

    python -m benchmarks.causes.again OUT.csv.gz --cause cohesion_J_m3 --experiment heap \
        --of cases/challenge/runs/one_material.csv.gz cases/challenge/runs/small_strengths.csv.gz

With one run at each set of parameters, an answer that differs there from what is smooth and a run
that scatters look the same. Started again, it goes on where it was.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from benchmarks.causes.made import make_table, words_of
from calibrate.runs.table import read_rows
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
    words = words_of(__doc__)
    words.add_argument("--cause", required=True)
    words.add_argument("--experiment", nargs="+", required=True)
    asked = words.parse_args()
    specs = cases(asked.of, asked.cause, asked.experiment)
    make_table(specs, asked, "python -m benchmarks.causes.again")


if __name__ == "__main__":
    main()
