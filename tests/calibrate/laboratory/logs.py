"""Logs of a scale whose truth is known: grains that arrive one by one, and what disturbs them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from calibrate.laboratory.instrument.quantities import MASS
from calibrate.laboratory.instrument.series import Series
from calibrate.laboratory.scale.clean import cleaned
from calibrate.laboratory.scale.curve import MassCurve, mass_curve

GRAIN_G = 0.0076
TOTAL_G = 300.0


@dataclass(frozen=True)
class Truth:
    """What is behind a log: arrival of every grain after the funnel was opened."""

    arrivals: np.ndarray
    onset: float
    slope: float

    def time_to(self, mass_g: float) -> float:
        """Return when that mass lies on the scale."""
        return float(self.arrivals[round(mass_g / GRAIN_G) - 1])


def series(time, mass, *, tick_s=0.001, tick=0.01, path="run.csv") -> Series:
    places = tuple(f"{path}:{k}" for k in range(2, len(time) + 2))
    time, mass = np.asarray(time, dtype=float), np.asarray(mass, dtype=float)
    return Series(Path(path), MASS, time, mass, places, stamped=False, tick_s=tick_s, tick=tick)


def flow(
    rng, *, rate=10.0, noise=0.02, tick=0.01, drift=0.0, tare=0.0, bumps=0, length=30.0, jitter=0.6,
    slope=19.0, onset=4.7,
) -> tuple[Series, Truth]:  # fmt: skip
    """Return a log from the opening of the funnel on, and its truth."""
    time = np.arange(0.0, length, 1.0 / rate)
    time = np.sort(np.abs(time + rng.uniform(-0.5, 0.5, len(time)) * jitter / rate))
    arrivals = onset + np.cumsum(rng.exponential(GRAIN_G / slope, round(TOTAL_G / GRAIN_G)))
    mass = GRAIN_G * np.searchsorted(arrivals, time, side="right")
    mass = mass + tare + drift * time + noise * rng.standard_normal(len(time))
    for _ in range(bumps):
        k = int(rng.integers(len(time) - 1))
        count = 1 + int(rng.uniform(0.0, 0.35) * rate)
        mass[k : k + count] += rng.choice([-1.0, 1.0]) * rng.uniform(5.0, 80.0)
    return series(np.round(time, 3), np.round(mass / tick) * tick, tick=tick), Truth(
        arrivals, onset, slope
    )


def curve_of(log: Series, opened_s: float = 0.0) -> MassCurve:
    return mass_curve(log, cleaned(log), opened_s)


def written(path: Path, log: Series) -> Path:
    """Write a log as a plain CSV file."""
    rows = [f"{t:.3f},{m:.3f}" for t, m in zip(log.time_s, log.values, strict=True)]
    path.write_text("\n".join(["time [s],mass [g]", *rows, ""]), encoding="utf-8")
    return path
