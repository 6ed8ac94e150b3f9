"""Print the observables of the quick experiments over seeds, as the tables of docs/apparatus.md.

    python benchmarks/apparatus_table.py --seeds 4 --root .cases

Runs are case directories below the root; what is there is not run again.
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
ALUMINA = PUBLISHED | {"mu_pw": 0.375, "mu_roll_pw": 0.271, "e_pp": 0.776, "e_pw": 0.300}
LOW_PP = {"mu_pp": 0.1, "mu_roll_pp": 0.05}
LOW_PW = {"mu_pw": 0.1, "mu_roll_pw": 0.05}
CONFIGURATIONS = tuple(
    (experiment, surface, label, base | changes)
    for experiment, surface, label, base, changes in (
        ("heap", "glued", "published", PUBLISHED, {}),
        ("heap", "glued", "pp: mu .8 mu_roll .6", PUBLISHED, {"mu_pp": 0.8, "mu_roll_pp": 0.6}),
        ("heap", "glued", "pp: mu .8 mu_roll .05", PUBLISHED, {"mu_pp": 0.8, "mu_roll_pp": 0.05}),
        ("heap", "glued", "pp: mu .1 mu_roll .6", PUBLISHED, {"mu_pp": 0.1, "mu_roll_pp": 0.6}),
        ("heap", "glued", "pp: mu .1 mu_roll .05", PUBLISHED, LOW_PP),
        ("heap", "steel", "published", PUBLISHED, {}),
        ("heap", "alumina", "published", ALUMINA, {}),
        ("heap", "steel", "pw: mu .1 mu_roll .05", PUBLISHED, LOW_PW),
        ("heap", "steel", "pw: mu .2 mu_roll .1", PUBLISHED, {"mu_pw": 0.2, "mu_roll_pw": 0.1}),
        ("heap", "steel", "pw: mu .8 mu_roll .6", PUBLISHED, {"mu_pw": 0.8, "mu_roll_pw": 0.6}),
        ("conveyor", "glued", "published", PUBLISHED, {}),
        ("conveyor", "glued", "pp: mu .8 mu_roll .6", PUBLISHED, {"mu_pp": 0.8, "mu_roll_pp": 0.6}),
        ("conveyor", "glued", "pp: mu .1 mu_roll .05", PUBLISHED, LOW_PP),
        ("conveyor", "steel", "published", PUBLISHED, {}),
        ("conveyor", "alumina", "published", ALUMINA, {}),
        ("conveyor", "steel", "pw: mu .1 mu_roll .05", PUBLISHED, LOW_PW),
        ("conveyor", "steel", "pw: mu .8 mu_roll .6", PUBLISHED, {"mu_pw": 0.8, "mu_roll_pw": 0.6}),
        ("plate_impact", "steel", "published", PUBLISHED, {}),
        ("plate_impact", "alumina", "published", ALUMINA, {}),
        ("plate_impact", "steel", "e_pw .2", PUBLISHED, {"e_pw": 0.2}),
        ("plate_impact", "steel", "e_pw .6", PUBLISHED, {"e_pw": 0.6}),
        ("plate_impact", "steel", "e_pw .9", PUBLISHED, {"e_pw": 0.9}),
        ("plate_impact", "steel", "e_pp .3", PUBLISHED, {"e_pp": 0.3}),
        ("plate_impact", "steel", "e_pp .9", PUBLISHED, {"e_pp": 0.9}),
    )
)  # fmt: skip


def row(results: list[CaseResult]) -> str:
    """Return mean, standard deviation over seeds and wall time as cells of a table."""
    good = [one for one in results if one.status == "ok"]
    if not good:
        return f"failed: {results[0].reason} | - "
    cells = []
    for name in good[0].observables:
        values = np.array([one.observables[name] for one in good])
        spread = f" ({values.std(ddof=1):.2f})" if len(values) > 1 else ""
        cells.append(f"{name} {values.mean():.2f}{spread}")
    lost = f", {len(results) - len(good)} failed" if len(good) < len(results) else ""
    return f"{', '.join(cells)}{lost} | {np.mean([one.wall_s for one in good]):.1f}"


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--root", type=Path, default=Path(".cases"))
    parser.add_argument("--engine", default="minidem")
    parser.add_argument("--only", default="", help="experiment")
    parser.add_argument("--surface", default="", help="surface")
    chosen = parser.parse_args()
    print("| experiment | surface | parameters | mean (sd over seeds) | s per run |")
    print("|---|---|---|---|---|")
    for experiment, surface, label, parameters in CONFIGURATIONS:
        if chosen.only not in ("", experiment) or chosen.surface not in ("", surface):
            continue
        base = CaseSpec(experiment, GRAIN, surface, "quick", parameters)
        results = [
            execute(replace(base, seed=seed, engine=chosen.engine), chosen.root)
            for seed in range(1, chosen.seeds + 1)
        ]
        print(f"| {experiment} | {surface} | {label} | {row(results)} |", flush=True)


if __name__ == "__main__":
    main()
