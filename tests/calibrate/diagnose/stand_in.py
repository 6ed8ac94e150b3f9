"""A fast analytic stand-in for the engine: same interface, plausible sensitivities, seed noise.

It imitates what the three experiments do (friction saturates, a pile on a smooth plate slides
apart, boxes catch a peak of the bounce) so that the diagnosis meets curvature, interactions, flat
directions and look-alikes, at ten thousand cases per second.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from statistics import NormalDist

import numpy as np

from calibrate.diagnose.problem import Candidate, Observable, Parameter, Problem

CURVE_G = (50, 100, 150, 200)
TRUTH = {
    "mu_pp": 0.60, "mu_roll_pp": 0.12, "mu_pw": 0.32,
    "mu_roll_pw": 0.28, "e_pp": 0.70, "e_pw": 0.45,
}  # fmt: skip
# Scatter of one run on the fit's scale: degrees, log seconds, root grams.
NOISE = {"angle_deg": 0.6, "t": 0.012, "m": 0.05}
SCALES = {"a": "linear", "t": "log", "m": "sqrt"}
# Standard errors of the bench, of the size in the paper's tables.
BENCH = {"angle_deg": 0.3, "t": 0.006, "m": 0.012}


@dataclass(frozen=True)
class Spec:
    """The fields of a case description that the stand-in reads."""

    experiment: str
    surface: str
    parameters: Mapping[str, float]
    effects: Mapping[str, float] = field(default_factory=dict)
    seed: int = 1


@dataclass(frozen=True)
class Result:
    """The fields of a case result that the diagnosis reads."""

    status: str
    reason: str
    observables: Mapping[str, float]
    wall_s: float = 0.0
    case_id: str = ""
    path: Path = Path()


def _heap(p: Mapping[str, float], glued: bool, e: Mapping[str, float]) -> dict[str, float]:
    grip = 1.0 - np.exp(-p["mu_pp"] / 0.3)
    angle = 16.0 + 12.0 * grip + 38.0 * np.sqrt(p["mu_roll_pp"]) * grip - 2.5 * p["e_pp"]
    angle += 5.0 * np.log1p(e.get("cohesion", 0.0))
    angle += 1.2 * e.get("sizes", 0.0)
    if not glued:
        slip = np.exp(-p["mu_pw"] / 0.16) * (1.0 + 2.0 * np.exp(-p["mu_roll_pw"] / 0.15))
        angle -= 14.0 * slip / (1.0 + 0.8 * e.get("wall_adhesion", 0.0))
    return {"angle_deg": float(angle)}


def _conveyor(p: Mapping[str, float], glued: bool, e: Mapping[str, float]) -> dict[str, float]:
    if glued:
        drive = 0.30 + 0.35 * np.tanh(1.4 * p["mu_pp"]) - 0.5 * p["mu_roll_pp"]
        drive *= 1.0 - 0.20 * e.get("cohesion", 0.0)
    else:
        drive = 0.35 + 1.3 * p["mu_pw"] - 0.4 * p["mu_pw"] ** 2 + 0.08 * p["mu_roll_pw"]
        drive *= 1.0 - 0.05 * e.get("cohesion", 0.0) + 0.06 * e.get("wall_adhesion", 0.0)
    slide = 0.4 if glued else 1.0
    lean = e.get("tilt", 0.0) + 0.8 * e.get("slope", 0.0)
    drive *= 1.0 + 0.6 * slide * np.sin(0.25 * lean)
    drive /= (1.0 + e.get("period", 0.0)) ** 2
    feed = 24.0 * (1.0 + e.get("mass_flow", 0.0)) * (1.0 - 0.06 * e.get("sizes", 0.0))
    layer = 40.0 * drive
    flow = (feed**-4 + layer**-4) ** -0.25
    start = 2.4 / drive
    return {f"t{m}_s": float(start + m / flow + 0.15 * np.sqrt(m / feed)) for m in CURVE_G}


def _impact(p: Mapping[str, float], e: Mapping[str, float]) -> dict[str, float]:
    reach = 0.03 + 0.30 * p["e_pw"] ** 1.5 * (1.0 - 0.25 * min(p["mu_pw"], 0.6))
    reach *= 1.0 - 0.10 * e.get("wall_adhesion", 0.0)
    spread = 0.035 * (1.0 + 0.25 * e.get("sizes", 0.0)) + 0.03 * (p["e_pp"] - 0.5)
    spread -= 0.006 * e.get("cohesion", 0.0)
    edges = np.array([0.0, 0.062, 0.10, 0.14, 0.20])
    cdf = np.array([NormalDist(reach, spread).cdf(x) for x in edges])
    near = 60.0 * (1.0 - 0.25 * p["e_pp"])
    masses = np.diff(cdf) * np.array([near, 30.0, 30.0, 30.0])
    return {f"m{k + 1}_g": float(m) for k, m in enumerate(masses)}


def mean(spec: Spec) -> dict[str, float]:
    """Observables of a case without noise."""
    glued, e = spec.surface == "glued", spec.effects
    if spec.experiment == "heap":
        return _heap(spec.parameters, glued, e)
    if spec.experiment == "conveyor":
        return _conveyor(spec.parameters, glued, e)
    return _impact(spec.parameters, e)


def _rng(*words: object) -> np.random.Generator:
    digest = hashlib.sha256(json.dumps(words, default=str).encode()).digest()
    return np.random.default_rng(np.frombuffer(digest, dtype=np.uint32))


def scatter(values: Mapping[str, float], shared: np.random.Generator,
            own: np.random.Generator, sizes: Mapping[str, float]) -> dict[str, float]:  # fmt: skip
    """Add noise: a third of the variance is common to all runs of one seed."""
    noisy = {}
    curve_shared, curve_own = shared.standard_normal(), own.standard_normal()
    for name, value in values.items():
        kind = name if name in sizes else name[0]
        a, b = shared.standard_normal(), own.standard_normal()
        if kind == "t":  # a run that is slow early stays slow
            a, b = 0.9 * curve_shared + 0.4359 * a, 0.9 * curve_own + 0.4359 * b
        draw = sizes[kind] * (np.sqrt(1 / 3) * a + np.sqrt(2 / 3) * b)
        if kind == "t":
            noisy[name] = float(value * np.exp(draw))
        elif kind == "m":
            noisy[name] = float(max(np.sqrt(value) + draw, 0.0) ** 2)
        else:
            noisy[name] = float(value + draw)
    return noisy


@dataclass(frozen=True)
class StandIn:
    """Runner: list of cases to list of results. `world` separates fitter and bench seeds."""

    world: int = 0
    noise: float = 1.0

    def __call__(self, specs: Sequence[Spec]) -> list[Result]:
        """Run all cases."""
        return [self._run(s) for s in specs]

    def _run(self, spec: Spec) -> Result:
        shared = _rng(self.world, spec.experiment, spec.surface, spec.seed)
        own = _rng(self.world, spec.experiment, spec.surface, spec.seed,
                   sorted(spec.parameters.items()), sorted(spec.effects.items()))  # fmt: skip
        sizes = {k: self.noise * v for k, v in NOISE.items()}
        return Result("ok", "", scatter(mean(spec), shared, own, sizes))


EXPERIMENTS = {
    "heap_glued": Spec("heap", "glued", TRUTH),
    "heap_steel": Spec("heap", "steel", TRUTH),
    "conveyor_glued": Spec("conveyor", "glued", TRUTH),
    "conveyor_steel": Spec("conveyor", "steel", TRUTH),
    "impact_steel": Spec("plate_impact", "steel", TRUTH),
}
_PP = ("mu_pp", "mu_roll_pp", "e_pp")
_ALL = tuple(TRUTH)
ACTIVE = {k: _PP if k.endswith("glued") else _ALL for k in EXPERIMENTS}
RANGES = {
    "mu_pp": (0.1, 0.8, True), "mu_roll_pp": (0.05, 0.6, True), "mu_pw": (0.1, 0.8, True),
    "mu_roll_pw": (0.05, 0.6, True), "e_pp": (0.2, 0.9, False), "e_pw": (0.2, 0.9, False),
}  # fmt: skip
BOTH = ("conveyor_glued", "conveyor_steel")
EVERY = tuple(EXPERIMENTS)
STEEL = ("heap_steel", "conveyor_steel", "impact_steel")
LIBRARY = (
    Candidate("plate_tilt_deg", "tilt", 3.0, -3.0, 3.0, BOTH, "conveyor plate not level"),
    Candidate("mass_flow_factor", "mass_flow", 0.3, -0.3, 0.3, BOTH, "funnel flow"),
    Candidate("cohesion_J_m3", "cohesion", 2.0, 0.0, 2.0, EVERY, "cohesion between grains"),
    Candidate("size_distribution", "sizes", 1.5, 0.0, 1.5, EVERY, "grains are not of one size"),
    Candidate("wall_adhesion_J_m3", "wall_adhesion", 2.0, 0.0, 2.0, STEEL, "adhesion to the wall"),
)
# Leans the plate like the tilt does, under another name: no data can tell the two apart.
TWIN = Candidate("table_slope_deg", "slope", 3.0, -4.0, 4.0, BOTH, "the table is not level")


def bench(theta: Mapping[str, float], effects: Mapping[str, float], rng: np.random.Generator,
          repeats: int = 5, curve: bool = True) -> tuple[Observable, ...]:  # fmt: skip
    """Measured values as a bench would report them: mean and standard error of repeats."""
    found = []
    for name, base in EXPERIMENTS.items():
        exact = mean(replace(base, parameters=theta, effects=effects))
        single = {k: v * np.sqrt(repeats) for k, v in BENCH.items()}
        series = [scatter(exact, rng, rng, single) for _ in range(repeats)]
        for quantity in exact:
            if not curve and quantity.startswith("t") and quantity != "t100_s":
                continue
            values = np.array([one[quantity] for one in series])
            sem = float(values.std(ddof=1) / np.sqrt(repeats))
            scale = SCALES[quantity[0]]
            value = float(values.mean())
            found.append(Observable(name, quantity, value, sem, scale, repeats, scale == "log"))
    return tuple(found)


def problem(observables: tuple[Observable, ...], start: Mapping[str, float],
            library: tuple[Candidate, ...] = LIBRARY) -> Problem:  # fmt: skip
    """Diagnosis problem around a staged result."""
    parameters = tuple(
        Parameter(n, RANGES[n][0], RANGES[n][1], start[n], RANGES[n][2]) for n in _ALL
    )
    return Problem(parameters, observables, EXPERIMENTS, ACTIVE, library)
