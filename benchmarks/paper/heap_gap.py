"""What could lift the heap of the published parameters to the measured angle, one thing at a time.

    python -m benchmarks.paper.heap_gap --seeds 2        # runs what is missing and prints the table
    python -m benchmarks.paper.heap_gap --seeds 0        # the table alone

A free cone of Carbo HSP13 on the glued plate and on steel with the parameters of Table B.7, as at
scale `paper`; each row changes one thing about the apparatus, the grains or the contact law.
Rows go to `benchmarks/paper/results/heap_gap.csv` as runs end; what is there is not run again. The
table is put into docs/diagnosis.md.
"""

from __future__ import annotations

import argparse
import csv
import re
import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from benchmarks.heap_scales import GRAIN, PUBLISHED
from calibrate.study.resources import bundled_particles
from liggghts_io import CaseSpec, Particle, execute, particle_named
from liggghts_io.case.spec import setup_of
from liggghts_io.errors import CaseError
from liggghts_io.experiments.heap.observing import azimuths, mean_of_flanks, measure
from liggghts_io.experiments.setup import Setup
from liggghts_io.files import write_text
from liggghts_io.measure.dumps import Frame, all_frames, read_frame

ROWS: Final = Path(__file__).parent / "results" / "heap_gap.csv"
PAGE: Final = Path(__file__).parents[2] / "docs" / "diagnosis.md"
MARKED: Final = re.compile(r"(<!-- heap gap -->\n).*?(<!-- end heap gap -->)", re.DOTALL)
MEASURED: Final = {"glued": 38.28, "steel": 34.10}
"""Table B.4 [deg]."""
WINDOWS: Final = {"lower": (0.1, 0.5), "upper": (0.5, 0.9), "wide": (0.05, 0.95)}
"""Other parts of the height to which a flank could have been fitted."""
_COLUMNS: Final = (
    "change", "surface", "seed", "angle_deg", "se_deg", *WINDOWS,
    "poured", "left", "failure", "wall_s",
)  # fmt: skip
_SIZES: Final = particle_named("Carbo HSP13", bundled_particles())


@dataclass(frozen=True)
class Change:
    """One thing that differs from the cone of 40 g with published parameters.

    Attributes
    ----------
    apparatus, effects, parameters : Mapping of str to float
        What is set besides.
    grain : Particle
    surfaces : tuple of str
        On which it is run.
    """

    apparatus: Mapping[str, float] = field(default_factory=dict)
    effects: Mapping[str, float] = field(default_factory=dict)
    parameters: Mapping[str, float] = field(default_factory=dict)
    grain: Particle = GRAIN
    surfaces: tuple[str, ...] = ("glued", "steel")


BASE: Final = "as published"
_GLUED: Final = ("glued",)
CHANGES: Final = {
    BASE: Change(),
    "outlet 20 mm wide, 35 mm above the plate": Change(
        {"outlet_m": 0.02, "outlet_height_m": 0.035, "pour_angle_deg": 38.0}
    ),
    "outlet at 48 mm": Change({"outlet_height_m": 0.048, "pour_angle_deg": 33.0}),
    "outlet at 120 mm": Change({"outlet_height_m": 0.12}),
    "80 g, not 40": Change({"cone_mass_kg": 0.08, "pour_angle_deg": 42.0}),
    "8 g/s through the funnel, not 19": Change({"pour_flow_kg_s": 0.02416 / 3.0}, surfaces=_GLUED),
    "a plate that the heap covers (50 mm)": Change({"plate_half_length_m": 0.025}),
    "sizes as measured": Change(grain=_SIZES),
    "half the time step": Change({"timestep_fraction": 0.1}, surfaces=_GLUED),
    "rolling friction by a constant torque": Change(effects={"constant_rolling_torque": 1.0}),
    "rolling friction about the normal too": Change(effects={"torsion": 1.0}),
    "tangential springs half as stiff": Change(
        effects={"tangential_stiffness": -0.5}, surfaces=_GLUED
    ),
    "static friction 1.5 times the sliding one": Change(effects={"static_friction_ratio": 0.5}),
    "cohesion of 20 kJ/m3": Change(effects={"cohesion_J_m3": 20e3}),
    "cohesion of 60 kJ/m3": Change(effects={"cohesion_J_m3": 60e3}),
    "adhesion to the wall of 60 kJ/m3": Change(
        effects={"wall_adhesion_J_m3": 60e3}, surfaces=("steel",)
    ),
    "restitution that falls with speed^(1/4)": Change(
        effects={"restitution_slope": 0.25}, surfaces=_GLUED
    ),
    "mu_roll_pp 0.3, not 0.086": Change(parameters={"mu_roll_pp": 0.3}),
    "mu_pp 0.8 and mu_roll_pp 0.6, the corner of the ranges": Change(
        parameters={"mu_pp": 0.8, "mu_roll_pp": 0.6}
    ),
}


def angle(frame: Frame, setup: Setup, window: tuple[float, float] | None) -> tuple[float, float]:
    """Return the angle of a heap at rest and its standard error [deg]; NaN where there is none."""
    if window:
        low, high = window
        setup = replace(setup, apparatus={**setup.apparatus, "flank_low": low, "flank_high": high})
    try:
        return mean_of_flanks([measure(frame, setup, turn) for turn in azimuths(setup)])
    except CaseError:
        return np.nan, np.nan


