"""From points of a design to the cases that are run, and to what a run costs."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.emulator.checks import fewest_points
from calibrate.errors import CalibrationError
from calibrate.planning.points import (
    LEAST_PER_INPUT,
    PER_INPUT,
    REPEAT_EVERY,
    TWIN_EVERY,
    Points,
    points_needed,
    starting_points,
)
from calibrate.questions.core.forms import PARTICLE_FIELDS, Axis, Form, FormKey
from calibrate.questions.core.from_study import places_by_form
from calibrate.study.cases import case_spec
from calibrate.study.model import Study
from calibrate.study.places import Place
from liggghts_io import CaseSpec
from liggghts_io.materials import kind_of

__all__ = [
    "ADDED_SEED",
    "CHECK_SEED",
    "Stand",
    "case_at",
    "first_cases",
    "joint_rng",
    "pilot_cases",
    "refuse_few_points",
    "stands_of",
]

START_SEED: Final = 1_000_000
ADDED_SEED: Final = 2_000_000
CHECK_SEED: Final = 3_000_000
"""Added to the study's seed: first design, added runs, final check; far from those of stages."""
START_SHARE: Final = 0.5
"""Most of the budget that the first design takes; the rest goes where the answer is."""
JOINT: Final = 3
"""Keeps the draws of a joint calibration apart from those of other questions to the study."""
PILOT_POINTS: Final = 10
"""Points per place of a pilot design."""


@dataclass(frozen=True)
class Stand:
    """One material under one form: where runs can be made.

    Attributes
    ----------
    material : str
    form : Form
    places : tuple of Place
        Its places; surfaces of one kind run the same cases.
    """

    material: str
    form: Form
    places: tuple[Place, ...]


def stands_of(study: Study, forms: Mapping[FormKey, Form]) -> list[Stand]:
    """Return where runs can be made, each material under each form that it has."""
    found = []
    for key, places in places_by_form(study).items():
        for material in dict.fromkeys(place.material for place in places):
            here = tuple(place for place in places if place.material == material)
            found.append(Stand(material, forms[key], here))
    return found


def case_at(study: Study, stand: Stand, u: Array, strengths: Array, seed: int) -> CaseSpec:
    """Return the case at a point of an emulator's inputs.

    Parameters
    ----------
    study : Study
    stand : Stand
    u : (d,) float64
        Inputs of the form; those that are numbers of the material are its own anyway.
    strengths : (m,) float64
        Effects, in steps.
    seed : int
        Seed of the insertion.
    """
    place, form = stand.places[0], stand.form
    values = {
        axis.name: float(axis.value(one))
        for axis, one in zip(form.axes, u, strict=True)
        if axis.name not in PARTICLE_FIELDS or axis.name in study.parameters
    }
    values |= {
        switch.name: float(one) * switch.step
        for switch, one in zip(form.switches, strengths, strict=True)
    }
    by_instance, layout = {}, study.layout
    for name, value in values.items():
        instance = layout.instance(name, place)
        if instance is not None:
            by_instance[name, instance] = value
    return case_spec(study, place, by_instance, seed)


def joint_rng(study: Study) -> np.random.Generator:
    """Return the generator of a joint calibration; its first draws make the first design."""
    return np.random.default_rng([study.run.seed, JOINT])


def first_cases(
    study: Study, forms: Mapping[FormKey, Form], rng: np.random.Generator
) -> list[CaseSpec]:
    """Return the cases of the first design.

    Every place of a material is run at the same points. Where the study does not say how many,
    each emulator gets ten points per input, fewer where the budget does not hold them, and never
    fewer than it can be trained on.

    Parameters
    ----------
    study : Study
    forms : mapping
        Form by key.
    rng : numpy Generator
    """
    stands = stands_of(study, forms)
    said = [study.design.start_of(stand.material) for stand in stands]
    counts = [_points(stand, stands) for stand in stands]
    share = START_SHARE * study.design.runs / max(_runs(stands, counts), 1)
    counts = [
        own or max(math.floor(count * min(share, 1.0)), _least(stand.form))
        for own, count, stand in zip(said, counts, stands, strict=True)
    ]
    return _cases(study, stands, counts, rng)


def pilot_cases(
    study: Study, forms: Mapping[FormKey, Form], rng: np.random.Generator
) -> list[CaseSpec]:
    """Return a few cases of every place, to see what responds to what."""
    stands = stands_of(study, forms)
    counts = [max(PILOT_POINTS, _inputs(stand.form) + 4) for stand in stands]
    return _cases(study, stands, counts, rng)


