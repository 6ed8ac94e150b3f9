"""From a study, its data and its emulators to one problem of inference."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from calibrate.arrays import Array
from calibrate.emulator.types import Emulator, Inputs
from calibrate.inference.priors import Prior
from calibrate.inference.problem import Known, Problem, Reading, Source, together_as_runs
from calibrate.inference.problem import Place as Seen
from calibrate.inference.space import Space, Tie, Unknown
from calibrate.questions.core.forms import PARTICLE_FIELDS, Axis, Form, FormKey, Switch
from calibrate.questions.core.from_study import form_key, levels_of, particle_of_place, place_of
from calibrate.scales import forward, slope
from calibrate.study.data import StudyData
from calibrate.study.model import Study
from calibrate.study.places import Place
from calibrate.study.schema.settings import Shared
from calibrate.study.schema.targets import Target
from calibrate.study.units import factor

__all__ = [
    "error_name",
    "inputs_at",
    "joins",
    "place_name",
    "prior_of",
    "problem_of",
    "reading_of",
    "readings_left_out",
    "seen_at",
    "space_of",
    "unknown_at",
]


def place_name(place: Place) -> str:
    """Return a place in words.

    Examples
    --------
    >>> place_name(Place("HSP13", "steel", "heap"))
    'heap of HSP13 on steel'
    """
    return f"{place.experiment} of {place.material} on {place.surface}"


def space_of(study: Study) -> Space:
    """Return everything that is unknown: free parameters by instance, ties, shared errors.

    An error of one target alone is part of its covariance instead: the same, with one unknown less.
    """
    keys = list(study.free)
    unknowns = [
        Unknown(
            name,
            _shown(study, name, instance),
            prior_of(study, name, study.range_of(name, instance)),
            study.label(name, instance),
        )
        for name, instance in keys
    ]
    unknowns += [Unknown.shared_error(error_name(one)) for one in study.shared if joins(study, one)]
    ties = []
    for name in dict.fromkeys(name for name, _ in keys):
        for group in study.ties(name):
            members = tuple(keys.index((name, one)) for one in group if (name, one) in keys)
            if len(members) > 1:
                ties.append(Tie(_tie_name(name, group), members))
    return Space(tuple(unknowns), tuple(ties))


def error_name(shared: Shared) -> str:
    """Return the name of the unknown that an error in common is."""
    return f"error of {shared.name}"


def joins(study: Study, shared: Shared) -> bool:
    """Whether more than one of a study's targets have an error: else it is a part of their own."""
    return sum(target.name in shared.targets for target in study.targets) > 1


def _tie_name(name: str, group: Sequence[str]) -> str:
    """Return the name of a tie: the parameter, and what its instances have in common.

    Examples
    --------
    >>> _tie_name("mu_pw", ["A/steel", "B/steel"]), _tie_name("mu_pp", ["A", "B"])
    ('mu_pw[steel]', 'mu_pp')
    """
    parts = [set(one.split("/")) for one in group]
    common = sorted(set.intersection(*parts))
    return f"{name}[{common[0]}]" if common else name


def _shown(study: Study, name: str, instance: str) -> str:
    """Return the instance of an unknown, empty where there is one only."""
    return instance if len(study.instances(name)) > 1 else ""


def unknown_at(study: Study, name: str, place: Place) -> str | None:
    """Return the key of the unknown that a parameter is at a place; None where it is a number."""
    instance = study.layout.instance(name, place)
    if instance is None or study.range_of(name, instance) is None:
        return None
    shown = _shown(study, name, instance)
    return f"{name}[{shown}]" if shown else name


def prior_of(study: Study, name: str, span: tuple[float, float] | None) -> Prior:
    """Return what is believed of a parameter before the data, inside a range."""
    parameter = study.parameters[name]
    low, high = span if span is not None else (0.0, 0.0)
    if parameter.prior.normal is not None:
        mean, sd = parameter.prior.normal
        return Prior.normal(mean, sd, low, high, parameter.spacing)
    if parameter.prior.half_normal is not None:
        return Prior.half_normal(parameter.prior.half_normal, low, high, parameter.spacing)
    return Prior.uniform(low, high, parameter.spacing)


def problem_of(
    data: StudyData, forms: Mapping[FormKey, Form], emulators: Mapping[FormKey, Emulator]
) -> Problem:
    """Return the problem of a study.

    Parameters
    ----------
    data : StudyData
    forms : mapping
        From `forms_of`.
    emulators : mapping
        Emulator by form.
    """
    study = data.study
    space = space_of(study)
    skipped = readings_left_out(study)
    places = []
    for place in study.places:
        key = form_key(study, place)
        here = [t for t in study.targets if place_of(t) == place and t.name not in skipped]
        read = (reading_of(data, one, _columns(data, forms[key], one), space) for one in here)
        readings = tuple(together_as_runs(one, emulators[key]) for one in read)
        places.append(seen_at(study, space, place, forms[key], emulators[key], readings))
    return Problem(space, tuple(places), tuple(_known(study, space)))


