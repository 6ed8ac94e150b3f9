"""Apparatus and effects: what nothing uses, unknown names, values out of their limits."""

from __future__ import annotations

from calibrate.errors import unknown_name
from calibrate.study.draft import Draft, numbers_in, tables_in
from calibrate.study.mistakes import Mistakes
from liggghts_io.effects import check_engine

__all__ = ["check_rigs"]


def check_rigs(draft: Draft, mistakes: Mistakes) -> None:
    """Note mistakes in ``[[experiment]]`` and ``[effects]``."""
    _apparatus(draft, mistakes)
    _effects(draft, mistakes)


def _apparatus(draft: Draft, mistakes: Mistakes) -> None:
    """Note apparatus that nothing uses, unknown parameters, and values out of their limits."""
    used = {place.experiment for place in draft.places}
    for number, table in enumerate(tables_in(draft.data.get("experiment"))):
        name, key = table.get("name"), ("experiment", number)
        if not isinstance(name, str):
            continue
        if name not in draft.experiments:
            if "folder" not in table:  # else it is told what is wrong with the folder
                hint = unknown_name(name, draft.experiments)
                msg = f"experiment: {hint}; its own folder is named by 'folder'"
                mistakes.add((*key, "name"), msg)
            continue
        if draft.complete and name not in used:  # others are told already
            msg = (
                f"experiment: no target is measured in {name}, the study has "
                f"{', '.join(sorted(used))}; take it out, or add such a target"
            )
            mistakes.add((*key, "name"), msg)
        for word, value in numbers_in(table.get("apparatus")).items():
            with mistakes.noting((*key, "apparatus", word)):
                draft.experiments[name].apparatus(draft.run.scale, {word: value})


def _effects(draft: Draft, mistakes: Mistakes) -> None:
    """Note strengths out of range, effects that act nowhere here or that the engine lacks."""
    experiments = sorted({place.experiment for place in draft.places})
    effects, layout = draft.layout.effects, draft.layout
    for name, strength in draft.numbers("effects").items():
        key = ("effects", name)
        if draft.lacks(name):
            continue
        if name not in effects:
            mistakes.add(key, f"effects: {unknown_name(name, effects)}")
            continue
        effect = effects[name]
        with mistakes.noting(key):
            effect.check(strength)
            for material in draft.materials.values() if strength else ():
                effect.check_grains(material.particle)
        with mistakes.noting(key):
            check_engine({name: strength}, draft.run.engine, "effects")
        if strength and experiments and not layout.instances(name):
            where = ", ".join(effect.experiments) or "experiments with a template"
            msg = (
                f"effects: {name} acts in {where} only, and the study has "
                f"{', '.join(experiments)}; take it out, or add such a target"
            )
            mistakes.add(key, msg)
        if name in draft.parameters:
            msg = f"effects: {name} is also a parameter; give its strength there as value"
            mistakes.add(key, msg)
