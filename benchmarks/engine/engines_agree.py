"""Run the quick experiments over seeds on both engines and store what they measured.

    python benchmarks/engine/engines_agree.py --seeds 6 --root .cases

writes tests/data/engines_agree.csv, one row for each experiment, surface, engine, seed and
observable. A test compares the means of the two engines within three standard errors and runs one
of the cases again. Both engines insert the same grains; contacts make the runs differ after a
while, so that only statistics can agree.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from calibrate.study.resources import bundled_particles
from liggghts_io import CaseSpec, execute, particle_named
from liggghts_io.files import write_text

TARGET = Path(__file__).resolve().parents[2] / "tests" / "data" / "engines_agree.csv"
GRAIN = particle_named("Carbo HSP13", bundled_particles())
PARAMETERS = {
    "mu_pp": 0.694, "mu_roll_pp": 0.0856, "mu_pw": 0.307, "mu_roll_pw": 0.274,
    "e_pp": 0.742, "e_pw": 0.439,
}  # fmt: skip
CASES = (
    ("heap", "steel"), ("heap", "glued"), ("conveyor", "steel"), ("conveyor", "glued"),
    ("plate_impact", "steel"),
)  # fmt: skip


def spec_of(experiment: str, surface: str, engine: str, seed: int) -> CaseSpec:
    """Return one of the compared cases."""
    return CaseSpec(experiment, GRAIN, surface, "quick", PARAMETERS, seed=seed, engine=engine)


def main() -> None:
    """Run what is missing below the root and write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=6)
    parser.add_argument("--root", type=Path, default=Path(".cases"))
    chosen = parser.parse_args()
    rows = [f"# python benchmarks/engine/engines_agree.py --seeds {chosen.seeds}",
            "experiment,surface,engine,seed,observable,value"]  # fmt: skip
    for experiment, surface in CASES:
        for engine in ("minidem", "liggghts"):
            for seed in range(1, chosen.seeds + 1):
                result = execute(spec_of(experiment, surface, engine, seed), chosen.root)
                print(experiment, surface, engine, seed, result.status, dict(result.observables),
                      f"{result.wall_s:.1f} s", flush=True)  # fmt: skip
                rows.extend(
                    f"{experiment},{surface},{engine},{seed},{name},{value:.10g}"
                    for name, value in result.observables.items()
                )
    write_text(TARGET, "\n".join(rows) + "\n")


if __name__ == "__main__":
    main()
