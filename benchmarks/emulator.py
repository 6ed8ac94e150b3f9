"""Compare Gaussian process engines on recorded runs, and measure the emulator's speed.

    python benchmarks/emulator.py [--points 48 96 200] [--only accuracy|effects|speed]

Accuracy: every output of five places (of the conveyor's curves two components), five folds of
points, trained on the first so many of the other points. Q2 is the predicted share of the variance
of runs, z the root mean square of errors in expected sizes, and the log score the mean logarithm of
the predictive density of a run, in nats, of outputs scaled to unit variance: above is better.
"""

from __future__ import annotations

import argparse
import sys
import time
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from calibrate.arrays import Array
from calibrate.emulator.components import components_of
from calibrate.emulator.emulator import train_emulator
from calibrate.emulator.training import train_process
from calibrate.emulator.types import Inputs, Output
from tests.calibrate.emulator.recorded import PLACES, Runs, read_runs
from tests.calibrate.emulator.synthetic import spread_points

Engine = Callable[[Inputs, Array, Inputs], tuple[Array, Array]]
FOLDS = 5


def ours(inputs: Inputs, y: Array, at: Inputs) -> tuple[Array, Array]:
    """Return mean of runs and their variance by this project's process."""
    process = train_process(inputs, y)
    mean, variance = process.predict(at)
    return mean, variance + process.form.noise


def scikit_learn(inputs: Inputs, y: Array, at: Inputs) -> tuple[Array, Array]:
    """Return the same by scikit-learn: Matern 5/2 with a length per input, plane, white noise."""
    from sklearn.gaussian_process import GaussianProcessRegressor
    from sklearn.gaussian_process.kernels import ConstantKernel, DotProduct, Matern, WhiteKernel

    smooth = ConstantKernel(1.0, (1e-4, 1e2)) * Matern(
        np.ones(inputs.u.shape[1]), (0.15, 30.0), nu=2.5
    )
    plane = ConstantKernel(4.0, "fixed") * DotProduct(1.0, "fixed")
    kernel = smooth + plane + WhiteKernel(0.1, (1e-6, 2.0))
    model = GaussianProcessRegressor(
        kernel, n_restarts_optimizer=1, random_state=0, normalize_y=True
    )
    model.fit(inputs.u, y)
    mean, error = model.predict(at.u, return_std=True)
    return mean, error**2  # with the white noise


def smt(inputs: Inputs, y: Array, at: Inputs) -> tuple[Array, Array]:
    """Return the same by smt's Kriging with its own search for lengths and noise."""
    from smt.surrogate_models import KRG

    model = KRG(
        corr="matern52", poly="linear", eval_noise=True, hyper_opt="Cobyla", print_global=False,
        noise_bounds=[1e-6, 1e2], seed=0,
    )  # fmt: skip
    model.set_training_values(inputs.u, y)
    model.train()
    noise = float(np.squeeze(model.optimal_noise)) * float(np.squeeze(model.optimal_par["sigma2"]))
    return model.predict_values(at.u)[:, 0], model.predict_variances(at.u)[:, 0] + noise


ENGINES: dict[str, Engine] = {"ours": ours, "scikit-learn": scikit_learn, "smt": smt}


def numbers(place: str) -> Iterator[tuple[str, Runs, Array]]:
    """Yield name, runs and values of every number of a place."""
    runs = read_runs(place, effects=False)
    if place.startswith("conveyor"):
        runs = runs.rows(np.isfinite(runs.y).all(axis=1))
        scores = components_of(runs.y).scores(runs.y)
        for k in range(2):
            yield f"{place}, component {k + 1}", runs, scores[:, k]
        return
    for output in runs.outputs:
        yield f"{place}, {output.name}", runs, runs.y[:, output.columns.start]


def held_out(engine: Engine, runs: Runs, y: Array, most: int) -> tuple[Array, Array, Array]:
    """Return values, means and variances of all runs, each predicted by other points."""
    points = np.unique(runs.points)
    found = []
    for part in np.array_split(np.random.default_rng(0).permutation(points), FOLDS):
        test = np.isin(runs.points, part)
        train = np.isin(runs.points, np.setdiff1d(points, part)[:most])
        mean, variance = engine(runs.inputs.rows(train), y[train], runs.inputs.rows(test))
        found.append(np.stack([y[test], mean, variance]))
    return tuple(np.hstack(found))  # type: ignore[return-value]


def scores(y: Array, mean: Array, variance: Array) -> dict[str, float]:
    """Return what the table shows of an engine."""
    unit, z = y.var(), (y - mean) / np.sqrt(variance)
    return {
        "Q2": 1.0 - np.mean((y - mean) ** 2) / unit,
        "z": float(np.sqrt(np.mean(z**2))),
        "90 %": float(np.mean(np.abs(z) < 1.645)),
        "log": float(np.mean(-0.5 * np.log(2 * np.pi * variance / unit) - 0.5 * z**2)),
    }


