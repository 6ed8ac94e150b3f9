"""What coarse grains change in every observable (section 3.4 of Grobbel et al. 2019).

    python -m benchmarks.grains.coarse_graining --seeds 3

Carbo HSP13 at the published parameters with 1.595, 2, 2.5 and 3 mm, scale lab (the heap: quick,
eight diameters wide), with the rule for restitution between grains and without it. `--plan` says
particle-steps only. Rows are added to coarse_graining.csv here as they come; figure and table are
made of what is there. The heap, whose angle scatters most, has twice as many seeds.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

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
from liggghts_io.sizes import coarse_restitution

ROWS = Path(__file__).with_suffix(".csv")
FIGURE = Path(__file__).resolve().parents[2] / "docs" / "images" / "coarse_graining.png"
DIAMETERS_MM = (1.595, 2.0, 2.5, 3.0)
FACTORS = tuple(round(d / DIAMETERS_MM[0], 3) for d in DIAMETERS_MM)
WIDE = "quick, 8 d"
WIDE_SLICE = {"slice_width_d": 8.0, "pour_grains": 2133.0}
"""Heap of `quick` in a slice as wide as at `lab`: coarse grains need more than three diameters."""
KEPT = "e kept"
REAL = f"{FACTORS[0]:g}"
SHOWN = {"angle_deg": "angle (deg)", "t100_s": "t100 (s)"}


def _run(experiment: str, surface: str, factor: float) -> Run:
    wide = experiment == "heap"
    return Run(
        experiment, surface, WIDE if wide else "lab", f"{factor:g}",
        replace(GRAIN, coarse_graining=factor), PUBLISHED, 1, WIDE_SLICE if wide else {},
    )  # fmt: skip


def runs() -> list[Run]:
    """Return one run of every place, factor and treatment of restitution, cheap ones first."""
    found = []
    for factor in reversed(FACTORS):
        found += [_run(*place, factor) for place in PLACES]
        if factor > 1.0:
            # The rule undone: real grains' restitution that becomes the published one by it.
            loss = (1.0 - PUBLISHED["e_pp"] ** 2) / factor
            kept = PUBLISHED | {"e_pp": (1.0 - loss) ** 0.5}
            last = found[-1]
            found.append(replace(last, grains=f"{last.grains}, {KEPT}", parameters=kept))
    return found


def repeated(seeds: int) -> list[Run]:
    """Return the runs with every seed, twice as many of the heap."""
    heaps = [run for run in runs() if run.experiment == "heap"]
    others = [run for run in runs() if run.experiment != "heap"]
    return [*with_seeds(others, seeds), *with_seeds(heaps, 2 * seeds)]


def plan(seeds: int) -> None:
    """Print how many particle-steps the runs are."""
    for run in runs():
        steps = run.particle_steps
        print(f"{run.experiment} on {run.surface}, {run.grains}: {steps / 1e6:.0f} M")
    total = sum(run.particle_steps for run in repeated(seeds))
    print(f"{total / 1e9:.1f} G particle-steps in all")


def cells(by: dict[str, np.ndarray], grains: str) -> str:
    """Return mean and standard error with one kind of grains, and the bias against real ones."""
    if grains not in by:
        return "-"
    values, real = by[grains], by[REAL]
    error = standard_error(values)
    shown = f"{values.mean():.2f} ± {error:.2f}" if len(values) > 1 else f"{values[0]:.2f}, one run"
    if grains == REAL:
        return shown
    bias = values.mean() - real.mean()
    return f"{shown} ({100.0 * bias / real.mean():+.0f} %)"


def table() -> list[str]:
    """Return the rows of the table."""
    rows = stored(ROWS)
    heads = [f"CG {factor:g} ({d:g} mm)" for factor, d in zip(FACTORS, DIAMETERS_MM, strict=True)]
    lines = [f"| experiment | surface | observable | {' | '.join(heads)} |", "|---" * 7 + "|"]
    spent = seconds(rows)
    for (*place, name), by in sorted(groups(rows).items()):
        if REAL not in by or np.isnan(by[REAL]).any():
            continue
        values = " | ".join(cells(by, f"{factor:g}") for factor in FACTORS)
        lines.append(f"| {place[0]} | {place[1]} | {name} | {values} |")
        if any(KEPT in grains for grains in by):
            values = " | ".join(cells(by, f"{factor:g}, {KEPT}") for factor in FACTORS[1:])
            lines.append(f"| | | {name}, e_pp kept | | {values} |")
    for place in PLACES:
        cost = [spent.get(_run(*place, factor).key[:-1]) for factor in FACTORS]
        shown = " | ".join("-" if one is None else f"{one:.0f} s" for one in cost)
        lines.append(f"| {place[0]} | {place[1]} | processor time of a run | {shown} |")
    rule = " | ".join(f"{coarse_restitution(PUBLISHED['e_pp'], f):.3f}" for f in FACTORS)
    lines.append(f"| all | | e_pp* | {rule} |")
    return lines


def draw() -> None:
    """Draw every observable over the factor, as a part of its value with real grains."""
    found = {key: by for key, by in groups(stored(ROWS)).items() if REAL in by}
    panels = ("heap", "conveyor", "plate_impact")
    titles = ("angle of repose", "conveyor time for 100 g", "masses in and beside the boxes")
    with mpl.rc_context({"font.size": 9}):
        figure = Figure(figsize=(11.0, 3.6), layout="constrained")
        for axes, panel, title in zip(figure.subplots(1, 3), panels, titles, strict=True):
            for (experiment, surface, _, name), by in sorted(found.items()):
                if experiment != panel or np.isnan(by[REAL]).any():
                    continue
                label = surface if name in SHOWN else name.removesuffix("_g")
                line = _line(axes, by, "", label)
                if any(KEPT in grains for grains in by):
                    _line(axes, by, f", {KEPT}", "", color=line, linestyle=":")
            axes.axhline(1.0, color="0.7", linewidth=0.8)
            axes.set(xlabel="coarse-graining factor", title=title)
            axes.legend(fontsize=8)
            axes.set_ylabel("value over that with real grains")
        figure.savefig(FIGURE, dpi=150)


def _line(axes: object, by: dict, suffix: str, label: str, **style: object) -> str:
    """Draw one observable with its standard errors; return the colour."""
    factors = [f for f in FACTORS if f"{f:g}{suffix if f > 1.0 else ''}" in by]
    values = [by[f"{f:g}{suffix if f > 1.0 else ''}"] for f in factors]
    real = by[REAL].mean()
    mean = [one.mean() / real for one in values]
    error = [standard_error(one) / real for one in values]
    drawn = axes.errorbar(factors, mean, error, marker="o", capsize=2, label=label, **style)
    return drawn.lines[0].get_color()


def main() -> None:
    """Run, print, draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--root", type=Path, default=Path(".cases"))
    parser.add_argument("--plan", action="store_true")
    chosen = parser.parse_args()
    if chosen.plan:
        plan(chosen.seeds)
        return
    command = f"python -m benchmarks.grains.coarse_graining --seeds {chosen.seeds}"
    make(repeated(chosen.seeds), ROWS, chosen.root, command)
    print("\n".join(table()))
    draw()


if __name__ == "__main__":
    main()
