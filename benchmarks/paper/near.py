"""Make runs where the fit of several proppants together lies, and keep them in a table.

    python -m benchmarks.paper.near --out near --rounds 4
    python -m benchmarks.paper.near --out near --study finer --rounds 2

Emulators of the first design know the masses in the boxes to some grams there, measurements to a
tenth of one. A round fits all measured values to the runs that are there, and runs the engine at
the most probable values and at draws about them, for every material, experiment and wall; what
takes more than `MOST` is left out (the conveyor with the smallest grains).
"""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np
from threadpoolctl import threadpool_limits

from benchmarks.paper import sources
from benchmarks.paper.campaign import STUDY, asked, particle_steps, run, size_of
from calibrate.planning.infill import on_grid
from calibrate.questions.core.design import joint_rng
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.stored import question, tabled_runs
from calibrate.questions.joint.check import check_cases
from calibrate.questions.joint.knowledge import learnt
from calibrate.runs.stored import RUNS
from calibrate.runs.table import finished_rows, write_rows
from liggghts_io import CaseSpec

TABLE: Final = sources.CASES / "runs" / "near.csv.gz"
DRAWS: Final = 3
MOST: Final = 6e8
"""Particle-steps of a run, half a minute to a minute."""


def wanted(study: str) -> list[CaseSpec]:
    """Return the cases of the next round of a study."""
    data = sources.study(study)
    forms, rng = forms_of(data), joint_rng(data.study)
    tables = [path for path in (sources.RUNS, TABLE) if path.exists()]
    with threadpool_limits(limits=1):
        known = learnt(data, forms, tabled_runs(data, forms, *tables), rng)
    space, posterior = known.problem.space, known.posterior
    points = np.vstack([posterior.best[None], posterior.draws(DRAWS, rng)])
    values = space.values_of(on_grid(space.units(points)))
    cases = check_cases(data.study, known.problem, known.emulators, values)
    return sorted((one for one in cases if particle_steps(one) <= MOST), key=particle_steps)


def keep(out: Path) -> int:
    """Add the finished runs of a directory to the table; return how many that holds then."""
    once = {question(row.spec): row for row in (*sources.rows(TABLE), *finished_rows(out / RUNS))}
    return write_rows(TABLE, once.values(), "python -m benchmarks.paper.near") if once else 0


def main() -> None:
    """Plan or run as asked."""
    options = asked(__doc__.splitlines()[0])
    options.add_argument("--rounds", type=int, default=1)
    options.add_argument("--study", default=STUDY, help="fitted, one of cases/proppants")
    chosen = options.parse_args()

    def kept() -> str:
        return f"{keep(chosen.out)} runs in {TABLE.name}"

    for number in range(chosen.rounds):
        cases = wanted(chosen.study)
        print(f"round {number + 1} of {chosen.rounds}: {size_of(cases)}", flush=True)
        if chosen.plan:
            return
        run(cases, kept, chosen.out, chosen.minutes, chosen.workers)


if __name__ == "__main__":
    main()
