"""The laboratory of a suite: the runs behind each measured value, and the study they make."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.candidates import Board
from calibrate.challenge.foreign import FOREIGN
from calibrate.challenge.learnt import Learnt
from calibrate.challenge.rules import Rules
from calibrate.challenge.truths import Truth
from calibrate.questions.core.from_study import form_key, place_of
from calibrate.questions.core.runs import Runs
from calibrate.study.cases import case_spec
from calibrate.study.data import StudyData
from calibrate.study.model import Study
from calibrate.study.places import Place
from calibrate.study.schema.targets import Target
from liggghts_io import CaseSpec

__all__ = ["Errors", "bench_of", "errors_of", "measured_values", "study_cases"]

SEEDS: Final = 10_000_000
"""First seed of a suite's data, far from those of designs; a study has a thousand of its own."""
PER_STUDY: Final = 1000
AGAIN: Final = 500
USUAL: Final = 4
"""Runs that a laboratory has seen scatter before, for each value."""
OTHER_STEP: Final = 0.1
"""Part of the Rayleigh time, half of the usual step."""
OTHER_WIDTH: Final = {"heap": ("slice_width_d", 3.5), "conveyor": ("width_fraction", 0.16)}
OTHER_SIDE: Final = {"heap": ("mu_side", 0.3), "plate_impact": ("mu_side", 0.4)}


def study_cases(
    data: StudyData, truth: Truth, repeats: int, again: int = 0
) -> dict[Place, list[CaseSpec]]:
    """Return the runs behind the measured values of a study, as they really were, by place.

    Parameters
    ----------
    data : StudyData
    truth : Truth
    repeats : int
        Runs of each experiment.
    again : int
        1 for other seeds.
    """
    study = data.study
    found: dict[Place, list[CaseSpec]] = {}
    # Means and spreads of ties are true, too, but no run has them.
    keys = {key: _key(key) for key in truth.values}
    values = {key: truth.values[k] for k, key in keys.items() if key[0] in study.parameters}
    for number, place in enumerate(study.places):
        # A key without an instance is that of the only one.
        mine = {
            (name, instance or study.layout.instance(name, place) or ""): value
            for (name, instance), value in values.items()
        }
        for repeat in range(repeats):
            seed = SEEDS + PER_STUDY * truth.number + AGAIN * again + repeats * number + repeat
            spec = case_spec(study, place, mine, seed)
            found.setdefault(place, []).append(_as_it_was(study, place, spec, truth))
    return found


def _key(key: str) -> tuple[str, str]:
    name, _, instance = key.partition("[")
    return name, instance.rstrip("]")


def _as_it_was(study: Study, place: Place, spec: CaseSpec, truth: Truth) -> CaseSpec:
    """Return the case of a run with all that nobody knew of."""
    spec = _numerics(spec, truth.numerics)
    effects = dict(spec.effects)
    for one in truth.hidden:
        if one.name in FOREIGN:
            spec = FOREIGN[one.name].acting(spec, one.strength)
            continue
        effect, _, where = one.name.partition(":")
        kind = study.surface_named(place.surface).kind
        here = {f"{place.experiment}_{kind}", place.material, place.surface, ""}
        if where in here and study.layout.acts(effect, place):
            effects[effect] = one.strength
    return replace(spec, effects={**spec.effects, **effects}, engine=truth.engine)


def _numerics(spec: CaseSpec, what: str) -> CaseSpec:
    """Return a case with another time step, width or side wall."""
    change: Mapping[str, float] = {}
    if what == "time_step":
        change = {"timestep_fraction": OTHER_STEP}
    elif what == "width" and spec.experiment in OTHER_WIDTH:
        change = dict([OTHER_WIDTH[spec.experiment]])
    elif what == "side_wall" and spec.experiment in OTHER_SIDE:
        change = dict([OTHER_SIDE[spec.experiment]])
    return replace(spec, apparatus={**spec.apparatus, **change})


