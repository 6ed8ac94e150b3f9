"""Where a further experiment is made, and the case of it if an answer holds."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.diagnosis import Diagnosis
from calibrate.causes.judging.probabilities import UNKNOWN
from calibrate.causes.offers import Names
from calibrate.causes.studies.further.registry import Entry
from calibrate.questions.core.problem import prior_of
from calibrate.study.cases import case_spec
from calibrate.study.model import Study
from calibrate.study.places import Place
from calibrate.study.schema.materials import Surface
from calibrate.study.schema.settings import Apparatus
from liggghts_io import CaseSpec

__all__ = ["Option", "case_of", "options_of"]


@dataclass(frozen=True)
class Option:
    """A further experiment at one place.

    Attributes
    ----------
    name : str
        Of the experiment, with material and wall where it can be made at several places.
    entry : Entry
    study : Study
        With its wall, its grains and its apparatus.
    place : Place
    """

    name: str
    entry: Entry
    study: Study
    place: Place


def options_of(
    study: Study, entries: Mapping[str, Entry], found: Diagnosis, shares: Mapping[Names, float]
) -> list[Option]:
    """Return what can be tried: each experiment at one place first, the shortest first.

    Of several places, that comes first where most of what is suspected acts.

    Parameters
    ----------
    study : Study
        The study that is diagnosed.
    entries : mapping
        By name.
    found : Diagnosis
    shares : mapping
        Probability of each answer.
    """
    ranked: list[tuple[int, float, Option]] = []
    for name, entry in entries.items():
        changed = [one.rpartition(".")[2] for one in study.parameters]
        if any(number in changed for number in (*entry.apparatus, *entry.times)):
            continue  # it is an unknown of the study, and cannot be set
        wider = _wider(study, entry)
        places = _places(study, wider, entry)
        options = []
        for place in places:
            where = f":{place.material}/{place.surface}" if len(places) > 1 else ""
            options.append(Option(f"{name}{where}", entry, wider, place))
        options.sort(key=lambda one: -_suspected(one, found, shares))
        ranked += [(rank, entry.hours, one) for rank, one in enumerate(options)]
    return [option for _, _, option in sorted(ranked, key=lambda one: one[:2])]


def _suspected(option: Option, found: Diagnosis, shares: Mapping[Names, float]) -> float:
    """Return the probability of the answers of which something acts in an experiment."""
    return math.fsum(
        p
        for names, p in shares.items()
        if names != (UNKNOWN,) and any(one is not None for one in _acting(option, found, names))
    )


def _acting(option: Option, found: Diagnosis, names: Names) -> list[str | None]:
    """Return the instance in which each member of an answer acts, None where it does not."""
    layout, place = option.study.layout, option.place
    grains = option.study.material_named(place.material).particle
    acting = []
    for one in found.board.members(names):
        where, site = one.name.partition(":")[2], layout.site(one.effect, place)
        acts = site is not None and where in ("", site) and layout.effects[one.effect].fits(grains)
        acting.append(layout.instance(one.effect, place) if acts else None)
    return acting


def _wider(study: Study, entry: Entry) -> Study:
    """Return the study with what the experiment changes."""
    given = study.overrides(entry.experiment)
    believed = study.experiments[entry.experiment].apparatus(study.run.scale, given)
    scaled = {name: believed[name] * by for name, by in entry.times.items()}
    old = next((rig for rig in study.rigs if rig.name == entry.experiment), None)
    rig = Apparatus(
        name=entry.experiment,
        folder=None if old is None else old.folder,
        apparatus={**given, **entry.apparatus, **scaled},
    )
    surfaces, materials = list(study.surfaces), list(study.materials)
    if entry.wall is not None and entry.wall not in [one.name for one in surfaces]:
        surfaces.append(Surface.model_validate({"name": entry.wall}))
    if entry.particle is not None and entry.particle.name not in [one.name for one in materials]:
        materials.append(entry.particle)
    rigs = [*(one for one in study.rigs if one.name != entry.experiment), rig]
    return study.model_copy(update={"rigs": rigs, "surfaces": surfaces, "materials": materials})


def _places(study: Study, wider: Study, entry: Entry) -> list[Place]:
    """Return where the experiment can be made, and is not made yet."""
    if entry.changes and entry.experiment not in [one.experiment for one in study.places]:
        return []  # nobody here has the rig that it changes
    grains = [entry.particle.name] if entry.particle else [m.name for m in study.materials]
    walls = [entry.wall] if entry.wall else [surface.name for surface in study.surfaces]
    known = {one[:2] for one in study.places}
    elsewhere, again = bool(entry.wall or entry.particle), bool(entry.apparatus or entry.times)
    found = []
    for place in (Place(m, w, entry.experiment) for m in grains for w in walls):
        made = place in study.places
        fits = elsewhere or (made if again else place[:2] in known)
        if fits and (again or not made):
            kind = wider.surface_named(place.surface).kind
            found += [place] if wider.experiments[entry.experiment].acting(kind) else []
    return found


def case_of(
    option: Option,
    found: Diagnosis,
    names: Names,
    draw: tuple[Array, Array],
    prior: Array,
    seed: int,
) -> CaseSpec:
    """Return the case of a further experiment if an answer holds.

    A cause acts where it acts in the study: one of a funnel, wall or material only there.

    Parameters
    ----------
    option : Option
    found : Diagnosis
    names : tuple of str
        Members of the answer.
    draw : (K,) and (m,) float64
        Values and strengths, one draw of `Diagnosis.samples`.
    prior : float64
        Probability at which each parameter of the study, in its order, is taken from its prior
        where the study does not know it.
    seed : int
        Of the run.

    Raises
    ------
    CalibrationError
        Where a contact parameter has neither value nor range.
    """
    study, place, layout = option.study, option.place, option.study.layout
    # The unknowns of a problem begin with what the study frees, in the same order.
    values = dict(zip(study.free, map(float, draw[0]), strict=False))
    for name, p in zip(study.parameters, prior, strict=True):
        instance = layout.instance(name, place)
        span = None if instance is None else study.range_of(name, instance)
        if instance is not None and span is not None and (name, instance) not in values:
            values[name, instance] = float(prior_of(study, name, span).quantile(np.array(p)))
    members = found.board.members(names)
    acting = _acting(option, found, names)
    for one, instance, strength in zip(members, acting, draw[1], strict=True):
        if instance is not None:
            values[one.effect, instance] = float(strength)
    return case_spec(study, place, values, seed)
