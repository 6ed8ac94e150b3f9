"""What coarse grains change for Carbo HSP30/60 on the conveyor, as cases/proppants has it.

    python -m benchmarks.grains.coarse_finest --seeds 3

Real sizes beside grains 1.37 times as large, at the parameters published for HSP30/60 and the scale
and slice of the study of five proppants. Rows are added to coarse_finest.csv here as they come.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

from benchmarks.grains.grain_runs import (
    Run,
    groups,
    make,
    seconds,
    standard_error,
    stored,
    with_seeds,
)
from calibrate.study.resources import bundled_particles
from liggghts_io import particle_named

ROWS = Path(__file__).with_suffix(".csv")
GRAIN = particle_named("Carbo HSP30/60", bundled_particles())
PUBLISHED = {
    "mu_pp": 0.717, "mu_roll_pp": 0.130, "mu_pw": 0.304, "mu_roll_pw": 0.5,
    "e_pp": 0.821, "e_pw": 0.443,
}  # fmt: skip
FACTORS = (1.37, 1.0)
SLICE = {"width_fraction": 0.0621}


def runs() -> list[Run]:
    """Return a run of each factor and wall, the cheap ones first."""
    return [
        Run(
            "conveyor", surface, "quick", f"{factor:g}",
            replace(GRAIN, coarse_graining=factor), PUBLISHED, 1, SLICE,
        )
        for factor in FACTORS
        for surface in ("steel", "glued")
    ]  # fmt: skip


def table() -> list[str]:
    """Return the rows of the table."""
    rows = stored(ROWS)
    spent = seconds(rows)
    lines = ["| wall | factor | t100 (s) | bias | time of a run (s) |", "|---" * 5 + "|"]
    for (experiment, wall, scale, name), by in sorted(groups(rows).items()):
        if name != "t100_s" or "1" not in by:
            continue
        real = by["1"].mean()
        for grains, values in sorted(by.items()):
            error = standard_error(values)
            both = (error**2 + standard_error(by["1"]) ** 2) ** 0.5
            bias = f"{100.0 * (values.mean() / real - 1.0):+.1f} ± {100.0 * both / real:.1f} %"
            cost = spent[experiment, wall, scale, grains]
            shown = "" if grains == "1" else bias
            lines.append(
                f"| {wall} | {grains} | {values.mean():.2f} ± {error:.2f} | {shown} | {cost:.0f} |"
            )
    return lines


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--root", type=Path, default=Path(".cases"))
    chosen = parser.parse_args()
    command = f"python -m benchmarks.grains.coarse_finest --seeds {chosen.seeds}"
    make(with_seeds(runs(), chosen.seeds), ROWS, chosen.root, command)
    print("\n".join(table()))


if __name__ == "__main__":
    main()