def _inputs(form: Form) -> int:
    return len(form.axes) + len(form.switches)


def _least(form: Form) -> int:
    return max(LEAST_PER_INPUT * _inputs(form), fewest_points(_inputs(form)))


def refuse_few_points(
    forms: Mapping[FormKey, Form], specs: Sequence[CaseSpec], place: str = "[design] start"
) -> None:
    """Refuse cases on which an emulator cannot be trained even when all of them succeed.

    Parameters
    ----------
    forms : mapping
        Form by key.
    specs : sequence of CaseSpec
        All that emulators will learn from at first.
    place : str
        Where it is said how many they are, for messages.

    Raises
    ------
    CalibrationError
        Naming the experiment, its points, and how many it needs.
    """
    for form in forms.values():
        mine = [spec for spec in specs if (spec.experiment, kind_of(spec.surface)) == form.key]
        points = len({tuple(form.place_in(spec)[0]) for spec in mine})
        least = fewest_points(_inputs(form))
        if points < fewest_points(len(form.axes)) or len(mine) < least:
            msg = (
                f"{place}: gives {points} points of {form.experiment} on a "
                f"{form.kind} surface, and an emulator of {_inputs(form)} unknowns needs at least "
                f"{least}; leave it out ({PER_INPUT} for each unknown), or give {least} or more"
            )
            raise CalibrationError(msg)


def _points(stand: Stand, stands: Sequence[Stand]) -> int:
    sharing = sum(other.form.key == stand.form.key for other in stands)
    return points_needed(max(_inputs(stand.form), 1), sharing)


def _runs(stands: Sequence[Stand], counts: Sequence[int]) -> int:
    """Return about how many runs so many points are: with repeats and effect twins."""
    return sum(
        math.ceil(count * (1.0 + 1.0 / REPEAT_EVERY + len(stand.form.switches) / TWIN_EVERY))
        for stand, count in zip(stands, counts, strict=True)
    )


def _cases(
    study: Study, stands: Sequence[Stand], counts: Sequence[int], rng: np.random.Generator
) -> list[CaseSpec]:
    """Return the cases of space-filling points, so many for each stand."""
    own = [
        [a.name for a in s.form.axes if a.name not in PARTICLE_FIELDS or a.name in study.parameters]
        for s in stands
    ]
    names = list(dict.fromkeys(name for part in own for name in part))
    effects = list(dict.fromkeys(w.name for stand in stands for w in stand.form.switches))
    materials = list(dict.fromkeys(stand.material for stand in stands))
    most = max(counts)
    designs = starting_points(most, len(names), len(effects), len(materials), rng)
    found = []
    for stand, count in zip(stands, counts, strict=True):
        points = designs[materials.index(stand.material)].first(count)
        found += _cases_of(study, stand, points, names, effects)
    return found


def _cases_of(
    study: Study, stand: Stand, points: Points, names: Sequence[str], effects: Sequence[str]
) -> list[CaseSpec]:
    form = stand.form
    mine = [effects.index(switch.name) for switch in form.switches]
    others = [k for k in range(len(effects)) if k not in mine]
    found = []
    for u, parts, seed in zip(points.u, points.strengths, points.seeds, strict=True):
        if parts[others].any():  # a twin for an effect that does not act here
            continue
        at = [
            _own_part(study, stand, axis, u[names.index(axis.name)]) if axis.name in names else 0.5
            for axis in form.axes
        ]
        strengths = [
            switch.strength(float(parts[k])) / switch.step
            for switch, k in zip(form.switches, mine, strict=True)
        ]
        first = study.run.seed + START_SEED
        found.append(case_at(study, stand, np.array(at), np.array(strengths), first + int(seed)))
    return found


def _own_part(study: Study, stand: Stand, axis: Axis, part: float) -> float:
    """Return where a part of a material's own range lies on an axis, which spans that of all.

    A number that is fixed for the material is where it is.
    """
    instance = study.layout.instance(axis.name, stand.places[0])
    if instance is None:
        return part
    span = study.range_of(axis.name, instance)
    if span is None:
        value = study.value_of(axis.name, *stand.places[0])
        return part if value is None else float(axis.unit(np.array(value)))
    low, high = axis.unit(np.array(span))
    return float(low + part * (high - low))
