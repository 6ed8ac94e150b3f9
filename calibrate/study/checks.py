"""What the parts of a study have to do with each other and with the experiments.

Each check notes all that it finds; the first run starts only when nobody found anything.
"""

from __future__ import annotations

import math
import os
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from typing import Any, Final

from calibrate.errors import CalibrationError, unknown_name
from calibrate.study.cases import case_spec, middle
from calibrate.study.draft import Draft, numbers_in
from calibrate.study.mistakes import Key, Mistakes
from calibrate.study.model import Study
from liggghts_io.case.spec import BYTES_PER_GRAIN, build_case, check_particle, script_of
from liggghts_io.effects import EFFECTS, check_engine
from liggghts_io.errors import CaseError
from liggghts_io.experiments import EXPERIMENTS, SCALES
from liggghts_io.materials import CONTACT_PARAMETERS, check_contact

__all__ = ["check_cases", "check_parts"]

KNOWN_SPAN: Final = 3.0
"""Standard errors of an independent measurement within which a strength may lie."""


def check_parts(draft: Draft, mistakes: Mistakes) -> None:
    """Note every mistake that needs no measured data and no whole study."""
    _names(draft, mistakes)
    _grains(draft, mistakes)
    _stages(draft, mistakes)
    _fixed(draft, mistakes)
    _apparatus(draft, mistakes)
    _effects(draft, mistakes)
    _known(draft, mistakes)


@contextmanager
def _about(what: str) -> Iterator[None]:
    """Put what it is about in front of a refusal."""
    try:
        yield
    except (CalibrationError, CaseError) as err:
        msg = f"{what}: {err}"
        raise CalibrationError(msg) from err


def _names(draft: Draft, mistakes: Mistakes) -> None:
    """Note names that are given twice, and unknown names in the tables."""
    for what, names in (
        ("target", {number: one.name for number, one in draft.targets.items()}),
        ("curve", {number: one.name for number, one in draft.curves.items()}),
        ("stage", {number: one.name for number, one in draft.stages.items()}),
    ):
        seen: set[str] = set()
        for number, name in names.items():
            if name in seen:
                msg = f"{what} '{name}' appears twice; give each its own name"
                mistakes.add((what, number, "name"), msg)
            seen.add(name)
    known: tuple[tuple[str, Collection[str]], ...] = (
        ("published", CONTACT_PARAMETERS),
        ("apparatus", EXPERIMENTS),
        ("effects", EFFECTS),
        ("known", EFFECTS),
    )
    for table, words in known:
        for word in draft.table(table):
            if word not in words:
                mistakes.add((table, word), f"{table}: {unknown_name(word, words)}")


def _grains(draft: Draft, mistakes: Mistakes) -> None:
    """Note experiments that need to know more of the grains than is said."""
    for (experiment, surface), key in draft.places.items():
        if draft.particle:
            with mistakes.noting((*key, "experiment")):
                check_particle(draft.particle, experiment, surface, {})


def _stages(draft: Draft, mistakes: Mistakes) -> None:
    """Note targets that are unknown, and parameters that are, or are freed twice."""
    given = [one.get("name") for one in _listed_targets(draft)]
    names = [name for name in given if isinstance(name, str)]
    freed: set[str] = set()
    for number, stage in draft.stages.items():
        for word in stage.targets:
            if word not in names:
                msg = f"stage '{stage.name}': targets: {unknown_name(word, names)}"
                mistakes.add(("stage", number, "targets"), msg)
        for word, ends in stage.free.items():
            key = ("stage", number, "free", word)
            if word in freed:
                msg = f"freed parameter '{word}' appears twice; free each in one stage"
                mistakes.add(key, msg)
            freed.add(word)
            for end in ends:
                _contact(key, word, end, f"stage '{stage.name}': free", mistakes)


def _listed_targets(draft: Draft) -> list[dict[str, Any]]:
    """Return the targets as the file gives them, mistaken ones too."""
    listed = draft.data.get("target")
    return [one for one in listed if isinstance(one, dict)] if isinstance(listed, list) else []


def _contact(key: Key, word: str, value: float, about: str, mistakes: Mistakes) -> None:
    """Note an unknown contact parameter, or a value that the engines do not take."""
    if word not in CONTACT_PARAMETERS:
        mistakes.add(key, f"{about}: {unknown_name(word, CONTACT_PARAMETERS)}")
        return
    with mistakes.noting(key), _about(about):
        check_contact(word, value)