def seen_at(
    study: Study,
    space: Space,
    place: Place,
    form: Form,
    emulator: Emulator,
    readings: tuple[Reading, ...] = (),
) -> Seen:
    """Return a place with its emulator, whose inputs are unknowns or numbers of the study.

    Parameters
    ----------
    study : Study
    space : Space
        From `space_of`.
    place : Place
        Any combination of the study's materials, surfaces and experiments.
    form : Form
    emulator : Emulator
        Of the form.
    readings : tuple of Reading
        What was measured there.
    """
    return Seen(
        place_name(place),
        emulator,
        tuple(_source(study, space, place, axis) for axis in form.axes),
        tuple(_strength(study, space, place, switch) for switch in form.switches),
        readings,
        place.experiment,
    )


def inputs_at(place: Seen, values: Array) -> Inputs:
    """Return the inputs of a place's emulator for values (n, K)."""
    count = len(values)
    u = [source.of(values) for source in place.u]
    strengths = [source.of(values) for source in place.strengths]
    return Inputs.at(
        np.column_stack(u) if u else np.empty((count, 0)),
        np.column_stack(strengths) if strengths else np.empty((count, 0)),
    )


def readings_left_out(study: Study) -> dict[str, str]:
    """Return targets that a measured curve holds already, with the target that holds them."""
    curves = {(t.material, t.surface, t.experiment, t.observable): t.name for t in study.curves}
    found = {}
    for target in study.numbers:
        key = (target.material, target.surface, target.experiment, target.observed.part_of)
        if key in curves:
            found[target.name] = curves[key]
    return found


def _columns(data: StudyData, form: Form, target: Target) -> slice:
    return form.output(target.observable, target.model_scale, levels_of(data, target)).columns


def _column(study: Study, space: Space, name: str, place: Place) -> int | None:
    """Return the column of a parameter's unknown at a place; None where it is a number."""
    key = unknown_at(study, name, place)
    return None if key is None else space.index(key)


def _source(study: Study, space: Space, place: Place, axis: Axis) -> Source:
    column = _column(study, space, axis.name, place)
    value = 0.0
    if column is None:
        given = study.value_of(axis.name, *place) if axis.name in study.parameters else None
        if given is None and axis.name in PARTICLE_FIELDS:
            field, unit = PARTICLE_FIELDS[axis.name]
            given = getattr(particle_of_place(study, place), field) / unit
        value = axis.low if given is None else float(given)
    return Source(column, value, axis.low, axis.high, axis.spacing)


def _strength(study: Study, space: Space, place: Place, switch: Switch) -> Source:
    column = _column(study, space, switch.name, place)
    value = 0.0 if column is not None else study.value_of(switch.name, *place)
    return Source(column, float(value or 0.0), 0.0, switch.step)


def reading_of(data: StudyData, target: Target, columns: slice, space: Space) -> Reading:
    """Return a measured target on its model scale, with the errors that it shares.

    Parameters
    ----------
    data : StudyData
    target : Target
    columns : slice
        Where its emulator has it.
    space : Space
        Holds the shared errors of the target.
    """
    if target.is_curve:
        curve = data.curves[target.name]
        values, errors, repeats = curve.values, curve.se, curve.repeats
        levels = levels_of(data, target)
    else:
        number = data.scalars[target.name]
        values, errors = np.array([number.value]), np.array([number.se])
        repeats, levels = number.repeats, ()
    steps = np.array([slope(target.model_scale, float(value)) for value in values])
    shared, own = _shared(data.study, target, values, steps, space)
    return Reading(
        target.name,
        columns,
        forward(target.model_scale, values),
        errors * steps,
        repeats if repeats > 1 else 0,
        shared,
        np.column_stack(own) if own else None,
        levels=levels,
    )


def _shared(
    study: Study, target: Target, values: Array, steps: Array, space: Space
) -> tuple[tuple[tuple[int, Array], ...], list[Array]]:
    """Return errors in common with other targets, and those that this one has for itself."""
    found, own = [], []
    for one in study.shared:
        if target.name not in one.targets:
            continue
        if one.relative_se is not None:
            sizes = one.relative_se * values
        else:
            unit = target.unit or target.simulated_unit
            sizes = np.full(len(values), (one.se or 0.0) * factor(unit, target.simulated_unit))
        if joins(study, one):
            found.append((space.index(error_name(one)), sizes * steps))
        else:
            own.append(sizes * steps)
    return tuple(found), own


def _known(study: Study, space: Space) -> list[Known]:
    """Return the independent measurements of what is unknown, each once per instance."""
    found: dict[int, Known] = {}
    for name in study.known:
        for place in study.places:
            column = _column(study, space, name, place) if name in study.parameters else None
            known = study.known_of(name, place)
            if column is not None and known is not None:
                found.setdefault(column, Known(column, known.value, known.se))
    return list(found.values())
