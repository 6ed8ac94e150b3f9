"""Run every experiment with every particle at `quick` on both engines, and compare what they give.

    python -m benchmarks.engine.engines_agree --seeds 2           # rows, then the table
    python -m benchmarks.engine.engines_agree --seeds 2 --plan    # particle-steps, no run
    python -m benchmarks.engine.engines_agree --seeds 0           # the table of the stored rows

Rows go to tests/data/engines_agree.csv as runs end; what is there is not run again. Both engines
insert the same grains; contacts make the runs differ after a while, so that only statistics can
agree. Particles have their measured sizes (HSP13 one diameter as well) and the parameters published
for HSP13. A flat wall is steel; alumina is the same case with other numbers.
"""

from __future__ import annotations

import argparse
import csv
import os
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from calibrate.study.resources import bundled_particles
from liggghts_io import CaseSpec, Failure, Particle, execute, read_particles
from liggghts_io.case.spec import script_of
from liggghts_io.experiments import EXPERIMENTS
from liggghts_io.materials import FLAT, GLUED, ONE
from liggghts_io.measure.schedule import load_of

ROWS: Final = Path(__file__).resolve().parents[2] / "tests" / "data" / "engines_agree.csv"
PARTICLES: Final = read_particles(bundled_particles())
LARGEST: Final = PARTICLES["Carbo HSP13"]
ONE_SIZE: Final = "Carbo HSP13 of one size"
GRAINS: Final = {ONE_SIZE: replace(LARGEST, sizes=ONE), **PARTICLES}
"""What is simulated, by its name in tables."""
PARAMETERS: Final = {
    "mu_pp": 0.694, "mu_roll_pp": 0.0856, "mu_pw": 0.307, "mu_roll_pw": 0.274,
    "e_pp": 0.742, "e_pw": 0.439,
}  # fmt: skip
SURFACES: Final = {FLAT: "steel", GLUED: GLUED}
ENGINES: Final = ("minidem", "liggghts")
EVERYWHERE: Final = ("heap", "conveyor")
"""Experiments that the paper makes on both kinds of walls: every particle on both."""
FLAT_ONLY: Final = ("tilting_plate",)
"""Nothing slides on glued grains."""
OTHERS: Final = ("drum", "drawdown", "plate_impact", "funnel_flow")
"""On glued grains with the largest particle alone, whose runs are the cheapest."""
COLUMNS: Final = (
    "experiment", "wall", "particle", "engine", "seed", "observable", "value", "cpu_s",
)  # fmt: skip
RUN: Final = COLUMNS[:5]
SAME: Final = ["experiment", "wall", "observable"]
ROUNDED: Final = 1e-8
"""Relative difference of equal numbers: the rows hold ten digits, trajectories nine."""


@dataclass(frozen=True)
class Pair:
    """A case that both engines run.

    Attributes
    ----------
    experiment, wall : str
    grains : str
        Of `GRAINS`.
    """

    experiment: str
    wall: str
    grains: str

    @property
    def particle(self) -> Particle:
        """The bulk solid."""
        return GRAINS[self.grains]

    @property
    def apparatus(self) -> dict[str, float]:
        """What makes smaller grains cost no more than the largest: as many of them."""
        ratio = self.particle.d32_m / LARGEST.d32_m
        if ratio == 1.0:
            return {}
        poured = LARGEST.amount("impact_mass_kg") / self.particle.amount("impact_mass_kg")
        smaller = {
            "conveyor": {"length_fraction": 0.1 * ratio, "width_fraction": 0.12 * ratio},
            "plate_impact": {"mass_fraction": 0.2 * poured * ratio**3},
            # A bed of 2.3 outlets instead of 2.8 of a smaller funnel.
            "funnel_flow": {"outlet_m": 7.5e-3 * ratio, "mass_g": 10.0 * ratio**3},
        }
        return smaller.get(self.experiment, {})

    def spec(self, engine: str, seed: int) -> CaseSpec:
        """Return the case of an engine and a seed."""
        return CaseSpec(
            self.experiment, self.particle, SURFACES[self.wall], "quick", PARAMETERS,
            self.apparatus, seed=seed, engine=engine,
        )  # fmt: skip

    @property
    def particle_steps(self) -> float:
        """Return the most grains that there are times steps."""
        load = load_of(script_of(self.spec(ENGINES[0], 1)))
        return load.grains * load.steps


def pairs() -> Iterator[Pair]:
    """Yield all cases, experiment by experiment."""
    for experiment in (*FLAT_ONLY, *EVERYWHERE, *OTHERS):
        for wall in SURFACES:
            for grains in GRAINS:
                alone = experiment in OTHERS and grains != LARGEST.name
                if wall == GLUED and (experiment in FLAT_ONLY or alone):
                    continue
                yield Pair(experiment, wall, grains)


