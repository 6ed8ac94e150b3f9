"""Studies with planted parameters, on formulas with the shape of the real responses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from calibrate.runs.campaign import run_table
from calibrate.study.data import StudyData, load_data
from liggghts_io import CaseResult, CaseSpec, Particle
from tests.calibrate import stand_in

RANGES = {
    "mu_pp": (0.1, 0.8), "mu_roll_pp": (0.05, 0.6), "mu_pw": (0.1, 0.8),
    "mu_roll_pw": (0.05, 0.6), "e_pp": (0.3, 0.9), "e_pw": (0.3, 0.7),
}  # fmt: skip
TRUTH = {
    "mu_pp": 0.45, "mu_roll_pp": 0.2, "mu_pw": 0.3, "mu_roll_pw": 0.3, "e_pp": 0.6, "e_pw": 0.5,
}  # fmt: skip
ERRORS = {"angle_deg": 0.4, "t100_s": 0.12, "m1_g": 0.3, "m2_g": 0.12, "m3_g": 0.08, "m4_g": 0.05}
TILT_GAIN = 0.05
"""Part of the conveyor's time that a degree saves."""
UNITS = {"angle_deg": "deg", "t100_s": "s"}
PARTICLE = """
d32_um = {d32_um}
density_kg_m3 = 3560.0
flow_flat_g_s = 20.0
flow_glued_g_s = 20.0
impact_mass_g = 70.0
"""


@dataclass(frozen=True)
class Measurement:
    """What is measured where."""

    material: str
    surface: str
    experiment: str
    observable: str


def bench(material: str, surface: str) -> list[Measurement]:
    """Return all three experiments of a material on a surface."""
    found = [Measurement(material, surface, "heap", "angle_deg")]
    found.append(Measurement(material, surface, "conveyor", "t100_s"))
    if surface != "glued":
        boxes = ("m1_g", "m2_g", "m3_g", "m4_g")
        found += [Measurement(material, surface, "plate_impact", box) for box in boxes]
    return found


def truth_of(truths: Mapping[str, Mapping[str, float]], one: Measurement) -> Mapping[str, float]:
    """Return the parameters of a place: those of the material, changed by those of the surface."""
    return {**TRUTH, **truths.get(one.material, {}), **truths.get(one.surface, {})}


def planted_study(
    folder: Path,
    measurements: Sequence[Measurement],
    rng: np.random.Generator,
    *,
    truths: Mapping[str, Mapping[str, float]] | None = None,
    free: Sequence[str] = ("mu_pp", "mu_roll_pp"),
    scopes: Mapping[str, str] | None = None,
    design: str = "",
    more: str = "",
) -> StudyData:
    """Write a study whose data come from known parameters, and load it.

    Parameters
    ----------
    folder : Path
    measurements : sequence of Measurement
    rng : numpy Generator
        Measurement errors.
    truths : mapping, optional
        Parameters by material or surface, where they are not `TRUTH`.
    free : sequence of str
        Parameters with their ranges; the others have the value of `TRUTH`.
    scopes : mapping, optional
    design, more : str
        Further lines of the table [design], and further tables.
    """
    lines = ['name = "planted"', 'title = "Planted"', "[run]", 'scale = "quick"', "seed = 7"]
    lines += ["[design]", design]
    for number, material in enumerate(dict.fromkeys(one.material for one in measurements)):
        numbers = PARTICLE.format(d32_um=1000.0 * (1 + number))
        lines += ["[[material]]", f'name = "{material}"', numbers]
    for surface in dict.fromkeys(one.surface for one in measurements):
        lines += ["[[surface]]", f'name = "{surface}"']
    for k, one in enumerate(measurements):
        spec = spec_at(one, truth_of(truths or {}, one))
        value = stand_in.means(spec)[one.observable] + ERRORS[one.observable] * rng.normal()
        lines += [
            "[[target]]", f'name = "t{k}_{one.observable}"', f'material = "{one.material}"',
            f'surface = "{one.surface}"', f'experiment = "{one.experiment}"',
            f'observable = "{one.observable}"', f'unit = "{UNITS.get(one.observable, "g")}"',
            f"value = {value:.6f}", f"se = {ERRORS[one.observable]}",
        ]  # fmt: skip
    flat = any(one.surface != "glued" for one in measurements)
    for name, value in TRUTH.items():
        if name.endswith("_pw") and not flat:
            continue
        lines.append(f"[parameter.{name}]")
        low, high = RANGES[name]
        lines.append(f"range = [{low}, {high}]" if name in free else f"value = {value}")
        if scopes and name in scopes:
            lines.append(f'scope = "{scopes[name]}"')
    path = folder / "study.toml"
    path.write_text("\n".join([*lines, more]) + "\n", encoding="utf-8")
    return load_data(path)


def spec_at(one: Measurement, parameters: Mapping[str, float] = TRUTH) -> CaseSpec:
    """Return the case of a measurement."""
    return CaseSpec(one.experiment, Particle("p", 1e-3, 3560.0), one.surface, "quick", parameters)


def observed(spec: CaseSpec) -> dict[str, float]:
    """Return what the formulas give, and a tilted plate conveys faster."""
    found = stand_in.simulate(spec)
    if "t100_s" in found:
        found["t100_s"] *= 1.0 - TILT_GAIN * spec.effects.get("plate_tilt_deg", 0.0)
    return found


def run(specs: Sequence[CaseSpec], _label: str) -> pd.DataFrame:
    """Run cases on the formulas; nothing is stored."""
    results = [
        CaseResult(stand_in.case_id(spec), Path(), "ok", "", observed(spec), 0.01) for spec in specs
    ]
    return run_table(specs, results)
