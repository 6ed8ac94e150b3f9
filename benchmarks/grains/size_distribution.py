"""What the measured sizes change in every observable, and what they cost.

    python -m benchmarks.grains.size_distribution --seeds 8

Carbo HSP13 at the published parameters, scale quick: all grains of Sauter diameter, then the
measured sizes. Rows are added to size_distribution.csv here; what is there is not run
again.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

from benchmarks.grains.grain_runs import (
    GRAIN,
    PLACES,
    PUBLISHED,
    Run,
    groups,
    make,
    seconds,
    standard_error,
    stored,
    with_seeds,
)  # fmt: skip
from calibrate.study.resources import bundled_particles
from liggghts_io import read_particles
from liggghts_io.materials import MEASURED, ONE, SIZES
from liggghts_io.sizes import simulated_sizes

ROWS = Path(__file__).with_suffix(".csv")


def runs() -> list[Run]:
    """Return one run of every place with either sizes."""
    return [
        Run(*place, "quick", sizes, replace(GRAIN, sizes=sizes), PUBLISHED, 1)
        for place in PLACES
        for sizes in SIZES
    ]


def classes() -> list[str]:
    """Return the rows of the table of classes."""
    lines = ["| particle | classes (um) | d32 (um) | time step | grains |", "|---|---|---|---|---|"]
    for name, one in read_particles(bundled_particles()).items():
        sizes = simulated_sizes(replace(one, sizes=MEASURED))
        shown = ", ".join(f"{d * 1e6:.0f}" for d, _ in sizes)
        number = sum(mass * (one.d32_m / d) ** 3 for d, mass in sizes)
        step = sizes[0][0] / one.d32_m
        lines.append(f"| {name} | {shown} | {one.d32_m * 1e6:.0f} | {step:.2f} | {number:.2f} |")
    return lines


def table() -> list[str]:
    """Return the rows of the table of differences."""
    rows = stored(ROWS)
    spent = seconds(rows)
    lines = [
        "| experiment | surface | observable | one diameter | measured sizes | difference | "
        "in standard errors | cost |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for (*place, name), by in groups(rows).items():
        one, many = by[ONE], by[MEASURED]
        errors = [standard_error(values) for values in (one, many)]
        error = (errors[0] ** 2 + errors[1] ** 2) ** 0.5
        change = many.mean() - one.mean()
        cost = spent[(*place, MEASURED)] / spent[(*place, ONE)]
        lines.append(
            f"| {place[0]} | {place[1]} | {name} | {one.mean():.2f} ± {errors[0]:.2f} | "
            f"{many.mean():.2f} ± {errors[1]:.2f} | {change:+.2f} ± {error:.2f} | "
            f"{change / error:+.1f} | {cost:.2f} |"
        )
    return lines


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--root", type=Path, default=Path(".cases"))
    chosen = parser.parse_args()
    command = f"python -m benchmarks.grains.size_distribution --seeds {chosen.seeds}"
    make(with_seeds(runs(), chosen.seeds), ROWS, chosen.root, command)
    print("\n".join([*classes(), "", *table()]))


if __name__ == "__main__":
    main()
