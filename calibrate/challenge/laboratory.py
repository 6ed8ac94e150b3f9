"""The laboratory of a suite: the runs behind each measured value, and the study they make."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.candidates import Board
from calibrate.challenge.foreign import FOREIGN
from calibrate.challenge.learnt import Learnt
from calibrate.challenge.truths import Truth
from calibrate.questions.core.forms import Form
from calibrate.questions.core.from_study import form_key, place_of
from calibrate.questions.core.runs import Runs
from calibrate.study.cases import case_spec
from calibrate.study.data import StudyData
from calibrate.study.model import Study
from calibrate.study.places import Place
from calibrate.study.schema.targets import Target
from liggghts_io import CaseSpec

__all__ = ["bench_of", "errors_of", "measured_values", "strengths_at", "study_cases"]

SEEDS: Final = 10_000_000
"""First seed of a suite's data, far from those of designs; a study has a thousand of its own."""
PER_STUDY: Final = 1000
AGAIN: Final = 500
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


def errors_of(
    learnt: Learnt,
    study: Study,
    target: Target,
    repeats: int,
    strengths: Array | None = None,
) -> Array:
    """Return standard errors of a mean on the model scale, (L,).

    Parameters
    ----------
    learnt : Learnt
    study : Study
    target : Target
    repeats : int
    strengths : (k,) float64, optional
        Of the causes that act, in ordinary ones: who repeats an experiment sees how much it
        scatters as it is.
    """
    key = form_key(study, place_of(target))
    emulator = learnt.base.trained[key].emulator
    part = next(p for p in emulator.parts if p.output.name == target.observable)
    noise = np.diag(part.luck)
    for column, strength in enumerate(np.zeros(0) if strengths is None else strengths):
        if strength and column in learnt.wide[key].changes:
            more = learnt.wide[key].changes[column].luck(emulator, float(strength))
            noise = noise + np.diag(more)[part.output.columns]
    return np.asarray(np.sqrt(noise / repeats))


def strengths_at(form: Form, runs: Runs) -> Array:
    """Return the strengths of the causes that act in runs of one place, in ordinary ones, (k,).

    Parameters
    ----------
    form : Form
        Of the study with all effects.
    runs : Runs
        With the same effects on in all of them; those of other apparatus are looked at as if it
        were usual.
    """
    effects = runs.specs[0].effects
    return np.array([effects.get(one.name, 0.0) / one.step for one in form.switches])


def bench_of(learnt: Learnt, data: StudyData, repeats: int) -> Board:
    """Return the board of the suite's study with the errors that its measured values will have."""
    board = learnt.board(data)
    targets = {target.name: target for target in data.study.targets}
    places = []
    for place in board.problem.places:
        readings = []
        for reading in place.readings:
            se = errors_of(learnt, data.study, targets[reading.name], repeats)
            readings.append(replace(reading, se=se, shared=(), repeats=0))
        places.append(replace(place, readings=tuple(readings)))
    return replace(board, problem=replace(board.problem, places=tuple(places)))


def measured_values(runs: Runs, columns: Sequence[str]) -> tuple[Array, int]:
    """Return the means of columns over the runs that gave them all, (L,), and how many these are.

    nan where there is none.
    """
    table = runs.table[runs.table["status"] == "ok"]
    given = table.reindex(columns=list(columns)).to_numpy(float)
    whole = given[np.isfinite(given).all(axis=1)]
    return (whole.mean(axis=0) if len(whole) else np.full(len(columns), np.nan)), len(whole)
