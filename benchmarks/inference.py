"""Time and accuracy of the inference: many targets, and samplers against known evidence.

    python benchmarks/inference.py                # 20 to 200 targets, ties, shared errors
    python benchmarks/inference.py --samplers     # against dynesty, nautilus, ultranest, emcee

Emulators are Gaussian processes of 300 runs each, so that a prediction costs what it costs in a
study. Peers that are not installed are left out. CPU seconds; a peer is stopped after a limit. A
question mark stands behind an evidence whose error is not to be trusted.
"""

from __future__ import annotations

import argparse
import importlib.util
import math
import signal
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.stats import qmc

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from benchmarks.samplers import known_evidence
from calibrate.arrays import Array
from calibrate.emulator.types import Inputs, Prediction
from calibrate.inference.priors import Prior
from calibrate.inference.problem import Place, Problem, Reading, Source
from calibrate.inference.sampling import sample
from calibrate.inference.space import Space, Tie, Unknown

RUNS, LENGTH, NOISE = 300, 1.2, 1e-3
READINGS = {"heap": 2, "conveyor": 2, "impact": 6}  # 20 targets on two walls
OWN = ("mu_pp", "mu_roll_pp", "e_pp")
WALL = ("mu_pw", "mu_roll_pw", "e_pw")
SE = 0.1
SHARED = 0.05


@dataclass(frozen=True, eq=False)
class Process:
    """A Gaussian process with given length scale, of a smooth response known at some runs."""

    points: Array  # (n, d)
    weights: Array  # (n, M)
    inverse: Array  # (n, n)

    @classmethod
    def of(cls, function: Callable[[Array], Array], inputs: int, seed: int) -> Process:
        """Return the process that saw `function` at space-filling points."""
        points = qmc.Sobol(inputs, seed=seed).random(512)[:RUNS]
        inverse = np.linalg.inv(_kernel(points, points) + NOISE * np.eye(RUNS))
        return cls(points, inverse @ function(points), inverse)

    def predict(self, inputs: Inputs) -> Prediction:
        """Return mean and variance."""
        k = _kernel(inputs.u, self.points)
        mean = k @ self.weights
        variance = np.maximum(1.0 - np.einsum("ij,ij->i", k @ self.inverse, k), 0.0)
        wide = np.repeat(variance[:, None], mean.shape[1], axis=1)
        return Prediction(mean, wide, np.zeros((*mean.shape, 0)))


def _kernel(a: Array, b: Array) -> Array:
    square = np.sum(a**2, axis=1)[:, None] + np.sum(b**2, axis=1) - 2.0 * a @ b.T
    r = np.sqrt(5.0 * np.maximum(square, 0.0)) / LENGTH
    return np.asarray((1.0 + r + r**2 / 3.0) * np.exp(-r))


def response(outputs: int, seed: int) -> Callable[[Array], Array]:
    """Return a smooth response of order 1 with some curvature and interaction."""
    rng = np.random.default_rng(seed)
    slopes, bends = rng.normal(0.0, 1.0, (6, outputs)), rng.normal(0.0, 0.5, (6, outputs))
    return lambda u: np.tanh((u - 0.5) @ slopes) + ((u - 0.5) * np.roll(u, 1, axis=1)) @ bends


def space_of(materials: int) -> Space:
    """Return unknowns of every material, walls tied between materials, and two shared errors."""
    prior = Prior.uniform(0.0, 1.0)
    unknowns = [Unknown(n, f"M{m}", prior) for m in range(materials) for n in (*OWN, *WALL)]
    ties = tuple(
        Tie(name, tuple(6 * m + 3 + k for m in range(materials)))
        for k, name in enumerate(WALL)
        if materials > 1
    )
    shared = [Unknown.shared_error(name) for name in ("balance", "camera")]
    return Space((*unknowns, *shared), ties)


