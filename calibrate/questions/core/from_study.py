"""From a study to forms: what is emulated of which experiment, with which inputs.

Places of one experiment on one kind of surface share a form and so an emulator: steel and alumina
are both flat, and what differs between them are numbers. An input is whatever is unknown there or
differs between the places.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from calibrate.inference.priors import Spacing
from calibrate.questions.core.forms import PARTICLE_FIELDS, Axis, Emulated, Form, FormKey, Switch
from calibrate.study.data import StudyData
from calibrate.study.model import Study
from calibrate.study.places import Place
from calibrate.study.schema.targets import Target
from liggghts_io import Particle

__all__ = [
    "form_key",
    "forms_of",
    "levels_of",
    "particle_of_place",
    "place_of",
    "places_by_form",
]

EVERYWHERE: Final = (
    "d32_um", "density_kg_m3", "youngs_modulus_pa", "poisson_ratio", "coarse_graining",
)  # fmt: skip
"""Numbers of the grains on which every experiment depends."""
ALIKE: Final = 1e-9
"""Relative difference below which two numbers are the same."""


def form_key(study: Study, place: Place) -> FormKey:
    """Return the form of a place: its experiment and the kind of its surface."""
    return place.experiment, study.surface_named(place.surface).kind


def places_by_form(study: Study) -> dict[FormKey, list[Place]]:
    """Return the places of a study by their form."""
    found: dict[FormKey, list[Place]] = {}
    for place in study.places:
        found.setdefault(form_key(study, place), []).append(place)
    return found


def forms_of(data: StudyData) -> dict[FormKey, Form]:
    """Return what has to be emulated for a study.

    Parameters
    ----------
    data : StudyData
        The study, and the levels at which its curves were measured.
    """
    study = data.study
    return {
        key: Form(
            *key,
            axes=(*_parameter_axes(study, places), *_material_axes(study, places)),
            switches=_switches(study, places),
            outputs=_outputs(data, [t for t in study.targets if place_of(t) in places]),
        )
        for key, places in places_by_form(study).items()
    }


def levels_of(data: StudyData, target: Target) -> tuple[float, ...]:
    """Return where a curve was measured; empty for a number."""
    if not target.is_curve:
        return ()
    return tuple(float(level) for level in data.curves[target.name].levels)


def place_of(target: Target) -> Place:
    """Return where a target was measured."""
    return Place(target.material, target.surface, target.experiment)


def particle_of_place(study: Study, place: Place) -> Particle:
    """Return the grains of a place."""
    return study.material_named(place.material).bulk.particle


def _span(study: Study, name: str, places: Sequence[Place]) -> tuple[float, float] | None:
    """Return between what a parameter lies at some places, None where it is the same number."""
    ends: list[float] = []
    for place in places:
        instance = study.layout.instance(name, place)
        if instance is None:
            continue
        span = study.range_of(name, instance)
        value = study.value_of(name, *place)
        ends += span or ([] if value is None else [value])
    if not ends or max(ends) - min(ends) <= ALIKE * max(map(abs, ends)):
        return None
    return min(ends), max(ends)


def _parameter_axes(study: Study, places: Sequence[Place]) -> list[Axis]:
    layout = study.layout
    found = []
    for name in dict.fromkeys((*layout.acting(places[0]), *study.parameters)):
        span = None if layout.role(name) == "effect" else _span(study, name, places)
        if span:
            found.append(Axis(name, *span, spacing=_spacing(study, name, span)))
    return found


def _spacing(study: Study, name: str, span: tuple[float, float]) -> Spacing:
    logarithmic = name in study.parameters and study.parameters[name].spacing == "log"
    return "log" if logarithmic and span[0] > 0.0 else "linear"


def _material_axes(study: Study, places: Sequence[Place]) -> list[Axis]:
    """Return the numbers that tell the materials apart, one fewer than there are materials.

    With that many, every number that is left out is a function of those that are in.
    """
    materials = {place.material: particle_of_place(study, place) for place in places}
    kind = study.surface_named(places[0].surface).kind
    asked = study.experiments[places[0].experiment].needs(kind)
    found = []
    for name, (field, unit) in PARTICLE_FIELDS.items():
        if name in study.parameters or (name not in EVERYWHERE and field not in asked):
            continue
        values = [float(getattr(one, field)) / unit for one in materials.values()]
        if max(values) - min(values) > ALIKE * max(values):
            found.append(Axis(name, min(values), max(values), "log"))
    return found[: len(materials) - 1]


def _switches(study: Study, places: Sequence[Place]) -> tuple[Switch, ...]:
    effects, found = study.layout.effects, []
    for name in study.parameters:
        span = _span(study, name, places) if name in effects else None
        if span:
            found.append(Switch(name, effects[name].scale, *span))
    return tuple(found)


def _outputs(data: StudyData, targets: Sequence[Target]) -> tuple[Emulated, ...]:
    """Return what is compared, each number once and each curve once for its levels."""
    asked = dict.fromkeys((t.observable, t.model_scale, levels_of(data, t)) for t in targets)
    found, column = [], 0
    for name, scale, levels in asked:
        width = max(len(levels), 1)
        found.append(Emulated(name, scale, slice(column, column + width), levels))
        column += width
    return tuple(found)
