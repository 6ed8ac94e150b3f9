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
from calibrate.study.cases import case_spec
from calibrate.study.checks import KNOWN_SPAN
from calibrate.study.curves import CURVE_SCALE, CURVE_TIMES, times_of
from calibrate.study.data import StudyData
from calibrate.study.model import Known, Study
from liggghts_io import CaseSpec
from liggghts_io.effects import EFFECTS, Effect
from liggghts_io.materials import CONTACT_PARAMETERS, GLUED, GLUED_PARAMETERS

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
        When a parameter has no start.
    """
    study, path = data.study, data.path
    missing = [name for name in CONTACT_PARAMETERS if not math.isfinite(start.get(name, math.nan))]
    if missing:
        msg = (
            f"{path}: no start value for {', '.join(missing)}; run 'bulkcal calibrate {path}' "
            "first, or give the values under [fixed]"
        )
        raise CalibrationError(msg)
    ranges = {name: pair for stage in study.stage for name, pair in stage.free.items()}
    parameters = tuple(
        _parameter(name, ranges[name], start[name]) for name in CONTACT_PARAMETERS if name in ranges
    )
    pairs = [(t.experiment, t.surface) for t in study.target]
    pairs += [(c.experiment, c.surface) for c in study.curve]
    values = {name: float(start[name]) for name in CONTACT_PARAMETERS}
    experiments = {f"{e}_{s}": case_spec(study, (e, s), values, seed=1) for e, s in pairs}
    active = {
        key: tuple(p.name for p in parameters if p.name in _acting(spec.surface))
        for key, spec in experiments.items()
    }
    return Problem(
        parameters=parameters,
        observables=_observables(data),
        experiments=experiments,
        active=active,
        candidates=_candidates(study, experiments),
    )


def _acting(surface: str) -> tuple[str, ...]:
    """Contact parameters that matter on a surface; a glued wall has the grains' own."""
    return GLUED_PARAMETERS if surface == GLUED else CONTACT_PARAMETERS


def _parameter(name: str, bounds: tuple[float, float], start: float) -> Parameter:
    low, high = bounds
    inside = float(np.clip(start, low, high))
    return Parameter(name, low, high, inside, logarithmic=name.startswith("mu") and low > 0.0)


def _candidates(study: Study, experiments: Mapping[str, CaseSpec]) -> tuple[Candidate, ...]:
    found: list[Candidate] = []
    for effect in EFFECTS.values():
        if not effect.candidate or study.effects.get(effect.name, 0.0) != 0.0:
            continue  # tried on request only, or switched on already: part of the base model
        if not study.bulk.particle.has(effect.needs):
            continue  # the grains are not known well enough, a size distribution for example
        keys = tuple(k for k, s in experiments.items() if effect.acts_in(s.experiment))
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
    if effect.name in study.known:
        lower, upper = _allowed(study.known[effect.name], lower, upper)
    title = effect.title if name == effect.name else f"{effect.title}, {keys[0]} alone"
    return Candidate(name, effect.name, step, lower, upper, keys, title, effect.settled_by)


def _allowed(known: Known, lower: float, upper: float) -> tuple[float, float]:
    """Limits of a strength that was measured on its own: three standard errors around it."""
    span = KNOWN_SPAN * known.sem
    return max(lower, known.value - span), min(upper, known.value + span)


def _observables(data: StudyData) -> tuple[Observable, ...]:
    curves = {f"{c.experiment}_{c.surface}": data.curves[c.name] for c in data.study.curve}
    found = []
    for target in data.study.target:
        key = f"{target.experiment}_{target.surface}"
        if key in curves and target.observable in CURVE_TIMES:
            continue  # the curve holds this point, and its errors are shared with the others
        one = data.measured[target.name]
        found.append(
            Observable(key, target.observable, one.value, one.sem, target.scale, one.repeats)
        )
    for key, curve in curves.items():
        found += [
            Observable(
                key, one.name, one.time_s, one.sem_s, CURVE_SCALE, curve.repeats, on_curve=True
            )
            for one in times_of(curve)
        ]
    return tuple(found)