def spent_s() -> float:
    """Return the processor time of this process and of the engines it has run [s]."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def all_rows(rows: Path = ROWS) -> pd.DataFrame:
    """Return the rows of a file; without a value where a run came to none."""
    return pd.read_csv(rows, comment="#", dtype={"seed": int})


def stored(rows: Path = ROWS) -> pd.DataFrame:
    """Return the rows of a file that have a value."""
    return all_rows(rows).dropna(subset="value")


def run_all(rows: Path, seeds: int, only: list[str], grains: list[str]) -> None:
    """Make the runs that the file lacks, seed by seed, and add a row for each observable."""
    if not rows.exists():
        head = f"# python -m benchmarks.engine.engines_agree\n{','.join(COLUMNS)}\n"
        rows.write_text(head, encoding="utf-8")
    done = set(all_rows(rows)[list(RUN)].itertuples(index=False, name=None))
    for seed in range(1, seeds + 1):
        for pair in pairs():
            for engine in ENGINES:
                key = (pair.experiment, pair.wall, pair.grains, engine, seed)
                left_out = only and pair.experiment not in only
                if key in done or left_out or (grains and pair.grains not in grains):
                    continue
                start = spent_s()
                with tempfile.TemporaryDirectory() as root:
                    result = execute(pair.spec(engine, seed), Path(root))
                spent = f"{spent_s() - start:.1f}"
                if result.status == "ok":
                    found = {name: f"{one:.10g}" for name, one in result.observables.items()}
                elif result.failure == Failure.PHYSICS:  # such as a funnel that jams
                    found = dict.fromkeys((o.name for o in EXPERIMENTS[key[0]].observables), "")
                else:
                    msg = f"{key}: {result.reason}"
                    raise SystemExit(msg)
                with rows.open("a", encoding="utf-8", newline="") as file:
                    csv.writer(file, lineterminator="\n").writerows(
                        (*key, name, value, spent) for name, value in found.items()
                    )


def scatters(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the relative scatter over seeds of a run, and its degrees of freedom, for each row.

    Pooled over particles and engines, so that two seeds are enough for a standard error; over
    walls too where one of them has a single particle.
    """
    means = rows.groupby([*SAME, "particle", "engine"])["value"]
    wall = rows["wall"].where(rows["experiment"].isin(EVERYWHERE), "")
    pool = [rows["experiment"], rows["observable"], wall]
    squares = ((rows["value"] / means.transform("mean") - 1.0) ** 2).groupby(pool)
    free = (1.0 - 1.0 / means.transform("count")).groupby(pool).transform("sum")
    scatter = np.sqrt(squares.transform("sum") / free)
    return pd.DataFrame({"scatter": scatter, "freedom": free.round().astype(int)})


def compared(rows: pd.DataFrame) -> pd.DataFrame:
    """Return means of both engines for each case and observable, and their difference.

    Returns
    -------
    DataFrame
        Columns of `SAME`, particle, minidem, liggghts, `error` of the difference, `z`, the
        difference in such errors, zero where it is rounding, and those of `scatters`.
    """
    found = []
    with_scatter = rows.join(scatters(rows))
    for key, part in with_scatter.groupby([*SAME, "particle"], sort=False):
        values = {name: one["value"].to_numpy() for name, one in part.groupby("engine")}
        if len(values) < len(ENGINES):
            continue
        mini, ligg = (values[name] for name in ENGINES)
        mean = 0.5 * (mini.mean() + ligg.mean())
        scatter, freedom = part[["scatter", "freedom"]].iloc[0]
        error = scatter * abs(mean) * np.sqrt(1.0 / len(mini) + 1.0 / len(ligg))
        apart = mini.mean() - ligg.mean()
        z = 0.0 if abs(apart) <= ROUNDED * abs(mean) else apart / error
        found.append((*key, mini.mean(), ligg.mean(), error, z, scatter, freedom))
    columns = [*SAME, "particle", *ENGINES, "error", "z", "scatter", "freedom"]
    return pd.DataFrame(found, columns=columns)


def together(found: pd.DataFrame) -> pd.Series:
    """Return how far the engines are apart over all particles, in standard errors."""
    return found.groupby(SAME, sort=False)["z"].agg(lambda z: z.sum() / np.sqrt(len(z)))


def table(rows: pd.DataFrame) -> list[str]:
    """Return the lines of the table: one for each experiment, wall and observable."""
    found = compared(rows)
    everywhere = together(found)
    lines = [
        f"| experiment | wall | observable | sd | {' | '.join(GRAINS)} | all |",
        "|---|---|---|" + "---|" * (len(GRAINS) + 2),
    ]
    places = {place: k for k, place in enumerate((one.experiment, one.wall) for one in pairs())}
    groups = list(found.groupby(SAME, sort=False))
    for key, group in sorted(groups, key=lambda one: places[one[0][:2]]):
        cells = {
            one.particle: f"{one.minidem:.4g}, {one.liggghts:.4g} ({one.z:+.1f})"
            for one in group.itertuples()
        }
        lines.append(
            f"| {' | '.join(key)} | {group['scatter'].iloc[0]:.1%} "
            f"| {' | '.join(cells.get(name, '-') for name in GRAINS)} "
            f"| {everywhere[key]:+.1f} |"
        )
    return lines


def main() -> None:
    """Run what is missing and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--rows", type=Path, default=ROWS)
    parser.add_argument("--only", nargs="*", default=[], metavar="EXPERIMENT")
    parser.add_argument("--grains", nargs="*", default=[], choices=list(GRAINS), metavar="GRAINS")
    parser.add_argument("--plan", action="store_true", help="particle-steps instead of runs")
    chosen = parser.parse_args()
    if chosen.plan:
        for pair in pairs():
            print(f"{pair.experiment:14s}{pair.wall:7s}{pair.grains:24s}"
                  f"{pair.particle_steps / 1e6:7.0f}e6")  # fmt: skip
        total = sum(pair.particle_steps for pair in pairs()) * len(ENGINES) * chosen.seeds
        print(f"at most {total:.2g} particle-steps")
        return
    run_all(chosen.rows, chosen.seeds, chosen.only, chosen.grains)
    print("\n".join(table(stored(chosen.rows))))


if __name__ == "__main__":
    main()
