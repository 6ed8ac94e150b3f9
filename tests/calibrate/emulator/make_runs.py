"""Record the engine runs behind the tests of the emulator.

    python tests/calibrate/emulator/make_runs.py RUNS_DIR [--points 256] [--effects 48]

Quick runs of HSP13 at Sobol points over the whole ranges, in five places; every eighth point has a
second seed, and at the first points each effect is switched on alone, with the point's seed. Runs
that RUNS_DIR/*.jsonl holds are not made again (a run takes one to five seconds). Writes points.csv
and a table per experiment into tests/data/emulator; strengths are in units of the effect's ordinary
strength.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from scipy.stats import qmc

sys.path.insert(0, str(Path(__file__).resolve().parents[3]))
from calibrate.study.resources import bundled_particles
from liggghts_io import CaseSpec, execute, particle_named
from liggghts_io.effects import EFFECTS
from tests.calibrate.emulator.recorded import FOLDER, RANGES

PLACES = (
    ("heap", "steel"),
    ("heap", "glued"),
    ("conveyor", "steel"),
    ("conveyor", "glued"),
    ("plate_impact", "steel"),
)
DESIGN_SEED = 20261121
MOST_POINTS = 256
REPEATED = 8  # every so many points have a second seed
SECOND_SEED = 5001  # of point 0
LEVELS_G = range(10, 101, 10)
STRENGTHS = (0.5, 3.0)  # ordinary strengths


def parameters(u: np.ndarray) -> dict[str, float]:
    """Return contact parameters of a point; friction is spaced by its logarithm."""
    found: dict[str, float] = {}
    for (name, (low, high)), x in zip(RANGES.items(), u, strict=True):
        value = low * (high / low) ** x if name.startswith("mu") else low + (high - low) * x
        found[name] = float(f"{value:.8g}")
    return found


def plan(points: int, effects: int) -> Iterator[dict[str, Any]]:
    """Yield every run: key, place, point, seed, effect and strength."""
    for experiment, surface in PLACES:
        for i in range(points):
            for seed in (1 + i,) if i % REPEATED else (1 + i, SECOND_SEED + i):
                key = f"{experiment}/{surface}/{i}/{seed}"
                yield {"key": key, "experiment": experiment, "surface": surface, "point": i,
                       "seed": seed, "effects": {}}  # fmt: skip
    for i in range(effects):
        for n, effect in enumerate(EFFECTS.values()):
            rng = np.random.default_rng([i, n])
            size = effect.scale * rng.uniform(*STRENGTHS)
            sign = 1.0 if effect.low >= 0 or rng.random() < 0.5 else -1.0
            strength = float(np.clip(round(sign * size, 8), effect.low, effect.high))
            for experiment, surface in PLACES:
                if effect.acts_in(experiment):
                    key = f"{experiment}/{surface}/{i}/{effect.name}"
                    yield {"key": key, "experiment": experiment, "surface": surface, "point": i,
                           "seed": 1 + i, "effects": {effect.name: strength}}  # fmt: skip


def run(job: Mapping[str, Any], root: Path) -> dict[str, Any]:
    """Make one run and return its record."""
    u = qmc.Sobol(len(RANGES), seed=DESIGN_SEED).random(MOST_POINTS)
    spec = CaseSpec(
        experiment=job["experiment"],
        particle=particle_named("Carbo HSP13", bundled_particles()),
        surface=job["surface"],
        scale="quick",
        parameters=parameters(u[job["point"]]),
        seed=job["seed"],
        effects=job["effects"],
    )
    result = execute(spec, root)
    curve: list[float | None] = []
    if spec.experiment == "conveyor" and result.status == "ok":
        table = pd.read_csv(result.path / "mass_time.csv")
        mass, time = table["mass_g"].to_numpy(), table["time_s"].to_numpy()
        for level in LEVELS_G:
            k = int(np.argmax(mass >= level))
            reached = k > 0
            curve.append(float(np.interp(level, mass[k - 1 : k + 1], time[k - 1 : k + 1]))
                         if reached else None)  # fmt: skip
    return {**job, "status": result.status, "observables": dict(result.observables), "curve": curve}


def rows(records: Mapping[str, Mapping[str, Any]], experiment: str) -> Iterator[dict[str, Any]]:
    """Yield the rows of an experiment's table in the order of the plan."""
    for one in records.values():
        if one["experiment"] != experiment or one["status"] != "ok":
            continue
        effect, strength = next(iter(one.get("effects", {}).items()), ("", 0.0))
        scale = EFFECTS[effect].scale if effect else 1.0
        values = dict(one["observables"])
        values.pop("beside_g", None)
        if experiment == "conveyor":
            times = zip(LEVELS_G, one["curve"], strict=True)
            values = {f"t{m}_s": np.nan if t is None else t for m, t in times}
        yield {
            "surface": one["surface"],
            "point": one["point"],
            "seed": one["seed"],
            "effect": effect,
            "strength": round(strength / scale, 4),
            **{name: round(value, 4) for name, value in values.items()},
        }


def write(records: Mapping[str, Mapping[str, Any]]) -> None:
    """Write the tables."""
    head = "# python tests/calibrate/emulator/make_runs.py RUNS_DIR\n"
    u = qmc.Sobol(len(RANGES), seed=DESIGN_SEED).random(MOST_POINTS)
    last = max(one["point"] for one in records.values()) + 1
    points = pd.DataFrame(u[:last], columns=pd.Index(list(RANGES))).round(6)
    points.insert(0, "point", range(last))
    tables = {"points": points}
    for experiment in dict(PLACES):
        tables[experiment] = pd.DataFrame(rows(records, experiment))
    for name, table in tables.items():
        with (FOLDER / f"{name}.csv").open("w", encoding="utf-8") as file:
            file.write(head)
            table.to_csv(file, index=False)


def main() -> None:
    """Run what is missing and write the tables."""
    parser = argparse.ArgumentParser()
    parser.add_argument("runs", type=Path)
    parser.add_argument("--points", type=int, default=MOST_POINTS)
    parser.add_argument("--effects", type=int, default=48)
    asked = parser.parse_args()
    known: dict[str, Any] = {}
    for path in sorted(asked.runs.glob("*.jsonl")):
        known |= {one["key"]: one for one in map(json.loads, path.read_text().splitlines())}
    jobs = {one["key"]: one for one in plan(asked.points, asked.effects)}
    missing = [one for key, one in jobs.items() if key not in known]
    print(f"{len(missing)} runs are missing", flush=True)
    asked.runs.mkdir(parents=True, exist_ok=True)
    with ProcessPoolExecutor(2) as pool, (asked.runs / "new.jsonl").open("a") as file:
        tasks = [pool.submit(run, one, asked.runs / "cases") for one in missing]
        for task in tasks:
            known[task.result()["key"]] = task.result()
            file.write(json.dumps(task.result()) + "\n")
            file.flush()
    every = {one["key"]: one for one in plan(MOST_POINTS, MOST_POINTS)}
    write({key: known[key] for key in every if key in known})


if __name__ == "__main__":
    main()