def row(name: str, surface: str, seed: int) -> dict[str, object]:
    """Run one heap and return its row."""
    chosen = CHANGES[name]
    spec = CaseSpec(
        "heap", chosen.grain, surface, "paper", PUBLISHED | dict(chosen.parameters),
        chosen.apparatus, chosen.effects, seed=seed,
    )  # fmt: skip
    setup = setup_of(spec)
    with tempfile.TemporaryDirectory() as root:
        result = execute(spec, Path(root))
        frames = all_frames(result.path / "output")
        counts = [read_frame(path).count for path in frames]
        last = read_frame(frames[-1])
    value, error = angle(last, setup, None)
    others = [angle(last, setup, window)[0] for window in WINDOWS.values()]
    values = (
        name, surface, seed, value, error, *others,
        max(counts), last.count, result.failure, result.wall_s,
    )  # fmt: skip
    return dict(zip(_COLUMNS, values, strict=True))


def missing(rows: pd.DataFrame, seeds: int) -> Iterator[tuple[str, str, int]]:
    """Yield what is still to be run, seed by seed."""
    done = set(zip(rows["change"], rows["surface"], rows["seed"], strict=True))
    for seed in range(1, seeds + 1):
        for name, chosen in CHANGES.items():
            for surface in chosen.surfaces:
                if (name, surface, seed) not in done:
                    yield name, surface, seed


def run_all(rows: Path, seeds: int) -> None:
    """Run what is not in the file of rows, and append it."""
    if not rows.exists():
        rows.write_text(",".join(_COLUMNS) + "\n", encoding="utf-8")
    for one in list(missing(pd.read_csv(rows), seeds)):
        try:
            found = row(*one)
        except CaseError as err:
            print(f"{one}: {err}", flush=True)
            continue
        with rows.open("a", newline="", encoding="utf-8") as file:
            csv.DictWriter(file, _COLUMNS).writerow(
                {k: f"{v:.6g}" if isinstance(v, float) else v for k, v in found.items()}
            )


def table(rows: pd.DataFrame) -> list[str]:
    """Return the lines of the table: one for each change, what is wanted in the first."""
    base = rows[rows["change"] == BASE].groupby("surface")["angle_deg"].mean()
    wanted = [f"{MEASURED[one]:.1f} ({MEASURED[one] - base[one]:+.1f})" for one in MEASURED]
    lines = [
        "| one thing changed | glued | steel |",
        "|---|---|---|",
        f"| *measured* | {wanted[0]} | {wanted[1]} |",
    ]
    for name, chosen in CHANGES.items():
        cells = []
        for surface in MEASURED:
            part = rows[(rows["change"] == name) & (rows["surface"] == surface)]["angle_deg"]
            if surface not in chosen.surfaces or part.empty:
                cells.append("-")
                continue
            change = "" if name == BASE else f"; {part.mean() - base[surface]:+.1f}"
            cells.append(f"{part.mean():.1f} ({len(part)}{change})")
        lines.append(f"| {name} | {' | '.join(cells)} |")
    return lines


def scatter(rows: pd.DataFrame) -> float:
    """Return by how much cones that differ in their seed alone scatter [deg]."""
    spread = rows.groupby(["change", "surface"])["angle_deg"].var().dropna()
    return float(np.sqrt(spread.mean()))


def cohesion_wanted(rows: pd.DataFrame, surface: str) -> tuple[float, float]:
    """Return the cohesion at which a straight line reaches the measured angle [J/m3].

    Also by how many times its weight a grain is held at the overlap that its weight makes: the
    force is the energy density times the area of contact (SJKR).
    """
    mean = rows[rows["surface"] == surface].groupby("change")["angle_deg"].mean()
    low, high = mean["cohesion of 20 kJ/m3"], mean["cohesion of 60 kJ/m3"]
    wanted = 20e3 + 40e3 * (MEASURED[surface] - low) / (high - low)
    radius, weight = 0.5 * GRAIN.d32_m, 9.81 * GRAIN.mass_kg
    stiffness = GRAIN.youngs_modulus / (2.0 * (1.0 - GRAIN.poisson_ratio**2))
    overlap = (0.75 * weight / (stiffness * np.sqrt(0.5 * radius))) ** (2.0 / 3.0)  # Hertz
    return float(wanted), float(wanted * np.pi * radius * overlap / weight)


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--rows", type=Path, default=ROWS)
    chosen = parser.parse_args()
    run_all(chosen.rows, chosen.seeds)
    rows = pd.read_csv(chosen.rows)
    lines = "\n".join(table(rows))
    print(lines)
    print(rows[rows["change"] == BASE].groupby("surface")[[*WINDOWS]].mean().round(1))
    print(f"cones of different seeds scatter by {scatter(rows):.2f} degrees")
    for surface in MEASURED:
        density, weights = cohesion_wanted(rows, surface)
        print(f"{surface}: {density / 1e3:.0f} kJ/m3 reach it, {weights:.1f} times a weight")
    if chosen.rows == ROWS:
        text = PAGE.read_text(encoding="utf-8")
        write_text(PAGE, MARKED.sub(lambda found: f"{found[1]}\n{lines}\n\n{found[2]}", text))


if __name__ == "__main__":
    main()
