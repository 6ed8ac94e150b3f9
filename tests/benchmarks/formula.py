"""A formula in place of the engine: the same observables, in no time."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from benchmarks.peers.apparatus import RANGES, Place
from benchmarks.peers.simulator import Run

NOISE = 0.01


class Formula:
    """Observables that rise and fall with the parameters, with a little noise from the seed."""

    def __init__(self, failing: float = 0.0) -> None:
        self.calls = 0
        self._failing = failing

    def run(self, place: Place, parameters: Mapping[str, float], seed: int) -> Run:
        """Return the observables of one place."""
        self.calls += 1
        rng = np.random.default_rng(seed)
        if rng.random() < self._failing:
            return Run({}, 1e6)
        u = np.array(
            [(parameters.get(n, low) - low) / (high - low) for n, (low, high) in RANGES.items()]
        )
        noise = 1.0 + NOISE * rng.normal(size=4)
        glued, size = place.surface == "glued", place.apparatus.get("pour_grains", 220.0) / 220.0
        wall = 0.0 * u if glued else u
        if place.experiment == "heap":
            values = [25 + 8 * u[0] + 6 * u[1] + 4 * wall[2] + 5 * wall[3] + 0.2 * size]
        elif place.experiment == "conveyor":
            period = place.apparatus.get("period_s", 0.08)
            values = [125 * period * (1 + 0.2 * u[0] - 0.1 * u[1] + 0.3 * wall[2] - 0.1 * wall[3])]
        else:
            e = np.array([1 + u[5] - 0.5 * u[4], 1 - 0.5 * u[5], 1 + u[4] * u[5], 1 + u[5]])
            values = list(np.array([6.0, 1.6, 0.6, 0.2]) * e)  # less than of any grains is poured
        names = {"heap": ["angle_deg"], "conveyor": ["t100_s"]}.get(
            place.experiment, ["m1_g", "m2_g", "m3_g", "m4_g"]
        )
        pairs = zip(names, values, noise[: len(values)], strict=True)
        return Run({n: float(v * x) for n, v, x in pairs}, 1e6)
