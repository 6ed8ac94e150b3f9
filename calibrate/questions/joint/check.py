"""Final check: the engine itself at the optimum and at draws from the posterior."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.inference.discrepancy import discrepancy_probabilities
from calibrate.inference.likelihood import log_likelihood
from calibrate.inference.problem import Place as Seen
from calibrate.inference.problem import Problem, Reading
from calibrate.questions.core.design import CHECK_SEED, Stand, case_at, stands_of
from calibrate.questions.core.emulate import Emulators, training_arrays
from calibrate.questions.core.problem import inputs_at, place_name
from calibrate.questions.core.runs import Runs
from calibrate.scales import backward, slope
from calibrate.significance import joint_dof, normal_score
from calibrate.study.model import Study
from calibrate.study.schema.targets import Target
from liggghts_io import CaseSpec

__all__ = ["CheckRow", "behind", "check_cases", "check_rows", "checked_z", "runs_at"]

NOT_MET: Final = 0.5
"""Probability from which a target counts as one that the simulation cannot meet."""
DRAW_SEEDS: Final = 10_000
"""Seeds of the runs at posterior draws follow those at the optimum after so many."""


@dataclass(frozen=True)
class CheckRow:
    """Measured, simulated and predicted value of one target.

    Attributes
    ----------
    name, label, unit : str
        As in the study.
    level : float
        Of a curve, where it disagrees most; nan for a number.
    measured, measured_se : float
    repeats : int
        Measurements behind that error; 0 where it counts as known.
    simulated, simulated_se : float
        Mean of the engine's runs at the optimum; nan when all failed. The error comes from the
        noise that all runs of the experiment have shown.
    seeds : int
        Runs behind the mean.
    predicted, predicted_sd : float
        What the posterior says of the expected value, emulator error included.
    z : float
        Simulated minus measured, in standard errors of both, as a normal deviate.
    error_ratio : float
        Emulator's variance over the measurement's at the optimum.
    discrepancy : float
        Probability that the simulation misses it for a reason that is not in it.
    """

    name: str
    label: str
    unit: str
    level: float
    measured: float
    measured_se: float
    repeats: int
    simulated: float
    simulated_se: float
    seeds: int
    predicted: float
    predicted_sd: float
    z: float
    error_ratio: float
    discrepancy: float = 0.0

    @property
    def met(self) -> bool:
        """Whether the simulation can meet it together with the other targets, as far as known."""
        return self.discrepancy < NOT_MET


def check_cases(
    study: Study,
    problem: Problem,
    emulators: Emulators,
    values: Array,
    first_seed: int | None = None,
) -> list[CaseSpec]:
    """Return the cases of the final check, each once.

    Parameters
    ----------
    study : Study
        It says how many seeds at the optimum.
    problem : Problem
    emulators : Emulators
    values : (n, K) float64
        The optimum, then draws from the posterior; these are run with one seed each.
    first_seed : int, optional
        Of the runs at the optimum; that of the final check where it is left out.
    """
    seen = {place.name: place for place in problem.places}
    forms = {key: one.form for key, one in emulators.trained.items()}
    first = study.run.seed + CHECK_SEED if first_seed is None else first_seed
    found: dict[str, CaseSpec] = {}
    for stand in stands_of(study, forms):
        for place in stand.places:
            inputs = inputs_at(seen[place_name(place)], values)
            for row in range(len(values)):
                seeds = study.design.check_seeds if row == 0 else 1
                offset = 0 if row == 0 else DRAW_SEEDS + row
                for seed in range(seeds):
                    u, strengths = inputs.u[row], inputs.strengths[row]
                    spec = case_at(study, stand, u, strengths, first + offset + seed)
                    found.setdefault(repr(spec), spec)
    return list(found.values())


def checked_z(emulators: Emulators, fresh: Runs) -> Array:
    """Return how far runs lie from what emulators expected that had not seen them.

    Parameters
    ----------
    emulators : Emulators
        Without the runs.
    fresh : Runs

    Returns
    -------
    (m,) float64
        Seen minus expected in standard deviations of both emulator and noise, all outputs.
    """
    found = [np.empty(0)]
    for one in emulators.trained.values():
        inputs, y = training_arrays(one.form, fresh)
        if len(y):
            expected = one.emulator.predict(inputs)
            z = (y - expected.mean) / np.sqrt(expected.total + one.emulator.noise)
            found.append(z[np.isfinite(z)])
    return np.concatenate(found)


def check_rows(
    study: Study, problem: Problem, emulators: Emulators, runs: Runs, best: Array, draws: Array
) -> tuple[CheckRow, ...]:
    """Return a row for every target that was used.

    Parameters
    ----------
    study : Study
    problem : Problem
    emulators : Emulators
    runs : Runs
        Those at the optimum are found among them.
    best : (K,) float64
    draws : (n, K) float64
        From the posterior.
    """
    found = []
    for stand, here, mine in runs_at(study, problem, emulators, runs, best):
        noise = emulators.trained[stand.form.key].emulator.noise
        odds = discrepancy_probabilities(here, draws).mean(axis=0)
        for reading, odd in zip(here.readings, odds, strict=True):
            output = next(o for o in stand.form.outputs if o.columns == reading.columns)
            seen_at = _At(here, reading, output.levels, noise, float(odd))
            target = study.target_named(reading.name)
            found.append(_row(target, seen_at, mine[:, reading.columns], best, draws))
    order = [target.name for target in study.targets]
    return tuple(sorted(found, key=lambda row: order.index(row.name)))


def runs_at(
    study: Study, problem: Problem, emulators: Emulators, runs: Runs, values: Array
) -> Iterator[tuple[Stand, Seen, Array]]:
    """Yield every place with its outputs in the runs that were made there at values (K,)."""
    forms = {key: one.form for key, one in emulators.trained.items()}
    seen = {place.name: place for place in problem.places}
    for stand in stands_of(study, forms):
        inputs, y = training_arrays(stand.form, runs)
        for place in stand.places:
            here = seen[place_name(place)]
            at = inputs_at(here, values[None])
            off = np.abs(inputs.u - at.u).max(axis=1, initial=0.0)
            off = np.maximum(off, np.abs(inputs.strengths - at.strengths).max(axis=1, initial=0.0))
            yield stand, here, y[off < 1e-8]


def behind(problem: Problem, values: Array, others: Array) -> float:
    """Return by how many nats of posterior density values (K,) lie behind others (K,)."""
    both = np.vstack([values, others])
    found = log_likelihood(problem, both) + problem.space.log_density(both)
    return float(found[1] - found[0])


@dataclass(frozen=True)
class _At:
    """A reading where it was made.

    Attributes
    ----------
    place : Seen
    reading : Reading
    levels : tuple of float
        Of a curve.
    noise : (M,) float64
        Variance of one run, all outputs of the place.
    discrepancy : float
        Probability that the simulation misses the reading.
    """

    place: Seen
    reading: Reading
    levels: tuple[float, ...]
    noise: Array
    discrepancy: float


def _row(target: Target, at: _At, y: Array, best: Array, draws: Array) -> CheckRow:
    """Return the row of one target; `y` are the runs at the optimum, (seeds, L)."""
    reading, columns = at.reading, at.reading.columns
    good = y[np.isfinite(y).all(axis=1)]
    mean = good.mean(axis=0) if len(good) else np.full(len(reading.y), np.nan)
    error = np.sqrt(at.noise[columns] / len(good)) if len(good) else np.full(len(mean), np.nan)
    z = _scores(mean - reading.y, reading.se, error, reading.repeats)
    k = int(np.argmax(np.abs(np.nan_to_num(z))))
    expected, there = at.place.predict(draws).columns(columns), at.place.predict(best[None])
    spread = np.sqrt(expected.mean.var(axis=0) + expected.total.mean(axis=0))
    measured = _plain(target, reading.y[k], reading.se[k])
    simulated = _plain(target, mean[k], error[k])
    predicted = _plain(target, expected.mean[:, k].mean(), spread[k])
    return CheckRow(
        name=target.name,
        label=target.label,
        unit=target.simulated_unit,
        level=at.levels[k] if at.levels else float("nan"),
        measured=measured[0],
        measured_se=measured[1],
        repeats=reading.repeats,
        simulated=simulated[0],
        simulated_se=simulated[1],
        seeds=len(good),
        predicted=predicted[0],
        predicted_sd=predicted[1],
        z=float(z[k]),
        error_ratio=float(np.mean(there.total[0, columns] / reading.se**2)),
        discrepancy=at.discrepancy,
    )


def _plain(target: Target, value: float, sd: float) -> tuple[float, float]:
    """Return a value and its error off the model scale."""
    natural = float(backward(target.model_scale, np.array(value)))
    if not np.isfinite(natural):
        return natural, float("nan")
    return natural, float(sd) / slope(target.model_scale, natural)


def _scores(difference: Array, se: Array, other: Array, repeats: int) -> Array:
    """Return differences in standard errors, as normal deviates of equal probability.

    The error of few repeats is uncertain itself; the other one, of all runs together, is known.
    """
    known = repeats - 1.0 if repeats > 1 else math.inf
    return np.array([
        normal_score(off / math.hypot(own, error), joint_dof((own, known), (error, math.inf)))
        for off, own, error in zip(difference, se, other, strict=True)
    ])  # fmt: skip
