"""Recorded engine runs for the diagnosis, and measured data made from some of them.

`tests/data/diagnose/engine_runs.csv` holds quick runs of the bundled engine: a local design around
published parameters (seeds from 1 on), and runs at others (from 501 on), from which data are made.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pandas as pd

from calibrate.cli.diagnose_study import ENGINE_DESIGN
from calibrate.diagnose import Options
from calibrate.diagnose.from_study import problem_of
from calibrate.diagnose.problem import Problem
from calibrate.runs.reuse import point_of
from calibrate.study.data import StudyData, load_data
from calibrate.study.load import load_study
from calibrate.study.resources import bundled_particles
from calibrate.study.schema.settings import Known
from calibrate.study.schema.targets import Target
from calibrate.study.write import study_text
from liggghts_io import CaseResult, CaseSpec, particle_named
from liggghts_io.effects import EFFECTS
from liggghts_io.experiments.conveyor import CONVEYOR
from liggghts_io.experiments.plate_impact import PLATE_IMPACT
from tests.paths import CASES, DATA

GRAIN = particle_named("Carbo HSP13", bundled_particles())
RECORDED = DATA / "diagnose"
RUNS = RECORDED / "engine_runs.csv"
PUBLISHED = {
    "mu_pp": 0.694, "mu_roll_pp": 0.0856, "mu_pw": 0.307,
    "mu_roll_pw": 0.274, "e_pp": 0.742, "e_pw": 0.439,
}  # fmt: skip
# The material from which data are made; the fitter starts at the published parameters.
MATERIAL = {
    "mu_pp": 0.66, "mu_roll_pp": 0.10, "mu_pw": 0.29,
    "mu_roll_pw": 0.30, "e_pp": 0.70, "e_pw": 0.45,
}  # fmt: skip
# Centre of a second, lighter design: between the places to which a tilted plate and the paper's
# own data pull the base fit.
SECOND = {
    "mu_pp": 0.413, "mu_roll_pp": 0.1243, "mu_pw": 0.239,
    "mu_roll_pw": 0.189, "e_pp": 0.798, "e_pw": 0.341,
}  # fmt: skip
GLUED = ("mu_pp", "mu_roll_pp", "e_pp")
# Recorded runs only: two designs, no further ones and no runs at fitted points.
OPTIONS = Options(design=ENGINE_DESIGN, rounds=2, infill=0, confirm=0, also=(SECOND,))
LEVELS = (25, 50, 75, 100)
EXPERIMENTS = (
    ("heap", "glued"), ("heap", "steel"), ("conveyor", "glued"),
    ("conveyor", "steel"), ("plate_impact", "steel"),
)  # fmt: skip
# Standard errors of the paper's tables for Carbo HSP13 (Tables B.4 to B.6), by observable.
TABLE_SEM = {
    ("heap", "glued"): {"angle_deg": 0.61},
    ("heap", "steel"): {"angle_deg": 0.16},
    ("conveyor", "glued"): {f"t{m}_s": 0.02 for m in LEVELS},
    ("conveyor", "steel"): {f"t{m}_s": 0.06 for m in LEVELS},
    ("plate_impact", "steel"): {"m1_g": 0.15, "m2_g": 0.09, "m3_g": 0.04, "m4_g": 0.03},
}


def key(spec: CaseSpec) -> str:
    """Text that identifies a run: what physics and chance depend on."""
    names = GLUED if spec.surface == "glued" else tuple(PUBLISHED)
    theta = {n: float(f"{spec.parameters[n]:.8g}") for n in names}
    effects = {k: v for k, v in sorted(spec.effects.items()) if v != 0.0}
    facts = [
        spec.experiment,
        "glued" if spec.surface == "glued" else "steel",
        theta,
        effects,
        dict(spec.apparatus),
        spec.seed,
    ]
    return json.dumps(facts)


def read_runs(path: Path = RUNS) -> dict[str, dict[str, float]]:
    """Observables of every recorded run by its key."""
    table = pd.read_csv(path, comment="#")
    return {k: json.loads(o) for k, o in zip(table["run"], table["observables"], strict=True)}


@dataclass(frozen=True)
class Recorded:
    """Runner that knows recorded runs only; any other run counts as failed."""

    runs: Mapping[str, Mapping[str, float]]

    def __call__(self, specs: Sequence[CaseSpec]) -> list[CaseResult]:
        """Look the runs up."""
        return [self._one(s) for s in specs]

    def _one(self, spec: CaseSpec) -> CaseResult:
        shown = self.runs.get(key(spec))
        if shown is None:
            return CaseResult("", Path(), "failed", f"not recorded: {key(spec)}", {}, 0.0)
        points = {point_of("mass_time", m): shown[f"t{m}_s"] for m in LEVELS if f"t{m}_s" in shown}
        return CaseResult("", Path(), "ok", "", {**shown, **points}, 1.0)


def seed_scatter(runs: Mapping[str, Mapping[str, float]]) -> dict[tuple[str, str, str], float]:
    """Return the scatter between seeds per experiment, surface and observable, pooled."""
    groups: dict[str, list[tuple[str, str, Mapping[str, float]]]] = {}
    for text, shown in runs.items():
        facts = json.loads(text)
        groups.setdefault(json.dumps(facts[:-1]), []).append((facts[0], facts[1], shown))
    squares: dict[tuple[str, str, str], list[float]] = {}
    for members in groups.values():
        if len(members) < 2:
            continue
        experiment, surface, _ = members[0]
        for name in members[0][2]:
            values = np.array([m[2][name] for m in members if name in m[2]])
            if len(values) > 1:
                squares.setdefault((experiment, surface, name), []).append(values.var(ddof=1))
    return {k: float(np.sqrt(np.mean(v))) for k, v in squares.items()}


@dataclass(frozen=True)
class Hidden:
    """What is hidden in the data, and from which material and seeds they are made.

    Parameters
    ----------
    effects : mapping
        Effect -> strength.
    apparatus : mapping
        Experiment -> apparatus parameter -> value that the fitter does not know.
    seeds : tuple of int
    material : mapping
        Contact parameters.
    """

    effects: Mapping[str, float] = field(default_factory=dict)
    apparatus: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    seeds: tuple[int, ...] = (501, 502, 503)
    material: Mapping[str, float] = field(default_factory=lambda: MATERIAL)

    def spec(self, where: tuple[str, str], seed: int) -> CaseSpec:
        """Return the run of one experiment; what does not act there is left out."""
        on = {k: v for k, v in self.effects.items() if EFFECTS[k].acts_in(where[0])}
        apparatus = dict(self.apparatus.get(where[0], {}))
        return CaseSpec(
            where[0], GRAIN, where[1], "quick", dict(self.material), apparatus, on, seed
        )


def _boxes_off(shift: float) -> dict[str, dict[str, float]]:
    """Return boxes of the plate impact that stand `shift` [m] from where they are thought to be."""
    walls = {p.name: p for p in PLATE_IMPACT.parameters if p.name.startswith("box_")}
    edges = {k: p.quick + shift for k, p in walls.items() if k.endswith(("near_m", "far_m"))}
    return {"plate_impact": edges}


def _stroke(factor: float) -> dict[str, dict[str, float]]:
    """Return a conveyor whose amplitude is not the one that was set."""
    set_to = next(p.quick for p in CONVEYOR.parameters if p.name == "amplitude_m")
    return {"conveyor": {"amplitude_m": factor * set_to}}


# Hidden in data of the same material. The last two are outside the library.
CASES_HIDDEN = {
    "tilt": Hidden({"plate_tilt_deg": 5.0}),
    "cohesion": Hidden({"cohesion_J_m3": 60000.0}),
    "weak cohesion": Hidden({"cohesion_J_m3": 25000.0}),
    "period": Hidden({"plate_period": 0.08}),
    "boxes": Hidden(apparatus=_boxes_off(0.010)),
    "stroke": Hidden(apparatus=_stroke(1.10)),
}
# Ordinary strong effects; every blind study scales one of them by a random factor.
_BLIND = {
    "plate_tilt_deg": 5.0,
    "mass_flow_factor": 0.20,
    "cohesion_J_m3": 60000.0,
    "size_distribution": 1.0,
    "wall_adhesion_J_m3": 25000.0,
    "plate_period": 0.10,
    "boxes": 0.010,
    "stroke": 0.10,
}


def blind(part: int = 0, nulls: int = 4) -> dict[str, Hidden]:
    """Studies whose material, strengths and seeds are drawn: nothing tuned to any of them.

    Four hide nothing, six one cause of the library, two an error that no candidate describes.
    Rules were still changed after looking at part 0; part 1 was drawn and run after that.
    """
    rng = np.random.default_rng(20261121 + part)
    path = CASES / "hsp13_steel.toml"
    base = problem_of(load_data(path), PUBLISHED)
    found = {}
    for number, name in enumerate([*[""] * nulls, *_BLIND]):
        u = np.clip(base.start + rng.uniform(-0.1, 0.1, len(base.start)), 0.02, 0.98)
        material = {k: float(f"{v:.6g}") for k, v in base.theta(u).items()}
        size = _BLIND.get(name, 0.0) * rng.uniform(0.7, 1.3)
        if name not in EFFECTS or EFFECTS[name].sign == "both":
            size *= rng.choice([-1.0, 1.0])
        seeds = tuple(601 + 100 * part + 3 * number + k for k in range(3))
        label = f"blind {part}: {name or f'nothing {number + 1}'}"
        found[label] = _one_blind(name, float(size), seeds, material)
    return found


def every_case() -> dict[str, Hidden]:
    """Return the chosen and the drawn studies by name."""
    return {**CASES_HIDDEN, **blind(0), **blind(1)}


def _one_blind(
    name: str, size: float, seeds: tuple[int, ...], material: Mapping[str, float]
) -> Hidden:
    apparatus: dict[str, dict[str, float]] = {}
    if name == "boxes":
        apparatus = _boxes_off(size)
    elif name == "stroke":
        apparatus = _stroke(1.0 + size)
    effects = {name: size} if name in EFFECTS else {}
    return Hidden(effects, apparatus, seeds, material)


def measure(
    runs: Mapping[str, Mapping[str, float]], hidden: Hidden, rng: np.random.Generator
) -> dict[tuple[str, str], dict[str, tuple[float, float]]]:
    """Mean over the hidden runs plus the table's error, and the standard error of both."""
    scatter = seed_scatter(runs)
    found = {}
    for where in EXPERIMENTS:
        shown = [runs[key(hidden.spec(where, s))] for s in hidden.seeds]
        shared = rng.standard_normal()
        values = {}
        for name, sem in TABLE_SEM[where].items():
            mean = float(np.mean([one[name] for one in shown]))
            luck = rng.standard_normal()
            if name.startswith("t"):  # one slow repeat is slow at every mass
                luck = 0.9 * shared + 0.4359 * luck
            error = float(np.hypot(sem, scatter[*where, name] / np.sqrt(len(shown))))
            values[name] = (mean + sem * luck, error)
        found[where] = values
    return found


