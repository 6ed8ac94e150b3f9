"""Print what the effects that only minidem has do to the observables and to the time of a run.

    python benchmarks/engine/extension_effects.py --seeds 2 --root .cases

Runs are case directories below the root; what is there is not run again, its time is kept.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

import numpy as np

from calibrate.study.resources import bundled_particles
from liggghts_io import CaseResult, CaseSpec, execute, particle_named
from liggghts_io.materials import ONE

GRAIN = replace(particle_named("Carbo HSP13", bundled_particles()), sizes=ONE)
PUBLISHED = {
    "mu_pp": 0.694, "mu_roll_pp": 0.0856, "mu_pw": 0.307, "mu_roll_pw": 0.274,
    "e_pp": 0.742, "e_pw": 0.439,
}  # fmt: skip
VARIANTS: tuple[dict[str, float], ...] = (
    {}, {"air_drag": 1.0}, {"restitution_scatter": 0.2}, {"restitution_slope": 0.25},
    {"static_friction_ratio": 0.2},
)  # fmt: skip
PLACES = (("heap", "glued"), ("conveyor", "steel"), ("plate_impact", "steel"))


def row(results: list[CaseResult]) -> str:
    """Return mean and standard deviation of every observable, and the mean time of a run."""
    failed = [one.reason for one in results if one.status != "ok"]
    if failed:
        return f"failed: {failed[0]} | - "
    cells = []
    for name in results[0].observables:
        values = np.array([one.observables[name] for one in results])
        cells.append(f"{name} {values.mean():.2f} ({values.std(ddof=1):.2f})")
    return f"{', '.join(cells)} | {np.mean([one.wall_s for one in results]):.1f}"


def main() -> None:
    """Run what is missing and print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--seeds", type=int, default=2, help="seeds 1 to this")
    parser.add_argument("--root", type=Path, default=Path(".cases"), help="case directories")
    chosen = parser.parse_args()
    print("| experiment | surface | effect | mean (standard deviation) | s a run |")
    print("|---|---|---|---|---|")
    for experiment, surface in PLACES:
        for effects in VARIANTS:
            results = [
                execute(
                    CaseSpec(
                        experiment, GRAIN, surface, "quick", PUBLISHED, effects=effects,
                        seed=seed,
                    ),
                    chosen.root,
                )
                for seed in range(1, chosen.seeds + 1)
            ]  # fmt: skip
            label = ", ".join(f"{name} {value:g}" for name, value in effects.items()) or "none"
            print(f"| {experiment} | {surface} | {label} | {row(results)} |", flush=True)


if __name__ == "__main__":
    main()
