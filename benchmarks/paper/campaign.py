"""Make the runs of the five proppants' first design, and keep them in the table of runs.

    python -m benchmarks.paper.campaign --out proppants               # all that are missing
    python -m benchmarks.paper.campaign --out proppants --minutes 60  # as far as that goes
    python -m benchmarks.paper.campaign --out proppants --plan        # their size, no run
    python -m benchmarks.paper.campaign --out hsp13 --add             # only add what DIR holds

Whatever the table holds already is not run again. Every material and experiment is equally far at
any time, so that a campaign that was cut short says something of all.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from rich.console import Console

from benchmarks.paper import sources
from calibrate.cli.running import running
from calibrate.cli.show.progress import RunsBar
from calibrate.questions.core.design import first_cases, joint_rng
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.stored import question
from calibrate.runs.executors.run_options import RunOptions
from calibrate.runs.stored import RUNS
from calibrate.runs.table import finished_rows, write_rows
from liggghts_io import CaseSpec
from liggghts_io.case.spec import script_of
from liggghts_io.measure.schedule import load_of

STUDY = "proppants"
BATCH = 24
"""Runs after which the table is written."""


def missing() -> list[CaseSpec]:
    """Return the cases of the design that the table lacks, all places side by side."""
    data = sources.study(STUDY)
    places: dict[tuple[str, ...], list[CaseSpec]] = {}
    for spec in first_cases(data.study, forms_of(data), joint_rng(data.study)):
        places.setdefault((spec.particle.name, spec.experiment, spec.surface), []).append(spec)
    parts = [
        (number / len(specs), spec)
        for specs in places.values()
        for number, spec in enumerate(specs)
    ]
    known = {question(row.spec) for row in sources.rows()}
    ordered = [spec for _, spec in sorted(parts, key=lambda part: part[0])]
    return [spec for spec in ordered if question(spec) not in known]


def particle_steps(spec: CaseSpec) -> float:
    """Return the most grains that there are times steps."""
    load = load_of(script_of(spec))
    return load.grains * load.steps


def keep(out: Path) -> int:
    """Add the finished runs of a directory to the table; return how many that holds then."""
    rows = {row.result.case_id: row for row in (*sources.rows(), *finished_rows(out / RUNS))}
    return write_rows(sources.RUNS, rows.values(), "python -m benchmarks.paper.campaign")


def _batches(specs: list[CaseSpec]) -> Iterator[list[CaseSpec]]:
    for start in range(0, len(specs), BATCH):
        yield specs[start : start + BATCH]


def run(
    specs: list[CaseSpec], keep: Callable[[], str], out: Path, minutes: float, workers: int
) -> None:
    """Run cases until the time is spent; after each batch they are kept, and what is said of it."""
    end = time.monotonic() + 60.0 * minutes
    bar = RunsBar("runs for the table", Console(stderr=True))
    with running(out, RunOptions(workers=workers), bar) as campaign:
        for number, batch in enumerate(_batches(specs)):
            if time.monotonic() > end:
                break
            campaign.results(batch, f"{number * BATCH} of {len(specs)}")
            bar.say(keep())


def asked(about: str) -> argparse.ArgumentParser:
    """Return the options that campaigns share."""
    parser = argparse.ArgumentParser(description=about)
    parser.add_argument("--out", type=Path, required=True, help="directory of the runs")
    parser.add_argument("--minutes", type=float, default=float("inf"))
    parser.add_argument("--workers", type=int, default=0)
    parser.add_argument("--plan", action="store_true")
    return parser


def size_of(specs: list[CaseSpec]) -> str:
    """Return how many runs there are, and how much work at most."""
    return f"{len(specs)} runs, {sum(map(particle_steps, specs)):.3g} particle-steps"


def main() -> None:
    """Plan, run or add as asked."""
    parser = asked(__doc__.splitlines()[0])
    parser.add_argument("--add", action="store_true")
    chosen = parser.parse_args()

    def kept() -> str:
        return f"{keep(chosen.out)} runs in {sources.RUNS.name}"

    if chosen.plan:
        print(size_of(missing()))
    elif chosen.add:
        print(kept())
    else:
        run(missing(), kept, chosen.out, chosen.minutes, chosen.workers)


if __name__ == "__main__":
    main()
