"""Boards on the recorded engine runs of HSP13: emulators, candidates, data planted or measured."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.candidates import Candidate, shifts_of
from calibrate.causes.hypotheses import Board
from calibrate.emulator.emulator import TrainedEmulator, train_emulator
from calibrate.emulator.process import Runs as ProcessRuns
from calibrate.emulator.process import condition
from calibrate.emulator.types import Inputs
from calibrate.inference.priors import Prior
from calibrate.inference.problem import Place, Problem, Reading, Source
from calibrate.inference.space import Space, Unknown
from calibrate.scales import Scale, forward, slope
from liggghts_io.effects import EFFECTS
from tests.calibrate.emulator.recorded import PLACES, RANGES, Runs, read_runs

ERRORS: Final = {"heap steel": 0.16, "heap glued": 0.61, "conveyor steel": 0.006,
                 "conveyor glued": 0.006, "plate impact": 0.02}  # fmt: skip
"""Standard errors on the model scale, about those of the paper's tables."""
PAPER: Final[dict[str, tuple[tuple[str, float, float, int, Scale], ...]]] = {
    "heap steel": (("angle_steel", 34.10, 0.16, 15, "linear"),),
    "heap glued": (("angle_glued", 38.28, 0.61, 5, "linear"),),
    "conveyor steel": (("t100_steel", 10.13, 0.06, 5, "log"),),
    "conveyor glued": (("t100_glued", 17.90, 0.02, 5, "log"),),
    "plate impact": (
        ("m1_steel", 30.21, 0.15, 0, "sqrt"),
        ("m2_steel", 8.50, 0.09, 0, "sqrt"),
        ("m3_steel", 2.74, 0.04, 0, "sqrt"),
        ("m4_steel", 0.55, 0.03, 0, "sqrt"),
    ),
}
"""Carbo HSP13 on steel: value, standard error, repeats, scale (the tables of cases/proppants)."""
END: Final = 9  # column of the time for 100 g


@dataclass(frozen=True)
class Bench:
    """One place with its runs and its emulator.

    Attributes
    ----------
    name : str
    runs : Runs
    emulator : TrainedEmulator
    """

    name: str
    runs: Runs
    emulator: TrainedEmulator


def benches(keep: Mapping[str, Array] | None = None) -> dict[str, Bench]:
    """Return every place with an emulator of its runs, or of those that a mask keeps."""
    found = {}
    for name in PLACES:
        runs = read_runs(name)
        some = runs if keep is None else runs.rows(keep[name])
        found[name] = Bench(name, runs, train_emulator(some.inputs, some.outputs, some.y))
    return found


def conditioned(bench: Bench, keep: Array) -> Bench:
    """Return a bench whose emulator has seen some of the runs, hyperparameters held.

    Parameters
    ----------
    bench : Bench
        Trained on all of its runs.
    keep : (n,) bool
        Of `bench.runs`. Scales, components and hyperparameters stay those of all runs.
    """
    kept = {tuple(u) for u in bench.runs.inputs.u[keep]}
    parts = []
    for part in bench.emulator.parts:
        rows = np.array([tuple(u) in kept for u in part.inputs.u])
        inputs, y = part.inputs.rows(rows), part.y[rows]
        processes = tuple(
            condition(one.form, ProcessRuns(inputs, score, one.runs.believed[rows]))
            for one, score in zip(part.processes, part.components.scores(y).T, strict=True)
        )
        parts.append(replace(part, processes=processes, inputs=inputs, y=y))
    return replace(bench, emulator=replace(bench.emulator, parts=tuple(parts)))


def _unknowns() -> tuple[Unknown, ...]:
    return tuple(
        Unknown(n, "", Prior.uniform(lo, hi, "log" if n.startswith("mu") else "linear"))
        for n, (lo, hi) in RANGES.items()
    )


def _place(bench: Bench, readings: tuple[Reading, ...]) -> Place:
    names = list(RANGES)
    u = tuple(
        Source(names.index(n), 0.0, *RANGES[n], "log" if n.startswith("mu") else "linear")
        for n in bench.runs.parameters
    )
    return Place(bench.name, bench.emulator, u, (Source(),) * len(bench.runs.effects), readings)