def write_study(directory: Path, data: Mapping[tuple[str, str], Mapping[str, tuple[float, float]]],
                *, curve: bool) -> StudyData:  # fmt: skip
    """Write study and CSV files as a laboratory would hand them over."""
    directory.mkdir(parents=True, exist_ok=True)
    particle = "Carbo HSP13"
    heap = [(particle, s, *data["heap", s]["angle_deg"]) for s in ("glued", "steel")]
    _csv(directory / "angle_of_repose.csv", "particle,surface,angle_deg,sem_deg", heap)
    times = [(particle, s, *data["conveyor", s]["t100_s"]) for s in ("glued", "steel")]
    _csv(directory / "conveyor.csv", "particle,surface,t100_s,sem_s", times)
    boxes = data["plate_impact", "steel"]
    head = "particle,surface," + ",".join(f"m{k}_g,m{k}_sem" for k in range(1, 5))
    row = (particle, "steel", *(x for k in range(1, 5) for x in boxes[f"m{k}_g"]))
    _csv(directory / "plate_impact.csv", head, [row])
    study = load_study(CASES / "hsp13_steel.toml")
    curves = []
    for surface in ("glued", "steel"):
        shown = data["conveyor", surface]
        time = np.array([shown[f"t{m}_s"][0] for m in LEVELS])
        error = np.array([shown[f"t{m}_s"][1] for m in LEVELS])
        rows = list(zip(time, map(float, LEVELS), error * np.gradient(LEVELS, time), strict=True))
        file = f"mass_time_{surface}.csv"
        _csv(directory / file, "time_s,mass_g,sem_g", rows)
        curves.append(
            Target(name=f"curve_{surface}", material=particle, surface=surface,
                   experiment="conveyor", observable="mass_time", file=file, x_column="time_s",
                   column="mass_g", se_column="sem_g", levels=list(LEVELS))
        )  # fmt: skip
    study = study.model_copy(update={"targets": study.targets + curves * curve})
    path = directory / "study.toml"
    path.write_text(study_text(study), encoding="utf-8")
    return load_data(path)


def changed(data: StudyData, **changes: object) -> StudyData:
    """Return the same data with some keys of the study changed."""
    return replace(data, study=data.study.model_copy(update=changes))


def _csv(path: Path, head: str, rows: Sequence[Sequence[object]]) -> None:
    lines = [",".join(f"{x:.6g}" if isinstance(x, float) else str(x) for x in r) for r in rows]
    path.write_text("\n".join([head, *lines]) + "\n", encoding="utf-8")


def problem(
    directory: Path,
    runs: Mapping[str, Mapping[str, float]],
    hidden: Hidden,
    seed: int,
    *,
    curve: bool = True,
    known: Mapping[str, Known] | None = None,
) -> Problem:
    """Problem of a study whose data hide something; `known` are independent measurements."""
    data = measure(runs, hidden, np.random.default_rng(seed))
    study = write_study(directory, data, curve=curve)
    return problem_of(changed(study, known={k: [v] for k, v in (known or {}).items()}), PUBLISHED)
