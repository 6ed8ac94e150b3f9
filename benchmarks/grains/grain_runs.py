"""Runs of Carbo HSP13 with grains simulated in several ways; rows are stored as they come."""

from __future__ import annotations

import csv
import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from calibrate.study.resources import bundled_particles
from liggghts_io import CaseSpec, Particle, execute, particle_named
from liggghts_io.case.spec import script_of
from liggghts_io.materials import ONE
from liggghts_io.measure.schedule import load_of

GRAIN = replace(particle_named("Carbo HSP13", bundled_particles()), sizes=ONE)
PUBLISHED = {
    "mu_pp": 0.694, "mu_roll_pp": 0.0856, "mu_pw": 0.307, "mu_roll_pw": 0.274,
    "e_pp": 0.742, "e_pw": 0.439,
}  # fmt: skip
PLACES = (
    ("heap", "glued"), ("heap", "steel"), ("conveyor", "glued"), ("conveyor", "steel"),
    ("plate_impact", "steel"),
)  # fmt: skip
HEAD = ("experiment", "surface", "scale", "grains", "seed", "observable", "value", "cpu_s")


@dataclass(frozen=True)
class Run:
    """One run to be made.

    Attributes
    ----------
    experiment, surface, scale : str
    grains : str
        What the grains are called in tables.
    particle : Particle
    parameters : dict of str to float
    seed : int
    apparatus : dict of str to float
        Overrides; the scale's name in tables says that there are some.
    """

    experiment: str
    surface: str
    scale: str
    grains: str
    particle: Particle
    parameters: dict[str, float]
    seed: int
    apparatus: dict[str, float] = field(default_factory=dict)

    @property
    def key(self) -> tuple[str, ...]:
        """What tells it from others in a table."""
        return (self.experiment, self.surface, self.scale, self.grains, str(self.seed))

    @property
    def spec(self) -> CaseSpec:
        """The case."""
        return CaseSpec(
            self.experiment, self.particle, self.surface, self.scale.partition(",")[0],
            self.parameters, self.apparatus, seed=self.seed,
        )  # fmt: skip

    @property
    def particle_steps(self) -> float:
        """Return grains times steps; half of the grains are there on average."""
        load = load_of(script_of(self.spec))
        return 0.5 * load.steps * load.grains


def stored(rows: Path) -> list[dict[str, str]]:
    """Return the rows of a file, none where there is no file."""
    if not rows.exists():
        return []
    with rows.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def make(runs: Iterable[Run], rows: Path, root: Path, command: str) -> None:
    """Make the runs that a file lacks, and add a row for each observable."""
    done = {tuple(row[name] for name in HEAD[:5]) for row in stored(rows)}
    if not rows.exists():
        rows.write_text(f"# {command}\n{','.join(HEAD)}\n", encoding="utf-8")
    for run in runs:
        if run.key in done:
            continue
        start = time.process_time()
        result = execute(run.spec, root)
        spent = time.process_time() - start
        found = dict(result.observables) if result.status == "ok" else {"failed": float("nan")}
        with rows.open("a", encoding="utf-8", newline="") as file:
            for name, value in found.items():
                csv.writer(file).writerow((*run.key, name, f"{value:.6g}", f"{spent:.2f}"))


def groups(rows: Iterable[dict[str, str]]) -> dict[tuple[str, ...], dict[str, np.ndarray]]:
    """Return values over seeds, by experiment, surface, scale and observable, then by grains."""
    found: dict[tuple[str, ...], dict[str, list[float]]] = {}
    for row in rows:
        key = (row["experiment"], row["surface"], row["scale"], row["observable"])
        found.setdefault(key, {}).setdefault(row["grains"], []).append(float(row["value"]))
    return {
        key: {name: np.array(values) for name, values in by.items()} for key, by in found.items()
    }


def seconds(rows: Iterable[dict[str, str]]) -> dict[tuple[str, ...], float]:
    """Return the mean processor time of a run by experiment, surface, scale and grains [s]."""
    spent: dict[tuple[str, ...], dict[str, float]] = {}
    for row in rows:
        key = (row["experiment"], row["surface"], row["scale"], row["grains"])
        spent.setdefault(key, {})[row["seed"]] = float(row["cpu_s"])
    return {key: float(np.mean(list(one.values()))) for key, one in spent.items()}


def standard_error(values: np.ndarray) -> float:
    """Return the standard error of the mean over seeds."""
    return float(values.std(ddof=1) / np.sqrt(len(values))) if len(values) > 1 else float("nan")


def with_seeds(runs: Iterable[Run], seeds: int) -> Iterator[Run]:
    """Repeat runs with every seed; all of one seed before the next."""
    base = list(runs)
    for seed in range(1, seeds + 1):
        for run in base:
            yield replace(run, seed=seed)