def candidates_of(
    found: Mapping[str, Bench], effects: tuple[str, ...] | None = None
) -> tuple[Candidate, ...]:
    """Return every recorded effect, and those of one apparatus alone where they may be."""
    order = list(found.values())
    rows = []
    for effect in effects or tuple(EFFECTS):
        one = EFFECTS[effect]
        acts = [(k, b.runs.effects.index(effect)) for k, b in enumerate(order)
                if effect in b.runs.effects]  # fmt: skip
        limits = (one.low, one.high)
        rows.append(Candidate.of_effect(effect, one.scale, limits, acts))
        if one.per_apparatus:
            rows += [
                Candidate.of_effect(effect, one.scale, limits, [at], order[at[0]].name)
                for at in acts
            ]
    return tuple(rows)


def board_of(
    found: Mapping[str, Bench],
    readings: Mapping[str, tuple[Reading, ...]],
    candidates: tuple[Candidate, ...],
) -> Board:
    """Return what a diagnosis of these readings needs."""
    places = tuple(_place(one, readings[name]) for name, one in found.items())
    problem = Problem(Space(_unknowns()), places)
    return Board(problem, candidates, shifts_of(problem, np.random.default_rng(0)), {})


def readings_of(
    values: Mapping[str, Array],
    *,
    curves: bool,
    repeats: int = 5,
    noise: Mapping[str, Array] | None = None,
) -> dict[str, tuple[Reading, ...]]:
    """Return readings from values of all outputs of each place, on the model scale.

    Parameters
    ----------
    values : mapping
    curves : bool
        Whether the mass-time curves are read as a whole, else their last point.
    repeats : int
    noise : mapping, optional
        Variance of a single run, where the values are those of one run instead of expected ones;
        that of a curve is common to its points.
    """
    found = {}
    for name, y in values.items():
        columns = [slice(k, k + 1) for k in range(len(y))]
        if name.startswith("conveyor"):
            columns = [slice(0, len(y))] if curves else [slice(END, END + 1)]
        found[name] = tuple(
            Reading(
                f"{name} {c.start}" if len(columns) > 1 else name,
                c,
                y[c],
                np.full(c.stop - c.start, ERRORS[name]),
                repeats,
                extra=None if noise is None else np.sqrt(noise[name][c])[:, None],
            )
            for c in columns
        )
    return found


def paper_readings() -> dict[str, tuple[Reading, ...]]:
    """Return the paper's eight numbers of HSP13 on steel, on their model scales."""
    return {
        name: tuple(
            Reading(
                target,
                slice(END, END + 1) if name.startswith("conveyor") else slice(k, k + 1),
                forward(scale, np.array([value])),
                np.array([se * slope(scale, value)]),
                repeats,
            )
            for k, (target, value, se, repeats, scale) in enumerate(rows)
        )
        for name, rows in PAPER.items()
    }


def paper_scales() -> dict[str, Scale]:
    """Return the scale of each of the paper's numbers."""
    return {target: scale for rows in PAPER.values() for target, *_, scale in rows}


def planted(
    found: Mapping[str, Bench],
    u: Array,
    strengths: Mapping[str, float],
    rng: np.random.Generator,
) -> dict[str, Array]:
    """Return values that the emulators and the errors of the bench give at a point.

    Parameters
    ----------
    found : mapping
    u : (6,) float64
        Parameters on [0, 1].
    strengths : mapping
        Effect and strength in ordinary strengths.
    rng : Generator
    """
    values = {}
    for name, one in found.items():
        mine = [list(RANGES).index(n) for n in one.runs.parameters]
        on = np.array([[strengths.get(e, 0.0) for e in one.runs.effects]])
        mean = one.emulator.predict(Inputs.at(u[None, mine], on)).mean[0]
        luck = (
            rng.standard_normal(1)
            if name.startswith("conveyor")
            else rng.standard_normal(len(mean))
        )
        values[name] = mean + ERRORS[name] * luck
    return values