def accuracy(sizes: list[int]) -> None:
    """Print a table of engines for each number of training points."""
    for most in sizes:
        rows = []
        for place in PLACES:
            for name, runs, y in numbers(place):
                row: dict[tuple[str, str], Any] = {("", "output"): name}
                for engine, predict in ENGINES.items():
                    began = time.process_time()
                    found = scores(*held_out(predict, runs, y, most))
                    found["s"] = (time.process_time() - began) / FOLDS
                    row |= {(engine, key): value for key, value in found.items()}
                rows.append(row)
        available = int(len(np.unique(runs.points)) * (1 - 1 / FOLDS))
        table = pd.DataFrame(rows).set_index(("", "output"))
        table.columns = pd.MultiIndex.from_tuples(table.columns)
        table.loc["mean"] = table.mean()
        print(f"\n{min(most, available)} training points\n{table.round(2).to_string()}", flush=True)


def effects() -> None:
    """Print how well the influence of effects is predicted at points that were left out."""
    rows = []
    for place in PLACES:
        runs = read_runs(place)
        runs = runs.rows(np.isfinite(runs.y).all(axis=1))
        with_effect = runs.inputs.strengths.any(axis=1)
        for part in np.array_split(np.unique(runs.points[with_effect]), FOLDS):
            out = np.isin(runs.points, part)
            emulator = train_emulator(runs.inputs.rows(~out), runs.outputs, runs.y[~out])
            for i in np.flatnonzero(out & with_effect):
                on = runs.inputs.rows(np.array([i]))
                off = Inputs(on.u, 0.0 * on.strengths, on.seeds)
                base = np.flatnonzero(
                    (runs.points == runs.points[i]) & (runs.inputs.seeds == on.seeds) & ~with_effect
                )
                rise = emulator.predict(on).mean - emulator.predict(off).mean
                which = runs.effects[int(np.flatnonzero(on.strengths[0])[0])]
                for column in range(0, runs.y.shape[1], 3 if len(runs.outputs) == 1 else 1):
                    rows += [
                        (
                            place,
                            column,
                            which,
                            runs.y[i, column] - runs.y[b, column],
                            rise[0, column],
                        )
                        for b in base
                    ]
    table = pd.DataFrame(rows, columns=["place", "column", "effect", "seen", "predicted"])
    table["missed"] = (table["seen"] - table["predicted"]) ** 2
    table["all"] = table["seen"] ** 2
    sums = table.pivot_table(["missed", "all"], "effect", "place")
    share = (1.0 - sums["missed"] / sums["all"]).round(2)
    print("\npredicted share of an effect's influence (mean square, seed noise included)")
    print(share.to_string(), flush=True)


def speed() -> None:
    """Print CPU times at 500 runs of 9 inputs and 8 outputs."""
    rng = np.random.default_rng(1)
    u = spread_points(500, 9, rng)
    waves = rng.normal(size=(8, 9))
    y = np.column_stack([np.sin(2 * u @ w) + 0.3 * (u @ w) ** 2 for w in waves])
    y += 0.1 * rng.standard_normal(y.shape)
    outputs = [Output(f"y{k}", slice(k, k + 1)) for k in range(8)]
    inputs = Inputs(u, np.zeros((500, 0)), np.arange(500.0))
    wall, cpu = time.monotonic(), time.process_time()
    emulator = train_emulator(inputs, outputs, y)
    print(f"\ntraining, 8 outputs: {time.process_time() - cpu:.1f} s CPU, "
          f"{time.monotonic() - wall:.1f} s wall")  # fmt: skip
    one = train_emulator(inputs, outputs[:1], y[:, :1])
    for n in (1, 10, 100, 1000, 10000):
        at, times = Inputs.at(rng.random((n, 9))), max(1, 3000 // n)
        for name, asked in (("8 outputs", emulator), ("1 output", one)):
            asked.predict(at)
            wall, cpu = time.monotonic(), time.process_time()
            for _ in range(times):
                asked.predict(at)
            cpu, wall = time.process_time() - cpu, time.monotonic() - wall
            print(f"{n:6d} predictions of {name:9s}: {1e3 * cpu / times:8.2f} ms CPU, "
                  f"{1e3 * wall / times:8.2f} ms wall", flush=True)  # fmt: skip


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--points", type=int, nargs="+", default=[48, 96, 200])
    parser.add_argument("--only", choices=["accuracy", "effects", "speed"])
    asked = parser.parse_args()
    # scikit-learn and smt announce lengths at their limits and their choice of optimiser.
    warnings.simplefilter("ignore")
    if asked.only in (None, "accuracy"):
        accuracy(asked.points)
    if asked.only in (None, "effects"):
        effects()
    if asked.only in (None, "speed"):
        speed()