def planted(materials: int, seed: int) -> tuple[Problem, Array]:
    """Return a problem of 20 targets per material, and the values behind its data."""
    rng = np.random.default_rng(seed)
    space = space_of(materials)
    truth = space.draw(1, rng)
    places = []
    for number, (experiment, count) in enumerate((e, c) for e, c in READINGS.items() for _ in "ab"):
        emulator = Process.of(response(count, number), 6, number)
        for material in range(materials):
            sources = tuple(Source(6 * material + k) for k in range(6))
            inputs = np.column_stack([source.of(truth) for source in sources])
            shared = 6 * materials + (0 if experiment == "impact" else 1)
            repeats = response(count, number)(inputs).T + truth[0, shared] * SHARED
            repeats = repeats + SE * math.sqrt(5.0) * rng.standard_normal((count, 5))
            se = repeats.std(axis=1, ddof=1) / math.sqrt(5.0)
            readings = tuple(
                Reading(
                    f"{experiment}{k}", slice(k, k + 1), repeats[k].mean(keepdims=True),
                    se[[k]], 5, ((shared, np.array([SHARED])),),
                )
                for k in range(count)
            )  # fmt: skip
            places.append(Place(f"{experiment} M{material}", emulator, sources, (), readings))
    return Problem(space, tuple(places)), truth[0]


def scaling(sizes: list[int]) -> None:
    """Print time and effective size for growing numbers of materials."""
    print(
        "| materials | targets | unknowns | method | likelihoods | effective | log evidence |",
        end="",
    )
    print(" covered, 90 % | CPU s | wall s |\n|---|---|---|---|---|---|---|---|---|---|")
    for materials in sizes:
        problem, truth = planted(materials, seed=materials)
        wall, cpu = time.perf_counter(), time.process_time()
        found = sample(problem, np.random.default_rng(1))
        wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
        spans = [found.interval(name, 0.9) for name in found.names[: 6 * materials]]
        inside = [s.low <= x <= s.high for s, x in zip(spans, truth, strict=False)]
        told, mark = found.diagnostics, "?" if found.doubt else ""
        print(
            f"| {materials} | {len(problem.readings)} | {problem.space.size} | {told['method']} "
            f"| {told['calls']} | {told['effective_size']:.0f} "
            f"| {found.log_evidence:.2f} +- {found.log_evidence_error:.2f}{mark} "
            f"| {sum(inside)} of {len(inside)} | {cpu:.0f} | {wall:.0f} |",
            flush=True,
        )


def samplers(sizes: list[int], limit: int) -> None:
    """Print evidence, calls and time of every sampler that is installed."""
    print(
        "| unknowns | problem | sampler | log evidence (exact) | likelihoods | CPU s | upper hump |"
    )
    print("|---|---|---|---|---|---|---|")
    for size in sizes:
        for kind in known_evidence.KINDS:
            for name, run in known_evidence.SAMPLERS.items():
                if importlib.util.find_spec(name.partition(":")[0]) is None:
                    continue
                target = known_evidence.Known(kind, size)
                start = time.process_time()
                try:
                    signal.setitimer(signal.ITIMER_PROF, limit)
                    told = run(target)
                    said = f"{told.log_evidence:.2f}{'?' * told.doubted} ({target.truth:.2f})"
                except TimeoutError:
                    told, said = None, f"none in {limit} s"
                finally:
                    signal.setitimer(signal.ITIMER_PROF, 0)
                upper = f"{told.upper:.2f}" if told else "-"
                print(
                    f"| {size} | {kind} | {name.partition(':')[2] or name} | {said} "
                    f"| {target.calls} | {time.process_time() - start:.1f} | {upper} |",
                    flush=True,
                )


def _late(*_: object) -> None:
    raise TimeoutError


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--samplers", action="store_true")
    parser.add_argument("--sizes", type=int, nargs="+", help="materials, or unknowns of samplers")
    parser.add_argument("--limit", type=int, default=120, help="CPU seconds of one sampler")
    given = parser.parse_args()
    signal.signal(signal.SIGPROF, _late)
    if given.samplers:
        samplers(given.sizes or [6, 12, 45], given.limit)
    else:
        scaling(given.sizes or [1, 2, 5, 10])
