"""Parameters and what is known of them: names, instances, limits, ties."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Final

from calibrate.errors import CalibrationError, unknown_name
from calibrate.study.draft import Draft
from calibrate.study.mistakes import Key, Mistakes
from calibrate.study.places import Layout, Place
from calibrate.study.schema.parameters import Parameter
from calibrate.study.schema.settings import Known
from liggghts_io.bulk import Bulk
from liggghts_io.errors import CaseError
from liggghts_io.materials import check_contact

__all__ = ["KNOWN_SPAN", "check_known", "check_number", "check_parameters"]

KNOWN_SPAN: Final = 3.0
"""Standard errors of an independent measurement within which a strength may lie."""

_DIMENSIONS: Final = {
    "material": ("material", "material+surface", "material+apparatus"),
    "surface": ("surface", "material+surface"),
}
"""Scopes that a tie can hold together."""

_FOR: Final = {
    "apparatus": "apparatus and effects",
    "material+apparatus": "apparatus, effects and numbers of a material",
}
_NOT_FOR: Final = {"contact": ("apparatus", "material+apparatus"), "material": ("apparatus",)}
"""By role, the scopes that a parameter cannot have, and what these are for."""


def check_parameters(draft: Draft, mistakes: Mistakes) -> None:
    """Note mistakes in ``[parameter]`` and ``[known]``."""
    layout = draft.layout
    for name in (one for one in draft.table("parameter") if not draft.lacks(one)):
        with mistakes.noting(("parameter", name)):
            _role(name, draft)
            if name in draft.parameters:
                _parameter(name, draft.parameters[name], draft, layout, mistakes)
    check_known(draft, mistakes)


def check_known(draft: Draft, mistakes: Mistakes) -> None:
    """Note mistakes in ``[known]``."""
    layout = draft.layout
    known = {name: listed for name, listed in draft.known.items() if not draft.lacks(name)}
    for name, listed in known.items():
        with mistakes.noting(("known", name)):
            _role(name, draft)
            for number, one in listed.items():
                _known(name, number, one, draft, mistakes)
            _once(name, listed, layout, mistakes)


def _role(name: str, draft: Draft) -> str:
    """Return the role of a name; says how to write an apparatus parameter of one experiment."""
    if name in draft.experiments:
        msg = (
            f"'{name}' is an experiment; write its parameter in quotes, for example "
            f'[parameter."{name}.{draft.experiments[name].parameters[0].name}"]'
        )
        raise CalibrationError(msg)
    return draft.layout.role(name)


def _parameter(name: str, one: Parameter, draft: Draft, layout: Layout, mistakes: Mistakes) -> None:
    key: Key = ("parameter", name)
    instances = layout.instances(name)
    if not draft.complete:
        return
    if not instances:
        here = ", ".join(sorted({f"{p.experiment} on {p.surface}" for p in layout.places}))
        msg = (
            f"parameter '{name}' matters in no experiment of the study ({here}); take it out, or "
            "add a target that it acts on"
        )
        mistakes.add(key, msg)
        return
    role = layout.role(name)
    if one.scope in _NOT_FOR.get(role, ()):
        msg = f"{name}: scope = '{one.scope}' is for {_FOR[one.scope]}"
        mistakes.add((*key, "scope"), msg)
    for what, table in (("value", one.value), ("range", one.range), ("published", one.published)):
        for word in table:
            if word and word not in instances:
                msg = f"parameter.{name}.{what}: {unknown_name(word, instances)}"
                mistakes.add((*key, what, word), msg)
    _limits(name, one, draft, mistakes)
    _tie(name, one, layout, mistakes)
    _twice(name, draft, layout, mistakes)


def _limits(name: str, one: Parameter, draft: Draft, mistakes: Mistakes) -> None:
    """Note values and ends of ranges that no case takes."""
    for what, numbers in (
        ("value", list(one.value.values())),
        ("range", [end for ends in one.range.values() for end in ends]),
    ):
        for number in numbers:
            with mistakes.noting(("parameter", name, what)):
                check_number(name, number, draft, f"parameter.{name}.{what}")


def check_number(name: str, value: float, draft: Draft, about: str) -> None:
    """Refuse a value of a parameter that no case takes.

    Raises
    ------
    CalibrationError
        With what it is about, value and limits.
    """
    try:
        role = draft.layout.role(name)
        if role == "contact":
            check_contact(name, value)
        elif role == "effect":
            draft.layout.effects[name].check(value)
        elif role == "material":
            _check_material(name, value)
        else:
            before, _, bare = name.rpartition(".")
            owners = [before] if before else _owners(name, draft.layout)
            for owner in owners:
                draft.experiments[owner].apparatus(draft.run.scale, {bare: value})
    except CaseError as err:
        msg = f"{about}: {err}"
        raise CalibrationError(msg) from err


def _check_material(name: str, value: float) -> None:
    grains = {"d32_um": 1000.0, "density_kg_m3": 1000.0, name: value}
    try:
        Bulk.model_validate({"name": "grains", **grains})
    except ValueError as err:
        msg = f"{name} = {value:g} is not possible; look at the unit in its name"
        raise CaseError(msg) from err


def _owners(name: str, layout: Layout) -> list[str]:
    """Return the experiments of the study that have an apparatus parameter."""
    return sorted({p.experiment for p in layout.places if layout.has(p.experiment, name)})


def _tie(name: str, one: Parameter, layout: Layout, mistakes: Mistakes) -> None:
    """Note ties that hold nothing together."""
    if one.tie is None:
        return
    key = ("parameter", name, "tie")
    scope = layout.scope(name)
    if scope not in _DIMENSIONS[one.tie]:
        msg = (
            f"parameter.{name}: tie = '{one.tie}', but its scope is '{scope}', so that it does "
            f"not differ between {one.tie}s; take the tie out, or change the scope"
        )
        mistakes.add(key, msg)
    elif not layout.ties(name, one.tie):
        msg = (
            f"parameter.{name}: tie = '{one.tie}' has one member "
            f"({', '.join(layout.instances(name))}); a tie needs two, take it out"
        )
        mistakes.add(key, msg)


def _twice(name: str, draft: Draft, layout: Layout, mistakes: Mistakes) -> None:
    """Note an apparatus parameter that stands elsewhere too."""
    if layout.role(name) != "apparatus":
        return
    before, _, bare = name.rpartition(".")
    for number, rig in draft.rigs.items():
        if bare in rig.apparatus and before in ("", rig.name):
            msg = f"experiment {rig.name}: {bare} is also a parameter; give its value there only"
            mistakes.add(("experiment", number, "apparatus", bare), msg)
    if before and bare in draft.parameters and layout.has(before, bare):
        msg = f"'{name}' and '{bare}' are parameters for the same number; keep one"
        mistakes.add(("parameter", name), msg)


def _matching(one: Known, places: Iterable[Place]) -> list[Place]:
    """Return the places for which a measurement stands."""
    asked = (one.material, one.surface, one.experiment)
    return [
        place
        for place in places
        if all(w is None or w == here for w, here in zip(asked, place, strict=True))
    ]


def _known(name: str, number: int, one: Known, draft: Draft, mistakes: Mistakes) -> None:
    """Note measurements of what the study does not have, or that nothing can agree with."""
    key: Key = ("known", name, number)
    layout = draft.layout
    told = False
    for what, words in (
        ("material", [m.name for m in draft.materials.values()]),
        ("surface", [s.name for s in draft.surfaces.values()]),
        ("experiment", sorted({p.experiment for p in layout.places})),
    ):
        word = getattr(one, what)
        if word is not None and word not in words:
            mistakes.add(key, f"known.{name}: {what}: {unknown_name(word, words)}")
            told = True
    if told or not draft.complete:
        return
    if not any(layout.acts(name, place) for place in _matching(one, layout.places)):
        msg = f"known.{name}: it matters in no such experiment of the study; take it out"
        mistakes.add(key, msg)
    elif layout.role(name) == "effect":
        _known_effect(name, one, key, draft, mistakes)
    elif name not in draft.parameters:
        msg = f"known.{name}: no [parameter.{name}] uses it; free it there, or take this out"
        mistakes.add(key, msg)
    else:
        with mistakes.noting(key):
            check_number(name, one.value, draft, f"known.{name}")
            _check_in_range(name, one, draft)


def _check_in_range(name: str, one: Known, draft: Draft) -> None:
    """Refuse a measurement that no value within the range of its parameter can agree with.

    Raises
    ------
    CalibrationError
        With value and range.
    """
    layout, ranges = draft.layout, draft.parameters[name].range
    low, high = one.value - KNOWN_SPAN * one.se, one.value + KNOWN_SPAN * one.se
    for place in _matching(one, layout.places):
        instance = layout.instance(name, place)
        ends = None if instance is None else ranges.get(instance, ranges.get(""))
        if ends is not None and (high < min(ends) or low > max(ends)):
            msg = (
                f"known.{name}: {one.value:g} with standard error {one.se:g} lies outside its "
                f"range, {min(ends):g} to {max(ends):g}; widen the range under [parameter.{name}], "
                "or check the unit"
            )
            raise CalibrationError(msg)


def _known_effect(name: str, one: Known, key: Key, draft: Draft, mistakes: Mistakes) -> None:
    """Note measurements that no strength can agree with."""
    effect = draft.layout.effects[name]
    low, high = one.value - KNOWN_SPAN * one.se, one.value + KNOWN_SPAN * one.se
    if high < effect.low or low > effect.high:
        where = f"known.{name}: {one.value:g} with standard error {one.se:g}"
        limits = f"{effect.low:g} to {effect.high:g} {effect.unit}"
        mistakes.add(key, f"{where} lies outside {limits}; check its unit")


def _once(name: str, listed: Mapping[int, Known], layout: Layout, mistakes: Mistakes) -> None:
    """Note two measurements of one instance."""
    seen: dict[str, int] = {}
    for number, one in listed.items():
        found = (layout.site(name, place) for place in _matching(one, layout.places))
        for instance in {where for where in found if where is not None}:
            if seen.setdefault(instance, number) != number:
                which = f" of {instance}" if instance else ""
                msg = f"known.{name}: two measurements{which}; join them into one"
                mistakes.add(("known", name, number), msg)
