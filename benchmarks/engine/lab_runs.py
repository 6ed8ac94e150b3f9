"""Run the experiments at `lab` to their end on both engines, and what smaller grains would cost.

    python -m benchmarks.engine.lab_runs            # rows, then both tables
    python -m benchmarks.engine.lab_runs --stored   # the tables alone

Rows go to tests/data/lab_runs.csv as runs end; what is there is not run again. Carbo HSP13 with
its measured sizes, parameters published for it, seed 1; processor time of one core.
"""

from __future__ import annotations

import argparse
import csv
import math
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Final

import pandas as pd

from benchmarks.engine.engines_agree import (
    ENGINES,
    EVERYWHERE,
    LARGEST,
    PARAMETERS,
    PARTICLES,
    SURFACES,
    Pair,
    spent_s,
    stored,
)
from liggghts_io import CaseSpec, Particle, execute
from liggghts_io.case.failure import Failure
from liggghts_io.case.spec import script_of
from liggghts_io.errors import CaseError
from liggghts_io.experiments import EXPERIMENTS
from liggghts_io.materials import FLAT
from liggghts_io.measure.schedule import load_of

ROWS: Final = Path(__file__).resolve().parents[2] / "tests" / "data" / "lab_runs.csv"
COLUMNS: Final = ("experiment", "wall", "engine", "observable", "value", "cpu_s")
FINEST: Final = PARTICLES["Carbo HSP30/60"]
LIMIT_S: Final = 300.0
_STEP: Final = 0.05  # of the factors of coarse graining that are tried


def places() -> Iterator[tuple[str, str]]:
    """Yield experiments and walls, the cheapest first."""
    found = [
        (experiment, wall)
        for experiment in EXPERIMENTS
        for wall in SURFACES
        if wall == FLAT or experiment in EVERYWHERE
    ]
    yield from sorted(found, key=lambda place: particle_steps(*place, LARGEST))


def spec_of(experiment: str, wall: str, particle: Particle, engine: str = ENGINES[0]) -> CaseSpec:
    """Return the case of a run."""
    return CaseSpec(experiment, particle, SURFACES[wall], "lab", PARAMETERS, engine=engine)


def particle_steps(experiment: str, wall: str, particle: Particle) -> float:
    """Return the most grains that there are times steps."""
    load = load_of(script_of(spec_of(experiment, wall, particle)))
    return load.grains * load.steps


def lab_rows(rows: Path = ROWS) -> pd.DataFrame:
    """Return the rows of a file; none where there is no file."""
    return pd.read_csv(rows, comment="#") if rows.exists() else pd.DataFrame(columns=COLUMNS)


def run_all(rows: Path, engines: list[str]) -> None:
    """Make the runs that the file lacks and add a row for each observable."""
    if not rows.exists():
        head = f"# python -m benchmarks.engine.lab_runs\n{','.join(COLUMNS)}\n"
        rows.write_text(head, encoding="utf-8")
    known = pd.read_csv(rows, comment="#")
    done = set(known[list(COLUMNS[:3])].itertuples(index=False, name=None))
    for engine in engines:
        for experiment, wall in places():
            if (experiment, wall, engine) in done:
                continue
            start = spent_s()
            with tempfile.TemporaryDirectory() as root:
                result = execute(spec_of(experiment, wall, LARGEST, engine), Path(root))
            spent = f"{spent_s() - start:.1f}"
            values = result.observables
            if result.failure == Failure.PHYSICS:  # to its end, and no flow from a blocked outlet
                values = dict.fromkeys(
                    (o.name for o in EXPERIMENTS[experiment].observables), math.nan
                )
                print(f"{experiment}, {wall}, {engine}: {result.reason}")
            elif result.status != "ok":
                msg = f"{experiment}, {wall}, {engine}: {result.reason}"
                raise SystemExit(msg)
            with rows.open("a", encoding="utf-8", newline="") as file:
                for name, value in values.items():
                    csv.writer(file, lineterminator="\n").writerow(
                        (experiment, wall, engine, name, f"{value:.6g}", spent)
                    )


