"""From a study and parameters to case specifications."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TypeAlias

from pydantic import ValidationError

from calibrate.errors import CalibrationError
from calibrate.study.model import Study, places_of
from calibrate.study.places import Layout, Place
from liggghts_io import CaseSpec
from liggghts_io.bulk import Bulk
from liggghts_io.errors import told

__all__ = ["Values", "case_spec", "middle", "planned", "planned_at_most"]

Values: TypeAlias = Mapping[tuple[str, str], float]
"""Value of a parameter by name and instance."""


def case_spec(study: Study, place: Place, values: Values, seed: int) -> CaseSpec:
    """Return the case of one place at given parameters.

    Parameters
    ----------
    study : Study
        Materials, scale, engine, apparatus and effects.
    place : Place
        Material, surface and experiment.
    values : mapping
        By name and instance; parameters that are not in it have the study's values. Those that
        do not matter at the place are left out.
    seed : int
        Seed of the insertion.

    Raises
    ------
    CalibrationError
        When a contact parameter has no value.
    """
    layout = study.layout
    acting = layout.acting(place)
    given = {name: one for (name, instance), one in values.items()
             if layout.instance(name, place) == instance}  # fmt: skip
    for name in (*acting, *study.parameters):
        if name not in given and layout.acts(name, place):
            value = study.value_of(name, *place)
            if value is not None:
                given[name] = value
    parts = _sorted(layout, given)
    effects = {**study.effects, **parts["effect"]}
    return CaseSpec(
        experiment=place.experiment,
        particle=_bulk(study, place, parts["material"]).particle,
        surface=study.surface_named(place.surface).kind,
        scale=study.run.scale,
        parameters=_contact(acting, parts["contact"], place),
        apparatus={**study.overrides(place.experiment), **parts["apparatus"]},
        effects={name: one for name, one in effects.items() if one and layout.acts(name, place)},
        seed=seed,
        engine=study.run.engine,
        own=study.own.get(place.experiment),
    )


def _sorted(layout: Layout, given: Mapping[str, float]) -> dict[str, dict[str, float]]:
    """Return values by the part of a case that takes them, apparatus without its experiment.

    Ten digits are more than any parameter means and keep case ids stable across platforms.
    """
    parts: dict[str, dict[str, float]] = {
        role: {} for role in ("contact", "material", "effect", "apparatus")
    }
    for name, value in sorted(given.items()):
        role = layout.role(name)
        bare = name.rpartition(".")[2] if role == "apparatus" else name
        parts[role][bare] = float(f"{value:.10g}")
    return parts


def _contact(acting: tuple[str, ...], given: Mapping[str, float], place: Place) -> dict[str, float]:
    for name in acting:
        if name not in given:
            msg = (
                f"'{name}' has no value for {place.experiment} on {place.surface}; give it one "
                f"under [parameter.{name}], for example value = 0.3"
            )
            raise CalibrationError(msg)
    return dict(given)


def _bulk(study: Study, place: Place, changed: Mapping[str, float]) -> Bulk:
    bulk = study.material_named(place.material).bulk
    if not changed:
        return bulk
    try:
        return Bulk.model_validate({**bulk.model_dump(exclude_unset=True), **changed})
    except ValidationError as err:
        words = ", ".join(f"{name} = {value:g}" for name, value in changed.items())
        msg = f"material '{place.material}' with {words}: {told(err.errors()[0])}"
        raise CalibrationError(msg) from err


def middle(study: Study) -> dict[tuple[str, str], float]:
    """Return everything that is free in the middle of its range, of the stage that frees it."""
    found = {key: study.range_of(*key) for key in study.free}
    for stage in study.stages:
        for name, instance in study.freed(stage).items():
            found[name, instance] = study.range_of(name, instance, stage)
    return {key: 0.5 * sum(ends) for key, ends in found.items() if ends is not None}


def planned(study: Study) -> dict[Place, int]:
    """Return how many runs a calibration by stages asks for, by place."""
    runs = dict.fromkeys(study.places, study.design.check_seeds)
    for stage in study.stages:
        for place in places_of(study.target_named(name) for name in stage.targets):
            runs[place] += stage.points + stage.repeats + stage.infill
    return runs


def planned_at_most(study: Study) -> dict[Place, int]:
    """Return how many runs a calibration asks for at most, by stages and jointly, by place.

    A joint calibration spends its budget where it helps; here every place has the same share, and
    the final check one round.
    """
    design, places = study.design, study.places
    share = math.ceil(design.runs / len(places)) + design.check_seeds + design.check_draws
    staged = planned(study) if study.stages else dict.fromkeys(places, 0)
    return {place: staged[place] + share for place in places}
