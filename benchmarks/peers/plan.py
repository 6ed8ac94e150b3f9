"""What the comparison costs, and whether the reduced apparatus still answers to the parameters."""

from __future__ import annotations

import time
from typing import Final

import numpy as np
from scipy.stats import qmc

from benchmarks.peers.apparatus import KEPT_BACK, PLACES, RANGES, TARGETS, UNSEEN
from benchmarks.peers.campaign import BUDGETS, CHECK_SEEDS, TRUTHS
from benchmarks.peers.problem import Array, observed
from benchmarks.peers.simulator import Engine
from benchmarks.peers.truths import SEEDS

PROBES: Final = 4
POINTS: Final = 32


def print_plan(engine: Engine, methods: int) -> None:
    """Print runs, particle-steps and hours of this machine for the whole comparison."""
    seconds, steps = {}, {}
    for name, place in {**KEPT_BACK, **PLACES}.items():
        engine.run(place, _parameters(0.5 * np.ones(len(RANGES))), 1)  # kernels are loaded
        began, spent = time.process_time(), 0.0
        for k in range(PROBES):
            spent += engine.run(place, _parameters(_points(PROBES)[k]), _fresh()).particle_steps
        seconds[name] = (time.process_time() - began) / PROBES
        steps[name] = spent / PROBES
        print(f"{name:40s} {seconds[name]:6.2f} s  {steps[name]:10.3g} particle-steps")
    fit = sum(seconds[name] for name in PLACES)
    unseen = sum(seconds.values()) - fit
    # A Latin hypercube is a study of its own at each budget; all others go through the checkpoints.
    thetas = sum(BUDGETS) + (methods - 2) * max(BUDGETS)
    answers = (methods - 1) * len(BUDGETS) + 1
    truth = SEEDS * (fit + unseen) + thetas * fit + answers * CHECK_SEEDS * unseen
    print(f"one parameter vector at all places: {fit:.2f} s, "
          f"{sum(steps[name] for name in PLACES):.3g} particle-steps")  # fmt: skip
    print(f"{TRUTHS} truths, {methods} methods: {truth * TRUTHS / 3600.0:.1f} h of one core")


def print_sensitivity(engine: Engine) -> None:
    """Print slopes over the whole ranges, seed noise and linear R2 of every observable."""
    unit = _points(POINTS)
    places = {**PLACES, **KEPT_BACK}
    rows = [
        [
            {name: engine.run(place, _parameters(u), seed).observables
             for name, place in places.items()}
            for seed in (1, 2)
        ]
        for u in unit
    ]  # fmt: skip
    print(
        f"{'':20s} {'least':>7s} {'most':>7s} {'noise':>6s} {'R2':>5s}  slopes: {' '.join(RANGES)}"
    )
    for label, target in {**TARGETS, **UNSEEN}.items():
        y = np.array([[observed(seen, [target])[0] for seen in pair] for pair in rows])
        whole = np.isfinite(y).all(axis=1)
        mean, noise = y[whole].mean(axis=1), np.sqrt(np.mean(np.diff(y[whole], axis=1) ** 2) / 2.0)
        trend = np.column_stack([np.ones(whole.sum()), unit[whole] - 0.5])
        slopes, *_ = np.linalg.lstsq(trend, mean, rcond=None)
        r2 = 1.0 - np.var(mean - trend @ slopes) / np.var(mean)
        print(f"{label:20s} {mean.min():7.2f} {mean.max():7.2f} {noise:6.3f} {r2:5.2f}  "
              + " ".join(f"{s:7.2f}" for s in slopes[1:])
              + (f"  {POINTS - whole.sum()} failed" if not whole.all() else ""))  # fmt: skip


def _points(count: int) -> Array:
    return np.asarray(qmc.Sobol(len(RANGES), rng=np.random.default_rng(1)).random(count))


def _parameters(u: Array) -> dict[str, float]:
    return {
        name: float(low + (high - low) * x)
        for (name, (low, high)), x in zip(RANGES.items(), u, strict=True)
    }


def _fresh() -> int:
    """Return a seed that no stored run has, so that the probe takes its time."""
    return int(time.time_ns() % 2_000_000_000) + 1
