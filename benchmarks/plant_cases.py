"""Make the planted data of the example studies in `cases/`: runs at known parameters, plus noise.

`python benchmarks/plant_cases.py [drum|drawdown|plain_script]` writes `measured.csv`, and a file
for each curve, beside the study; the truth stands in `truth.toml`.
"""

from __future__ import annotations

import sys
import tempfile
import tomllib
from pathlib import Path

import numpy as np

from liggghts_io import CaseSpec, OwnExperiment, execute, experiment_of, read_curve, read_experiment
from liggghts_io.bulk import Bulk

CASES = Path(__file__).resolve().parents[1] / "cases"
EXPERIMENTS = {"drum": "drum", "drawdown": "drawdown", "plain_script": "hopper"}
"""The experiment of each example: one of the program, or a folder beside the study."""
REPEATS = 5
SEED = 700_000
"""Seeds of the data, far from those of a calibration."""


def plant(name: str, runs: Path) -> None:
    """Write the data of one example."""
    place = CASES / name
    truth = tomllib.loads((place / "truth.toml").read_text(encoding="utf-8"))
    experiment = EXPERIMENTS[name]
    folder = place / experiment
    own: OwnExperiment | None = read_experiment(folder) if folder.is_dir() else None
    grain = Bulk(**truth["material"]).particle
    specs = [
        CaseSpec(experiment, grain, "flat", "quick", truth["parameters"], seed=SEED + k, own=own)
        for k in range(REPEATS)
    ]
    results = [execute(spec, runs) for spec in specs]
    failed = [one.reason for one in results if one.status != "ok"]
    if failed:
        msg = f"{name}: {failed[0]}"
        raise SystemExit(msg)
    rng = np.random.default_rng(truth["noise_seed"])
    note = f"# Planted: {REPEATS} runs of {experiment} with noise; the truth is in truth.toml.\n"
    names = list(truth["noise"])
    rows = [
        [result.observables[one] + truth["noise"][one] * rng.standard_normal() for one in names]
        for result in results
    ]
    table = "\n".join(",".join(f"{value:.4g}" for value in row) for row in rows)
    (place / "measured.csv").write_text(f"{note}{','.join(names)}\n{table}\n", encoding="utf-8")
    for curve in experiment_of(specs[0]).curves:
        values = np.array([read_curve(result, curve) for result in results])
        values *= 1.0 + truth["curve_noise"] * rng.standard_normal(values.shape)
        level_name = "level" if curve.x_unit == "-" else f"level_{curve.x_unit}"
        head = ",".join([level_name, *(f"run{k + 1}_{curve.unit}" for k in range(REPEATS))])
        lines = [
            ",".join(f"{v:.4g}" for v in (level, *column))
            for level, column in zip(curve.levels, values.T, strict=True)
        ]
        text = "\n".join([head, *lines])
        (place / f"{curve.name}.csv").write_text(f"{note}{text}\n", encoding="utf-8")


def main() -> None:
    """Plant the data of the examples that are named, or of all."""
    with tempfile.TemporaryDirectory() as runs:
        for name in sys.argv[1:] or EXPERIMENTS:
            plant(name, Path(runs))
            print(f"wrote {CASES / name}")


if __name__ == "__main__":
    main()