def _fixed(draft: Draft, mistakes: Mistakes) -> None:
    """Note values that the engines do not take, and parameters without any."""
    for word, value in draft.numbers("fixed").items():
        _contact(("fixed", word), word, value, "fixed", mistakes)
    first = draft.stages.get(0)
    given = {*draft.table("fixed"), *(first.free if first else CONTACT_PARAMETERS)}
    if not given <= {*CONTACT_PARAMETERS}:
        return  # a misspelt name is told already, and may be the one that is missing
    for word in CONTACT_PARAMETERS:
        if word not in given:
            msg = (
                f"'{word}' has no value before a stage frees it; add it under [fixed], for "
                f"example {word} = 0.3"
            )
            mistakes.add(("fixed",), msg)


def _apparatus(draft: Draft, mistakes: Mistakes) -> None:
    """Note apparatus that nothing uses, unknown parameters, and values out of their limits."""
    scale = draft.data.get("scale")
    words = [one.get("experiment") for one in _listed_targets(draft)]
    used = [word for word in words if isinstance(word, str) and word in EXPERIMENTS]
    for name, table in draft.table("apparatus").items():
        if name in EXPERIMENTS:
            if used and used == words and name not in used:  # others are told already
                msg = (
                    f"apparatus: no target is measured in {name}, the study has "
                    f"{', '.join(sorted(set(used)))}; take it out, or add such a target"
                )
                mistakes.add(("apparatus", name), msg)
            for word, value in numbers_in(table).items():
                with mistakes.noting(("apparatus", name, word)):
                    EXPERIMENTS[name].apparatus(
                        scale if scale in SCALES else SCALES[0], {word: value}
                    )


def _effects(draft: Draft, mistakes: Mistakes) -> None:
    """Note strengths out of range, effects that act nowhere here or that the engine lacks."""
    experiments = sorted({experiment for experiment, _ in draft.places})
    engine = draft.data.get("engine")
    for name, strength in draft.numbers("effects").items():
        if name not in EFFECTS:
            continue
        key, effect = ("effects", name), EFFECTS[name]
        with mistakes.noting(key):
            effect.check(strength)
            if strength and draft.particle:
                draft.particle.need(effect.needs, f"the effect {name}")
        with mistakes.noting(key):
            check_engine({name: strength}, engine if isinstance(engine, str) else "", "effects")
        if strength and experiments and not any(map(effect.acts_in, experiments)):
            msg = (
                f"effects: {name} acts in {', '.join(effect.experiments)} only, and the study has "
                f"{', '.join(experiments)}; take it out, or add such a target"
            )
            mistakes.add(key, msg)


def _known(draft: Draft, mistakes: Mistakes) -> None:
    """Note independent measurements that no strength can agree with, or that exclude zero."""
    on = draft.numbers("effects")
    for name, known in draft.known.items():
        if name not in EFFECTS:
            continue
        effect = EFFECTS[name]
        low, high = known.value - KNOWN_SPAN * known.sem, known.value + KNOWN_SPAN * known.sem
        where = f"known.{name}: {known.value:g} with standard error {known.sem:g}"
        if high < effect.low or low > effect.high:
            limits = f"{effect.low:g} to {effect.high:g} {effect.unit}"
            mistakes.add(("known", name), f"{where} lies outside {limits}; check its unit")
        elif not low <= 0.0 <= high and not on.get(name):
            msg = f"{where} excludes zero; switch it on instead: [effects] {name} = {known.value:g}"
            mistakes.add(("known", name), msg)


def _memory() -> float:
    """Return the memory of this machine [bytes], infinite where the system does not tell."""
    try:
        return float(os.sysconf("SC_PAGE_SIZE")) * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):
        return math.inf


def check_cases(study: Study, draft: Draft, mistakes: Mistakes) -> None:
    """Note experiments of which no script can be made, or that no machine can run.

    Parameters
    ----------
    study : Study
        The whole study, free of other mistakes.
    draft : Draft
        Its places.
    mistakes : Mistakes
    """
    memory = _memory()
    for place, key in draft.places.items():
        table = ("apparatus", place[0])
        with mistakes.noting(table if place[0] in study.apparatus else key):
            spec = case_spec(study, place, middle(study), study.seed)
            script_of(spec)
            need = build_case(spec).variables["grain_count"] * BYTES_PER_GRAIN
            if need > memory:
                msg = (
                    f"{place[0]} on {place[1]} needs about {need / 1e9:.1f} GB for its grains, "
                    f"and this machine has {memory / 1e9:.1f} GB; pour less, or take a smaller "
                    "scale"
                )
                raise CalibrationError(msg)
