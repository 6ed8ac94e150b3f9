"""Run the funnel with several outlets and particles and store the flows.

    python benchmarks/funnel_outlets.py --root .cases

writes tests/data/funnel_outlets.csv and prints it beside Beverloo's law and the measured flows of
the paper (Table B.9). Beds of all outlets are alike: their mass grows with the cube of the outlet.
What is there is not run again.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

from calibrate.study.resources import bundled_particles
from liggghts_io import CaseSpec, Particle, execute, read_particles
from liggghts_io.files import write_text
from liggghts_io.materials import ONE

TARGET = Path(__file__).resolve().parents[1] / "tests" / "data" / "funnel_outlets.csv"
PARTICLES = read_particles(bundled_particles())
PUBLISHED = {
    "mu_pp": 0.694, "mu_roll_pp": 0.0856, "mu_pw": 0.307, "mu_roll_pw": 0.274,
    "e_pp": 0.742, "e_pw": 0.439,
}  # fmt: skip
NOMINAL = 7.5e-3
OUTLETS = (NOMINAL, 9e-3, 11e-3)
SEEDS = (1, 2)
BULK = 0.58
"""Solid fraction in Beverloo's law."""


def beverloo(outlet: float, grain: Particle) -> float:
    """Return the flow of a flat bottom [g/s], C = 0.58, k = 1.4 (Chem. Eng. Sci. 15 (1961) 260)."""
    narrower = outlet - 1.4 * grain.d32_m
    return float(1e3 * 0.58 * BULK * grain.density * 9.81**0.5 * narrower**2.5)


def main() -> None:
    """Run what is missing below the root, write the table and print it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--root", type=Path, default=Path(".cases"))
    parser.add_argument("--particles", nargs="*", default=["SG10H"])
    chosen = parser.parse_args()
    cases = [("Carbo HSP13", outlet) for outlet in OUTLETS]
    cases += [(name, NOMINAL) for name in chosen.particles]
    rows = ["# python benchmarks/funnel_outlets.py", "particle,outlet_m,seed,flow_g_s,beverloo_g_s"]
    for name, outlet in cases:
        for seed in SEEDS:
            apparatus = {"outlet_m": outlet, "mass_g": 15.0 * (outlet / NOMINAL) ** 3}
            grain = replace(PARTICLES[name], sizes=ONE)
            spec = CaseSpec("funnel_flow", grain, "steel", "quick", PUBLISHED, apparatus, seed=seed)
            result = execute(spec, chosen.root)
            flow = result.observables.get("flow_g_s", float("nan"))
            rows.append(f"{name},{outlet:g},{seed},{flow:.6g},{beverloo(outlet, grain):.4g}")
            print(rows[-1], f"{result.wall_s:.0f} s", result.reason, flush=True)
    write_text(TARGET, "\n".join(rows) + "\n")


if __name__ == "__main__":
    main()
