"""Make the runs from which a diagnosis of the five proppants learns what causes do.

    python -m benchmarks.paper.causes --out causes               # all that are missing
    python -m benchmarks.paper.causes --out causes --minutes 60  # as far as that goes
    python -m benchmarks.paper.causes --out causes --plan        # their size, no run

Each repeats a run of `cases/proppants/runs/quick.csv.gz` with one cause on, as `bulkcal diagnose`
does, but spread over the materials: most stored runs are of HSP13, and what air does to the
smallest grains these do not tell. All materials and causes are equally far at any time.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from benchmarks.paper import sources
from benchmarks.paper.campaign import asked, run, size_of
from calibrate.causes.studies.from_study import considered, with_effects
from calibrate.causes.studies.twins import spread_over, twin_strengths
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.stored import question
from calibrate.runs.stored import RUNS
from calibrate.runs.table import finished_rows, read_rows, write_rows
from liggghts_io import CaseSpec

STUDY: Final = "proppants"
TABLE: Final = sources.CASES / "runs" / "causes.csv.gz"
COUNTS: Final = {"Carbo HSP13": 4, "Carbo HSP30/60": 1}
"""Twins of each cause in each experiment by grains; the smallest take the longest."""
OTHERS: Final = 2


def wanted() -> list[CaseSpec]:
    """Return all twins, causes and materials side by side."""
    data = sources.study(STUDY)
    base = sources.runs_for(data)
    effects = data.study.layout.effects
    names = [effect.name for effect in considered(data.study) if effect.needs_runs]
    good = (base.table["status"] == "ok").to_numpy()
    found: list[tuple[float, CaseSpec]] = []
    for key, form in forms_of(with_effects(data)).items():
        plain = [base.specs[i] for i in np.flatnonzero(base.of(key) & good)]
        for number, switch in enumerate(form.switches):
            if switch.name not in names:
                continue
            for grains in sources.MATERIALS:
                mine = [spec for spec in plain if spec.particle.name == grains]
                at = spread_over(len(mine), number, COUNTS.get(grains, OTHERS))
                strengths = twin_strengths(effects[switch.name], switch, len(at))
                for k, (i, x) in enumerate(zip(at, strengths, strict=True)):
                    twin = replace(mine[i], effects={**mine[i].effects, switch.name: x})
                    found.append((k / len(at), twin))
    return [spec for _, spec in sorted(found, key=lambda one: one[0])]


def missing() -> list[CaseSpec]:
    """Return those that the table lacks."""
    known = {question(row.spec) for row in sources.rows(TABLE)}
    return [spec for spec in wanted() if question(spec) not in known]


def keep(out: Path) -> int:
    """Add the finished runs of a directory to the table; return how many that holds then."""
    rows = [*(read_rows(TABLE) if TABLE.exists() else []), *finished_rows(out / RUNS)]
    if not rows:
        return 0  # a table without a row is none that could be read
    once = {question(row.spec): row for row in rows}
    return write_rows(TABLE, once.values(), "python -m benchmarks.paper.causes")


def main() -> None:
    """Plan or run as asked."""
    chosen = asked(__doc__.splitlines()[0]).parse_args()
    if chosen.plan:
        print(size_of(missing()))
        return

    def kept() -> str:
        return f"{keep(chosen.out)} runs in {TABLE.name}"

    run(missing(), kept, chosen.out, chosen.minutes, chosen.workers)


if __name__ == "__main__":
    main()
