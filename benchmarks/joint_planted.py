"""Joint calibrations of planted truths, on an emulator of recorded runs in place of the engine.

    python benchmarks/joint_planted.py [--truths 16] [--runs 160] [--bent] [--discrepancy 0.05]

The simulator is an emulator of the 479 recorded runs of HSP13 (tests/data/emulator), with their
noise: a study of 200 runs takes ten seconds instead of four minutes. Truths are drawn from the
ranges of cases/proppants/hsp13_steel.toml, its measured values are replaced by those of the truth
with their errors. --bent multiplies boxes 3 and 4 by 0.7 and 0.5: no values can meet all targets.

Printed per truth and as means: runs; error of the median and CRPS (continuous ranked probability
score: error and width in one, below is better), in ranges; width and coverage of 90 % intervals;
distance of the engine's check from the targets and of its runs from what the emulators had
expected before, root mean square in standard errors.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd
from threadpoolctl import threadpool_limits

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from calibrate.arrays import Array
from calibrate.emulator.emulator import TrainedEmulator, train_emulator
from calibrate.emulator.types import Inputs
from calibrate.inference.priors import from_unit, to_unit
from calibrate.questions.joint.calibration import calibrate_jointly
from calibrate.questions.joint.result import JointResult
from calibrate.scales import backward
from calibrate.study.data import StudyData, load_data
from calibrate.study.model import Study
from liggghts_io import CaseSpec
from tests.calibrate.emulator.recorded import PLACES, RANGES, read_runs
from tests.paths import ROOT

STUDY = ROOT / "cases" / "proppants" / "hsp13_steel.toml"
BENT = {"m3_steel": 0.7, "m4_steel": 0.5}
SECONDS = {"heap": 2.3, "conveyor": 2.0, "plate_impact": 1.3}
"""What a run of the engine takes."""


@dataclass(frozen=True)
class Simulator:
    """Emulators of recorded runs by experiment and surface, with the names of their inputs."""

    places: Mapping[tuple[str, str], tuple[TrainedEmulator, tuple[str, ...]]]

    def observed(self, spec: CaseSpec, rng: np.random.Generator | None) -> dict[str, float]:
        """Return what a case gives, without noise where there is no generator."""
        surface = "glued" if spec.surface == "glued" else "steel"
        emulator, names = self.places[spec.experiment, surface]
        u = [
            float(to_unit(np.array(spec.parameters[name]), *RANGES[name], _spacing(name)))
            for name in names
        ]
        mean = emulator.predict(Inputs.at([u])).mean[0]
        if rng is not None:
            mean = mean + np.sqrt(emulator.noise) * rng.standard_normal(len(mean))
        if spec.experiment == "conveyor":
            return {"t100_s": float(np.exp(mean[-1]))}
        if spec.experiment == "heap":
            return {"angle_deg": float(mean[0])}
        masses = backward("sqrt", mean)
        return {f"m{k + 1}_g": float(mass) for k, mass in enumerate(masses)}

    def run(self, specs: Sequence[CaseSpec], _label: str) -> pd.DataFrame:
        """Run cases; the same case always gives the same."""
        rows = []
        for spec in specs:
            words = (
                f"{spec.experiment} {spec.surface} {spec.seed} {sorted(spec.parameters.items())}"
            )
            rng = np.random.default_rng(list(words.encode()))
            row = {"case_id": words, "status": "ok", "reason": "", "path": ""}
            rows.append({**row, "wall_s": SECONDS[spec.experiment], **self.observed(spec, rng)})
        return pd.DataFrame(rows)


def _spacing(name: str) -> str:
    return "log" if name.startswith("mu") else "linear"


def simulator() -> Simulator:
    """Return emulators of all recorded runs."""
    found = {}
    for place, key in PLACES.items():
        runs = read_runs(place, effects=False)
        found[key] = train_emulator(runs.inputs, runs.outputs, runs.y), runs.parameters
    return Simulator(found)


def _adapted(study: Study, runs: int, discrepancy: float) -> Study:
    """Return a study within the ranges of the recorded runs, with another budget and belief."""
    narrower = {}
    for name, one in study.parameters.items():
        spans = {
            key: (max(low, RANGES[name][0]), min(high, RANGES[name][1]))
            for key, (low, high) in one.range.items()
        }
        narrower[name] = one.model_copy(update={"range": spans})
    design = study.design.model_copy(update={"runs": runs})
    belief = study.likelihood.model_copy(update={"discrepancy": discrepancy})
    return study.model_copy(update={"parameters": narrower, "design": design, "likelihood": belief})


def planted(
    data: StudyData, engine: Simulator, number: int, bent: Mapping[str, float]
) -> tuple[StudyData, dict[str, float]]:
    """Return the study of a truth, and the truth."""
    rng = np.random.default_rng([7, number])
    study, truth = data.study, {}
    for name, instance in study.free:
        low, high = study.range_of(name, instance) or (0.0, 0.0)
        spacing = study.parameters[name].spacing
        truth[name] = float(from_unit(np.array(rng.random()), low, high, spacing))
    scalars = {}
    for target in study.targets:
        case = CaseSpec(
            experiment=target.experiment, particle=study.materials[0].bulk.particle,
            surface=study.surface_named(target.surface).kind, scale="quick", parameters=truth,
            seed=1, effects={},
        )  # fmt: skip
        value = engine.observed(case, None)[target.observable] * bent.get(target.name, 1.0)
        old = data.scalars[target.name]
        scalars[target.name] = replace(old, value=value + old.se * rng.standard_normal())
    return replace(data, scalars=scalars, study=study), truth


def judged(result: JointResult, truth: Mapping[str, float]) -> dict[str, float]:
    """Return the figures of one truth."""
    space = result.posterior.space
    values = np.array([[truth[name] for name in result.posterior.names]])
    units, true = space.units(result.posterior.samples), space.units(values)[0]
    low, middle, high = np.quantile(units, [0.05, 0.5, 0.95], axis=0)
    z = np.array([row.z for row in result.check])
    return {
        "runs": float(len(result.runs)),
        "error": float(np.abs(middle - true).mean()),
        "crps": float(np.mean([_crps(units[:, k], true[k]) for k in range(len(true))])),
        "width": float((high - low).mean()),
        "coverage": float(((low <= true) & (true <= high)).mean()),
        "check z": float(np.sqrt(np.mean(z**2))),
        "unseen z": result.unseen_z,
    }


def _crps(draws: Array, truth: float) -> float:
    ordered, count = np.sort(draws), len(draws)
    spread = (2.0 * np.arange(1, count + 1) - count - 1.0) @ ordered / count**2
    return float(np.abs(draws - truth).mean() - spread)


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--truths", type=int, default=16)
    parser.add_argument("--runs", type=int, default=160)
    parser.add_argument("--discrepancy", type=float, default=0.05)
    parser.add_argument("--bent", action="store_true", help="boxes 3 and 4 cannot be met")
    args = parser.parse_args()
    engine, data, rows = simulator(), load_data(STUDY), []
    data = replace(data, study=_adapted(data.study, args.runs, args.discrepancy))
    with threadpool_limits(1):
        for number in range(args.truths):
            bent = BENT if args.bent else {}
            study, truth = planted(data, engine, number, bent)
            rows.append(judged(calibrate_jointly(study, engine.run), truth))
            print(json.dumps({k: round(v, 3) for k, v in rows[-1].items()}), flush=True)
    print(pd.DataFrame(rows).mean().round(3).to_string())


if __name__ == "__main__":
    main()
