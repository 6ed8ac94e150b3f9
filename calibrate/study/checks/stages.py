"""Stages, and that every contact parameter has a value when it is needed."""

from __future__ import annotations

from collections.abc import Iterable

from calibrate.errors import unknown_name
from calibrate.study.checks.parameters import check_number
from calibrate.study.draft import Draft
from calibrate.study.mistakes import Key, Mistakes
from calibrate.study.model import places_of
from calibrate.study.places import Place
from calibrate.study.schema.stages import Stage
from calibrate.study.schema.targets import Target

__all__ = ["check_stages"]


def check_stages(draft: Draft, mistakes: Mistakes) -> None:
    """Note mistakes in ``[[stage]]``, and contact parameters that have no value."""
    freed: set[tuple[str, str]] = set()
    for number, stage in draft.stages.items():
        here = _targets(number, stage, draft, mistakes)
        _ranges(number, stage, draft, mistakes)
        for word in stage.free:
            freed |= _free(number, stage, word, here, freed, draft, mistakes)
        if _sure(draft):
            told = _values(
                ("stage", number), f"stage '{stage.name}'", places_of(here), freed, draft, mistakes
            )
            freed |= told  # once is enough
    listed = draft.data.get("stage", [])
    if _sure(draft) and isinstance(listed, list) and len(listed) == len(draft.stages):
        for name, one in draft.parameters.items():
            if one.range and not draft.stages:
                freed |= {(name, instance) for instance in draft.layout.instances(name)}
        _values(("parameter",), "the study", list(draft.places), freed, draft, mistakes)


def _sure(draft: Draft) -> bool:
    """Whether a parameter that is missing is not just one that is misspelt or wrong."""
    known = [name for name in draft.table("parameter") if draft.layout.knows(name)]
    return draft.complete and len(known) == len(draft.table("parameter")) == len(draft.parameters)


def _targets(number: int, stage: Stage, draft: Draft, mistakes: Mistakes) -> list[Target]:
    """Return the targets of a stage that are right; note unknown ones, and other materials'."""
    names = draft.names("target")
    known = {one.name: one for one in draft.declared.values()}
    key = ("stage", number, "targets")
    for word in stage.targets:
        if word not in names:
            mistakes.add(key, f"stage '{stage.name}': targets: {unknown_name(word, names)}")
        elif word in known and known[word].material != stage.material:
            msg = (
                f"stage '{stage.name}' is for {stage.material}, and target '{word}' was measured "
                f"with {known[word].material}; give each material its own stages"
            )
            mistakes.add(key, msg)
    materials = draft.names("material")
    if stage.material not in materials:
        hint = unknown_name(stage.material, materials)
        mistakes.add(("stage", number, "material"), f"stage '{stage.name}': material: {hint}")
    return [known[word] for word in stage.targets if word in known]


def _ranges(number: int, stage: Stage, draft: Draft, mistakes: Mistakes) -> None:
    """Note ranges of what a stage does not free, and ends that no case takes."""
    for word, ends in stage.range.items():
        key = ("stage", number, "range", word)
        if word not in stage.free:
            hint = unknown_name(word, stage.free)
            mistakes.add(key, f"stage '{stage.name}': range: {hint}, which this stage frees")
            continue
        for end in ends:
            with mistakes.noting(key):
                check_number(word, end, draft, f"stage '{stage.name}': range")


def _free(
    number: int, stage: Stage, word: str, here: list[Target], freed: set[tuple[str, str]],
    draft: Draft, mistakes: Mistakes,
) -> set[tuple[str, str]]:  # fmt: skip
    """Return what a stage frees with a word; note what it cannot free."""
    key, about = ("stage", number, "free"), f"stage '{stage.name}': free"
    layout = draft.layout
    if word not in draft.table("parameter") and not layout.knows(word):
        mistakes.add(key, f"{about}: {unknown_name(word, draft.table('parameter'))}")
    if not layout.knows(word):
        return set()
    if word not in draft.table("parameter"):
        msg = f"{about}: '{word}' has no [parameter.{word}]; add it with a range"
        mistakes.add(key, msg)
        return set()
    if word in draft.parameters and not draft.parameters[word].range and word not in stage.range:
        msg = f"{about}: '{word}' has no range; add it under [parameter.{word}]"
        mistakes.add(key, msg)
    found = {one for p in places_of(here) if (one := layout.instance(word, p)) is not None}
    if not draft.complete or len(here) < len(stage.targets):
        return {(word, instance) for instance in found}
    if not found:
        msg = f"{about}: '{word}' matters for no target of the stage; free it where it does"
        mistakes.add(key, msg)
    elif len(found) > 1:
        msg = (
            f"{about}: '{word}' has {len(found)} values in this stage, "
            f"{', '.join(sorted(found))}; give each its own stage"
        )
        mistakes.add(key, msg)
    for instance in found:
        if (word, instance) in freed:
            msg = f"freed parameter '{word}' appears twice; free each in one stage"
            mistakes.add(key, msg)
    return {(word, instance) for instance in found}


def _values(
    key: Key, about: str, places: Iterable[Place], freed: set[tuple[str, str]], draft: Draft,
    mistakes: Mistakes,
) -> set[tuple[str, str]]:  # fmt: skip
    """Note contact parameters that matter and have neither a value nor were freed so far.

    Returns
    -------
    set of (str, str)
        Those that were noted.
    """
    layout = draft.layout
    found: set[tuple[str, str]] = set()
    for place in places:
        for name in layout.acting(place):
            instance = layout.instance(name, place) or ""
            given = draft.parameters[name].value if name in draft.parameters else {}
            if (name, instance) in freed | found or instance in given or "" in given:
                continue
            if not set(given) <= set(layout.instances(name)):
                continue  # a name of an instance is misspelt, which is told
            found.add((name, instance))
            which = f" of {instance}" if len(layout.instances(name)) > 1 else ""
            msg = (
                f"'{name}'{which} has no value in {about}; add one under [parameter.{name}], for "
                "example value = 0.3"
            )
            mistakes.add(key, msg)
    return found
