"""From a study to a board: which effects may be missing where, and the data.

A new effect is one file in `liggghts_io/effects`; it becomes a candidate here without any change.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from calibrate.causes.candidates import Board, Candidate, Measured, board_of_problem
from calibrate.emulator.types import Emulator
from calibrate.questions.core.forms import Form, FormKey
from calibrate.questions.core.from_study import form_key, forms_of, place_of
from calibrate.questions.core.problem import problem_of, readings_left_out
from calibrate.scales import Scale
from calibrate.study.data import StudyData
from calibrate.study.model import Study
from calibrate.study.schema.parameters import Parameter
from calibrate.study.schema.settings import Known
from liggghts_io.effects import Effect

__all__ = [
    "board_of",
    "candidates_of",
    "considered",
    "groups_of",
    "scales_of",
    "with_effects",
]

VAGUE: Final = 0.25
"""Standard error of a measurement of which nobody says how good it is, in ordinary strengths."""


def considered(study: Study) -> tuple[Effect, ...]:
    """Return the effects that may be missing in a study, each where it acts.

    Left out are effects that are no candidates, that the study has on or free, that the engine
    does not have, that need numbers of the grains which the study does not give, or that are in
    its base model.
    """
    grains, layout = [material.bulk.particle for material in study.materials], study.layout
    return tuple(
        one
        for one in layout.effects.values()
        if one.candidate
        and one.name not in study.parameters
        and study.effects.get(one.name, 0.0) == 0.0
        and not (one.extension and study.run.engine == "liggghts")
        and all(one.fits(particle) for particle in grains)
        and any(layout.acts(one.name, place) for place in study.places)
    )


def with_effects(data: StudyData) -> StudyData:
    """Return the study with all candidate effects free: what its emulators have to know."""
    study = data.study
    free = {one.name: _parameter(one) for one in considered(study)}
    wider = study.model_copy(update={"parameters": {**study.parameters, **free}})
    return replace(data, study=wider)


def _parameter(effect: Effect) -> Parameter:
    one = Candidate.of_effect(effect.name, effect.scale, (effect.low, effect.high), ())
    return Parameter(range={"": (one.low, one.high)}, scope="global")


def candidates_of(study: Study, forms: Mapping[FormKey, Form]) -> tuple[Candidate, ...]:
    """Return every effect that the forms know, and those of one apparatus alone.

    Parameters
    ----------
    study : Study
        Without the effects among its parameters.
    forms : mapping
        Of the study with all effects.
    """
    found = []
    for effect in considered(study):
        acts: dict[str, list[tuple[int, int]]] = {}
        for k, place in enumerate(study.places):
            names = [switch.name for switch in forms[form_key(study, place)].switches]
            if effect.name in names:
                where = study.layout.site(effect.name, place) or ""
                acts.setdefault(where, []).append((k, names.index(effect.name)))
        found.append(_candidate(effect, [at for own in acts.values() for at in own]))
        if len(acts) > 1:
            found += [_candidate(effect, own, where) for where, own in acts.items()]
    return tuple(found)


def _candidate(effect: Effect, acts: Sequence[tuple[int, int]], where: str = "") -> Candidate:
    limits = (1.0, 1.0) if effect.switch else (effect.low, effect.high)
    one = Candidate.of_effect(effect.name, effect.scale, limits, acts, where)
    title = f"{effect.title}, {where} alone" if where else effect.title
    return replace(
        one,
        title=title,
        unit=effect.unit,
        settled_by=effect.settled_by,
        settled_se=effect.settled_se or VAGUE * effect.scale,
        settled_hours=effect.settled_hours,
    )


def board_of(
    data: StudyData,
    emulators: Mapping[FormKey, Emulator],
    rng: np.random.Generator,
    forms: Mapping[FormKey, Form] | None = None,
) -> Board:
    """Return what a diagnosis of a study needs.

    Parameters
    ----------
    data : StudyData
        The study as it is.
    emulators : mapping
        Of the study with all effects, by form.
    rng : numpy Generator
    forms : mapping, optional
        What the emulators are of, where they know more than the study measured; by default what
        follows from the study.
    """
    if forms is None:
        forms = forms_of(with_effects(data))
    problem = problem_of(data, forms, emulators)
    candidates = candidates_of(data.study, forms)
    return board_of_problem(problem, candidates, _measured(data.study, candidates), rng)


def _measured(study: Study, candidates: Sequence[Candidate]) -> dict[str, tuple[Measured, ...]]:
    """Return the independent measurements of the candidates' effects, each where it holds."""
    found = {}
    for effect in dict.fromkeys(one.effect for one in candidates):
        known: dict[str, Known] = {}
        places: dict[str, set[int]] = {}
        for k, place in enumerate(study.places):
            site, given = study.layout.site(effect, place), study.known_of(effect, place)
            if site is not None:
                places.setdefault(site, set()).add(k)
                if given is not None:
                    known.setdefault(site, given)
        holds: dict[int, set[int]] = {}
        for site, given in known.items():
            holds.setdefault(id(given), set()).update(places[site])
        once = {id(given): given for given in known.values()}
        if once:
            found[effect] = tuple(
                Measured(given.value, given.se, frozenset(holds[key]))
                for key, given in once.items()
            )
    return found


def scales_of(study: Study) -> dict[str, Scale]:
    """Return the model scale of every target."""
    return {target.name: target.model_scale for target in study.targets}


def groups_of(study: Study) -> dict[tuple[str, str], list[int]]:
    """Return the readings of each experiment, material and wall, where there are several of them.

    Returns
    -------
    dict
        Kind and name to numbers of readings, place by place.
    """
    skipped = readings_left_out(study)
    places = [
        place
        for place in study.places
        for target in study.targets
        if place_of(target) == place and target.name not in skipped
    ]
    found: dict[tuple[str, str], list[int]] = {}
    for kind, words in (
        ("experiment", [p.experiment for p in places]),
        ("material", [p.material for p in places]),
        ("wall", [p.surface for p in places]),
    ):
        if len(set(words)) > 1:
            for number, word in enumerate(words):
                found.setdefault((kind, word), []).append(number)
    return found
