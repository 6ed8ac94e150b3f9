"""From a study and the effects registry to a diagnosis problem.

A new effect is one file in `liggghts_io/effects`; it becomes a candidate here without any change,
unless the registry says that it is none.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final

import numpy as np

from calibrate.diagnose.problem import Candidate, Observable, Parameter, Problem
from calibrate.errors import CalibrationError
from calibrate.runs.reuse import Levels, point_of
from calibrate.study.cases import case_spec
from calibrate.study.checks.parameters import KNOWN_SPAN
from calibrate.study.data import StudyData
from calibrate.study.model import Study
from calibrate.study.places import Place
from calibrate.study.schema.settings import Known
from calibrate.study.schema.targets import Target
from liggghts_io.effects import Effect
from liggghts_io.materials import CONTACT_PARAMETERS

# A strength is probed at this many ordinary strengths and judged possible up to twice that.
_PROBE: Final = 3.0
_LIMIT: Final = 6.0


def problem_of(data: StudyData, start: Mapping[str, float]) -> Problem:
    """Describe the diagnosis of a study.

    Parameters
    ----------
    data : StudyData
        The study and what was measured.
    start : mapping
        Value of every contact parameter, usually the staged result.

    Raises
    ------
    CalibrationError
        When a parameter has no start, or the study is one that the diagnosis cannot take yet.
    """
    study, path = data.study, data.path
    _refuse(data)
    needed = [name for name in CONTACT_PARAMETERS if study.instances(name)]
    missing = [name for name in needed if not math.isfinite(start.get(name, math.nan))]
    if missing:
        msg = (
            f"{path}: no start value for {', '.join(missing)}; run 'bulkcal calibrate {path}' "
            "first, or give them a value under [parameter.NAME]"
        )
        raise CalibrationError(msg)
    ranges = _ranges(study)
    parameters = tuple(
        _parameter(name, ranges[name], start[name]) for name in needed if name in ranges
    )
    values = {(name, study.instances(name)[0]): float(start[name]) for name in needed}
    experiments = {key_of(place): case_spec(study, place, values, seed=1) for place in study.places}
    layout = study.layout
    active = {
        key_of(place): tuple(p.name for p in parameters if p.name in layout.acting(place))
        for place in study.places
    }
    return Problem(
        parameters=parameters,
        observables=_observables(data),
        experiments=experiments,
        active=active,
        candidates=_candidates(study),
    )


def key_of(place: Place) -> str:
    """Return what the diagnosis calls a place; it has one material."""
    return f"{place.experiment}_{place.surface}"


def levels_of(study: Study) -> Levels:
    """Return the levels at which the study's curves are compared, by experiment and curve."""
    found: dict[tuple[str, str], tuple[float, ...]] = {}
    for target in study.curves:
        key = target.experiment, target.observable
        levels = target.levels or (target.curve.levels if target.curve else ())
        found[key] = tuple(sorted({*found.get(key, ()), *levels}))
    return found


def _ranges(study: Study) -> dict[str, tuple[float, float]]:
    """Return the ranges of what stages free, or of what is free where there are none."""
    found = {name: study.range_of(name, instance) for name, instance in study.free}
    if study.stages:
        found = {
            name: study.range_of(name, instance, stage)
            for stage in study.stages
            for name, instance in study.freed(stage).items()
        }
    return {name: ends for name, ends in found.items() if ends is not None}


def _refuse(data: StudyData) -> None:
    """Refuse what the diagnosis cannot take yet."""
    study = data.study
    if len(study.materials) > 1:
        names = ", ".join(one.name for one in study.materials)
        msg = f"{data.path}: the diagnosis takes one material by now, and the study has {names}"
        raise CalibrationError(msg)
    for name, ends in _ranges(study).items():
        if name not in CONTACT_PARAMETERS or len(study.instances(name)) > 1:
            what = ", ".join(study.label(name, one) for one in study.instances(name))
            msg = (
                f"{data.path}: {what} free in {ends[0]:g} to {ends[1]:g}: the diagnosis takes "
                "contact parameters with one value each by now; fix it, or take a surface out"
            )
            raise CalibrationError(msg)


def _parameter(name: str, bounds: tuple[float, float], start: float) -> Parameter:
    low, high = bounds
    inside = float(np.clip(start, low, high))
    return Parameter(name, low, high, inside, logarithmic=name.startswith("mu") and low > 0.0)


def _candidates(study: Study) -> tuple[Candidate, ...]:
    found: list[Candidate] = []
    layout = study.layout
    for effect in layout.effects.values():
        if not effect.candidate or any(
            study.value_of(effect.name, *place)
            for place in study.places
            if layout.acts(effect.name, place)
        ):
            continue  # tried on request only, or switched on already: part of the base model
        if not study.materials[0].particle.has(effect.needs):
            continue  # the grains are not known well enough, a size distribution for example
        keys = tuple(key_of(place) for place in study.places if layout.acts(effect.name, place))
        if keys:
            found.append(_candidate(study, effect, effect.name, keys))
        if effect.per_apparatus and len(keys) > 1:
            found += [_candidate(study, effect, f"{effect.name}:{k}", (k,)) for k in keys]
    return tuple(found)


def _candidate(study: Study, effect: Effect, name: str, keys: tuple[str, ...]) -> Candidate:
    upper = min(effect.high, _LIMIT * effect.scale)
    lower = max(effect.low, -_LIMIT * effect.scale)
    # The probing runs stay what they are without an independent measurement.
    step = min(_PROBE * effect.scale, max(upper, -lower))
    known = [study.known_of(effect.name, p) for p in study.places if key_of(p) in keys]
    if known and known[0] is not None:
        lower, upper = _allowed(known[0], lower, upper)
    title = effect.title if name == effect.name else f"{effect.title}, {keys[0]} alone"
    return Candidate(name, effect.name, step, lower, upper, keys, title, effect.settled_by)


def _allowed(known: Known, lower: float, upper: float) -> tuple[float, float]:
    """Limits of a strength that was measured on its own: three standard errors around it."""
    span = KNOWN_SPAN * known.se
    return max(lower, known.value - span), min(upper, known.value + span)


def _observables(data: StudyData) -> tuple[Observable, ...]:
    points = [
        Observable(
            _key_of(target), point_of(target.observable, level), value, se, target.model_scale,
            curve.repeats, on_curve=True,
        )
        for target in data.study.curves
        for curve in (data.curves[target.name],)
        for level, value, se in zip(curve.levels, curve.values, curve.se, strict=True)
    ]  # fmt: skip
    # A curve that holds such a number goes before it: its errors are shared with the others.
    held = {(_key_of(target), target.observable) for target in data.study.curves}
    numbers = [
        Observable(_key_of(t), t.observable, one.value, one.se, t.model_scale, one.repeats)
        for t in data.study.numbers
        for one in (data.scalars[t.name],)
        if (_key_of(t), t.observed.part_of) not in held
    ]
    return tuple([*numbers, *points])


def _key_of(target: Target) -> str:
    return key_of(Place(target.material, target.surface, target.experiment))