@dataclass(frozen=True, eq=False)
class Errors:
    """Errors of a measured value or curve, on the model scale.

    Attributes
    ----------
    own : (L,) float64
        Of each level.
    common : (L, F) float64
        What one run's luck shifts as a whole; F = 0 where nothing is said of it.
    repeats : int
        Measurements that they are told by; 0 where they are said to be known.
    """

    own: Array
    common: Array
    repeats: int = 0


def errors_of(
    learnt: Learnt, study: Study, target: Target, rules: Rules, runs: Array | int
) -> Errors:
    """Return the errors of a mean of runs, as the rules want them stated.

    Parameters
    ----------
    learnt : Learnt
        It knows how much single runs scatter.
    study : Study
    target : Target
    rules : Rules
    runs : (n, L) float64, or int
        What each run gave, on the model scale, a curve at its first levels or all; or only how
        many there are, which scatter as usual.
    """
    trained = learnt.base.trained[form_key(study, place_of(target))]
    part = next(p for p in trained.emulator.parts if p.output.name == target.observable)
    count = runs if isinstance(runs, int) else len(runs)
    told = part.luck.shape[0] if isinstance(runs, int) else runs.shape[1]
    luck = part.luck[:told, :told]
    noise = luck / count
    if rules.errors == "runs":
        own = np.sqrt(np.diag(noise) * _scatter(luck, runs))
        # A curve's luck is one of ten numbers or so: it is nearly told.
        repeats = USUAL + count if len(own) == 1 else 0
        return Errors(own, np.zeros((len(own), 0)), repeats)
    if len(noise) == 1:
        return Errors(np.sqrt(np.diag(noise)), np.zeros((1, 0)))
    return Errors(*_split(noise))


def _scatter(luck: Array, runs: Array | int) -> float:
    """Return the variance of runs over the usual one, of which a laboratory knows `USUAL` more."""
    if isinstance(runs, int):
        return 1.0
    away = runs - runs.mean(axis=0)
    seen = float(np.einsum("il,il->", away @ np.linalg.inv(luck), away)) / len(luck)
    return (USUAL + seen) / (USUAL + len(runs) - 1)


def bench_of(learnt: Learnt, data: StudyData, rules: Rules) -> Board:
    """Return the board of the suite's study with the errors that its measured values will have."""
    board = learnt.board(data)
    targets = {target.name: target for target in data.study.targets}
    places = []
    for place in board.problem.places:
        readings = []
        for reading in place.readings:
            told = errors_of(learnt, data.study, targets[reading.name], rules, rules.repeats)
            extra = told.common if told.common.shape[1] else None
            together = None if extra is not None else reading.together
            readings.append(
                replace(
                    reading, se=told.own, extra=extra, shared=(), repeats=told.repeats,
                    together=together,
                )
            )  # fmt: skip
        places.append(replace(place, readings=tuple(readings)))
    return replace(board, problem=replace(board.problem, places=tuple(places)))


def _split(covariance: Array) -> tuple[Array, Array]:
    """Return a covariance as one common error, the same at all levels, and errors of their own."""
    common = math.sqrt(max(float(np.median(covariance[np.triu_indices(len(covariance), 1)])), 0.0))
    rest = np.diag(covariance) - common**2
    own = np.sqrt(np.maximum(rest, 0.01 * np.diag(covariance)))
    return own, np.full((len(covariance), 1), common)


def measured_values(runs: Runs, columns: Sequence[str]) -> Array:
    """Return what runs gave of the columns, (n, L); n or L may be 0.

    A run may end before a curve has reached its last level: told are the first levels, those that
    every run reached that reached any.
    """
    table = runs.table[runs.table["status"] == "ok"]
    given = table.reindex(columns=list(columns)).to_numpy(float)
    reached = np.cumprod(np.isfinite(given), axis=1).sum(axis=1)
    given = given[reached > 0]
    return np.asarray(given[:, : reached[reached > 0].min(initial=len(columns))])