def speeds(rows: pd.DataFrame, experiment: str, wall: str) -> dict[str, float]:
    """Return particle-steps per second of each engine in an experiment.

    Of the run itself where it was made, else of its runs at `quick`, else of heaps at `quick`.
    """
    quick = stored().dropna(subset="cpu_s")
    found = {}
    for engine in ENGINES:
        place = (rows[["experiment", "wall", "engine"]] == [experiment, wall, engine]).all(axis=1)
        if place.any():
            seconds = rows[place]["cpu_s"].iloc[0]
            found[engine] = particle_steps(experiment, wall, LARGEST) / seconds
            continue
        alike = quick[(quick["engine"] == engine) & (quick["experiment"] == experiment)]
        if alike.empty:
            alike = quick[(quick["engine"] == engine) & (quick["experiment"] == "heap")]
        runs = alike.drop_duplicates(["experiment", "wall", "particle", "seed"])
        steps = [
            Pair(one.experiment, one.wall, one.particle).particle_steps for one in runs.itertuples()
        ]
        found[engine] = sum(steps) / runs["cpu_s"].sum()
    return found


def table(rows: pd.DataFrame) -> list[str]:
    """Return the lines of the table of HSP13: seconds that were spent, or (expected)."""
    lines = [
        "| experiment | wall | 1e6 grains x steps | minidem (s) | LIGGGHTS (s) "
        "| observables: minidem, LIGGGHTS |",
        "|---|---|---|---|---|---|",
    ]
    for experiment, wall in places():
        group = rows[(rows["experiment"] == experiment) & (rows["wall"] == wall)]
        steps = particle_steps(experiment, wall, LARGEST)
        made = set(group["engine"])
        cells = [
            f"{steps / speed:.0f}" if engine in made else f"({steps / speed:.0f})"
            for engine, speed in speeds(rows, experiment, wall).items()
        ]
        values = group.pivot_table("value", "observable", "engine", dropna=False)
        words = [
            f"{name} " + ", ".join(_number(values[one][name]) for one in ENGINES if one in values)
            for name in dict.fromkeys(group["observable"])
        ]
        lines.append(
            f"| {experiment} | {wall} | {steps / 1e6:.0f} | {' | '.join(cells)} "
            f"| {'; '.join(words) or '-'} |"
        )
    return lines


def _number(value: float) -> str:
    return "none" if math.isnan(value) else f"{value:.4g}"


def finest(rows: pd.DataFrame) -> list[str]:
    """Return the lines of what the finest grains cost, at the speeds of the other table."""
    lines = [
        f"| experiment | wall | 1e6 grains x steps, {FINEST.name} | minidem (min) | LIGGGHTS (min) "
        "| coarse graining for 5 min: minidem, LIGGGHTS |",
        "|---|---|---|---|---|---|",
    ]
    for experiment, wall in places():
        steps = particle_steps(experiment, wall, FINEST)
        known = speeds(rows, experiment, wall).values()
        times = " | ".join(f"{steps / speed / 60.0:.1f}" for speed in known)
        factors = ", ".join(_factor(experiment, wall, LIMIT_S * one) for one in known)
        lines.append(f"| {experiment} | {wall} | {steps / 1e6:.0f} | {times} | {factors} |")
    return lines


def _factor(experiment: str, wall: str, most: float) -> str:
    """Return the least coarse graining of the finest grains with so many particle-steps."""
    factor = 1.0
    with suppress(CaseError):  # no restitution, or no outlet, for grains so coarse
        while particle_steps(experiment, wall, replace(FINEST, coarse_graining=factor)) > most:
            factor += _STEP
        return f"{factor:.2f}"
    return "none"


def main() -> None:
    """Run what is missing and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rows", type=Path, default=ROWS)
    parser.add_argument("--engine", nargs="*", default=list(ENGINES), choices=ENGINES)
    parser.add_argument("--stored", action="store_true", help="run nothing")
    chosen = parser.parse_args()
    if not chosen.stored:
        run_all(chosen.rows, chosen.engine)
    rows = lab_rows(chosen.rows)
    print("\n".join([*table(rows), "", *finest(rows)]))


if __name__ == "__main__":
    main()
