"""A fast stand-in for the simulator: formulas with the shape of the real responses, plus noise.

Same interface as `liggghts_io.execute`: a case specification and a root directory in, a result out,
stored under the case's id and read back the next time. The shapes follow what the real experiments
show: angles rise and level off with both frictions, transport times rise with friction, box masses
peak over the wall restitution.
"""

from __future__ import annotations

import dataclasses
import hashlib
import json
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from liggghts_io import CaseResult, CaseSpec

SLOPES = {
    "drum": ("angle_slow_deg", "angle_fast_deg"),
    "drawdown": ("angle_box_deg", "angle_heap_deg"),
}
"""Angles that other experiments give; here all are like that of a heap."""
SLIDES = {"raft_angle_deg": "mu_pw", "loose_angle_deg": "mu_roll_pw"}
"""Angles of the tilting plate, each with the parameter whose arc it is."""
NOISE = {"angle_deg": 0.5, "t100_s": 0.15, "m": 0.25} | {
    name: 0.5 for names in (*SLOPES.values(), tuple(SLIDES)) for name in names
}
"""Standard deviation of one run: angles [deg], t100 [s], box masses [sqrt(g)]."""


def means(spec: CaseSpec) -> dict[str, float]:
    """Return the expected observables of a case."""
    p = dict(spec.parameters)
    glued = spec.surface == "glued"
    if spec.experiment == "heap":
        return {"angle_deg": _angle(p, glued)}
    if spec.experiment == "conveyor":
        return {"t100_s": _t100(p, glued)}
    if spec.experiment == "tilting_plate":
        return {name: float(np.degrees(np.arctan(p[one]))) for name, one in SLIDES.items()}
    if spec.experiment in SLOPES:
        return {name: _angle(p, glued) for name in SLOPES[spec.experiment]}
    return _boxes(p)


def _saturate(mu: float, scale: float) -> float:
    return 1.0 - float(np.exp(-mu / scale))


def _angle(p: Mapping[str, float], glued: bool) -> float:
    top = 14.0 + 18.0 * _saturate(p["mu_pp"], 0.35) + 26.0 * p["mu_roll_pp"] ** 0.7
    if glued:
        return top
    foot = _saturate(p["mu_pw"], 0.12) * (0.75 + 0.25 * _saturate(p["mu_roll_pw"], 0.12))
    return top * (0.55 + 0.45 * foot)


def _t100(p: Mapping[str, float], glued: bool) -> float:
    if glued:
        return 12.0 + 9.0 * p["mu_pp"] ** 0.8 + 2.5 * p["mu_pp"] * p["mu_roll_pp"]
    soft = 1.0 / (1.0 + np.exp(-(p["mu_pw"] - 0.35) / 0.06))
    grip = 1.0 + 0.6 * p["mu_pp"]
    return float(8.0 + 6.0 * p["mu_pw"] + 5.0 * grip * soft * p["mu_roll_pw"] ** 0.5)


def _boxes(p: Mapping[str, float]) -> dict[str, float]:
    e, f = p["e_pw"], p["e_pp"]
    masses = {"m1_g": 42.0 - 16.0 * e - 10.0 * f}
    for i, (centre, width, top) in enumerate(
        ((0.40, 0.16, 10.0), (0.50, 0.13, 5.5), (0.60, 0.11, 2.2)), 2
    ):
        masses[f"m{i}_g"] = float(top * np.exp(-(((e - centre) / width) ** 2)) + 0.3 + 0.2 * f)
    masses["beside_g"] = 68.73 - sum(masses.values())
    return masses


def case_id(spec: CaseSpec) -> str:
    """Return a name that depends on everything in the specification."""
    # The name alone, so that the noise stays what it is when a particle learns a new number.
    named = dataclasses.asdict(spec) | {"particle": spec.particle.name}
    text = json.dumps(named, sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def simulate(spec: CaseSpec) -> dict[str, float]:
    """Return noisy observables; the noise depends on the specification only."""
    rng = np.random.default_rng(int(case_id(spec), 16))
    result = {}
    for name, value in means(spec).items():
        if name.startswith("m") and name.endswith("_g"):
            root = np.sqrt(value) + NOISE["m"] * 0.3 * rng.normal()
            result[name] = float(max(root, 0.0) ** 2)
        else:
            result[name] = float(value + NOISE.get(name, 0.0) * rng.normal())
    return result


def execute(spec: CaseSpec, root: Path) -> CaseResult:
    """Run the stand-in or return the stored result, as `liggghts_io.execute` does."""
    name = case_id(spec)
    path = root / name
    record = path / "result.json"
    if not record.exists():
        path.mkdir(parents=True, exist_ok=True)
        temporary = path / "result.json.tmp"
        temporary.write_text(json.dumps(simulate(spec)))
        temporary.replace(record)
    return CaseResult(name, path, "ok", "", json.loads(record.read_text()), 0.01)


def stored(spec: CaseSpec, root: Path) -> CaseResult | None:
    """Return the stored result of a case, or None when it has not run."""
    known = (root / case_id(spec) / "result.json").exists()
    return execute(spec, root) if known else None
