"""Names that must be there once, and what targets say of materials, surfaces and errors."""

from __future__ import annotations

from calibrate.errors import unknown_name
from calibrate.study.draft import Draft
from calibrate.study.mistakes import Mistakes
from calibrate.study.model import Study
from calibrate.study.places import Place

__all__ = ["check_measured", "curves_of_many_places"]


def check_measured(draft: Draft, mistakes: Mistakes) -> None:
    """Note doubled names, and targets and shared errors that do not fit the rest."""
    _once(draft, mistakes)
    _declared(draft, mistakes)
    _unused(draft, mistakes)
    _grains(draft, mistakes)
    _shared(draft, mistakes)


def _once(draft: Draft, mistakes: Mistakes) -> None:
    """Note names that are given twice."""
    tables = {
        "material": draft.materials, "surface": draft.surfaces, "experiment": draft.rigs,
        "target": draft.targets, "shared": draft.shared, "stage": draft.stages,
    }  # fmt: skip
    for what, parts in tables.items():
        seen: set[str] = set()
        for number, one in parts.items():
            name: str = getattr(one, "name")  # noqa: B009 - every one of these tables has a name
            if name in seen:
                msg = f"{what} '{name}' appears twice; give each its own name"
                mistakes.add((what, number, "name"), msg)
            seen.add(name)


def _declared(draft: Draft, mistakes: Mistakes) -> None:
    """Note materials and surfaces of targets that the study does not have."""
    for what in ("material", "surface"):
        names = draft.names(what)
        for number, one in draft.targets.items():
            word: str = getattr(one, what)
            if word not in names:
                msg = f"target '{one.name}': {what}: {unknown_name(word, names)}"
                mistakes.add(("target", number, what), f"{msg}; declare it under [[{what}]]")


def _unused(draft: Draft, mistakes: Mistakes) -> None:
    """Note materials and surfaces with which nothing was measured."""
    if not draft.complete:
        return
    for what, parts in (("material", draft.materials), ("surface", draft.surfaces)):
        used = {getattr(one, what) for one in draft.targets.values()}
        for number, part in parts.items():
            name: str = getattr(part, "name")  # noqa: B009 - see _once
            if name not in used:
                msg = f"{what} '{name}' has no target; take it out, or add what was measured"
                mistakes.add((what, number), msg)


def _grains(draft: Draft, mistakes: Mistakes) -> None:
    """Note experiments that need to know more of the grains than is said."""
    for place, key in draft.places.items():
        particle = draft.material_named(place.material).particle
        kind = draft.layout.kinds[place.surface]
        with mistakes.noting((*key, "experiment")):
            needs = draft.experiments[place.experiment].needs(kind)
            particle.need(needs, f"the experiment {place.experiment} on {place.surface}")


def _shared(draft: Draft, mistakes: Mistakes) -> None:
    """Note shared errors over targets that are unknown, or in units that differ."""
    names = draft.names("target")
    targets = {one.name: one for one in draft.targets.values()}
    for number, one in draft.shared.items():
        key = ("shared", number, "targets")
        for word in one.targets:
            if word not in names:
                msg = f"shared error '{one.name}': targets: {unknown_name(word, names)}"
                mistakes.add(key, msg)
        if len({*one.targets}) < len(one.targets):
            msg = f"shared error '{one.name}': a target appears twice; take one out"
            mistakes.add(key, msg)
        units = {targets[word].simulated_unit for word in one.targets if word in targets}
        if one.se is not None and len(units) > 1:
            msg = (
                f"shared error '{one.name}': se = {one.se:g} stands for targets in "
                f"{' and '.join(sorted(units))}; give relative_se, or one error for each unit"
            )
            mistakes.add(("shared", number, "se"), msg)


def curves_of_many_places(study: Study) -> list[str]:
    """Say which measured curve stands for several places: a slip, most likely.

    Parameters
    ----------
    study : Study
    """
    taken: dict[tuple[str, ...], dict[str, Place]] = {}
    for one in study.targets:
        if one.is_curve:
            columns = [str(column) for column in (one.column, *one.columns) if column]
            here = taken.setdefault((str(one.file), *columns), {})
            here[one.name] = Place(one.material, one.surface, one.experiment)
    return [
        f"targets {', '.join(names)} take {', '.join(columns)} of {file}, though they are of "
        "different materials, walls or experiments; if that is a slip, name the file of each"
        for (file, *columns), names in taken.items()
        if len(set(names.values())) > 1
    ]
