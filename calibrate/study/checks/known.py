"""Independent measurements of a study: more of them, and those that a calibration does not use."""

from __future__ import annotations

from collections.abc import Sequence

from calibrate.study.checks.parameters import KNOWN_SPAN, check_known
from calibrate.study.draft import Draft
from calibrate.study.mistakes import Lines, Mistakes
from calibrate.study.model import Study
from calibrate.study.schema.settings import Known

__all__ = ["known_at", "unheeded", "with_known"]


def known_at(study: Study, name: str, where: str, value: float, se: float) -> Known:
    """Return a measurement as ``[known.NAME]`` says it.

    Parameters
    ----------
    study : Study
    name : str
        Parameter or effect.
    where : str
        One of the sites of its `Layout.site`; empty for all of them.
    value, se : float
        In the unit of what was measured.
    """
    if not where:
        return Known(value=value, se=se)
    place = next(one for one in study.places if study.layout.site(name, one) == where)
    return Known(
        value=value, se=se, material=place.material, surface=place.surface,
        experiment=place.experiment,
    )  # fmt: skip


def with_known(
    study: Study, given: Sequence[tuple[str, Known]], called: str
) -> tuple[Study, list[str]]:
    """Return a study with further measurements, and the names of those that they replace.

    What was known of the same number is replaced; everything is checked as in a file.

    Parameters
    ----------
    study : Study
    given : sequence of (str, Known)
        Parameter or effect, and what was measured of it.
    called : str
        What they are called in messages instead of the file.

    Raises
    ------
    StudyError
        With all that is wrong.
    """
    known = {name: list(listed) for name, listed in study.known.items()}
    replaced = []
    for name in dict.fromkeys(name for name, _ in given):
        new = [one for other, one in given if other == name]
        sites = {site for one in new for site in _sites(study, name, one)}
        old = [one for one in known.get(name, []) if sites & _sites(study, name, one)]
        replaced += [f"{name} = {one.value:g} ± {one.se:g}" for one in old]
        known[name] = [*new, *(one for one in known.get(name, []) if one not in old)]
    more = study.model_copy(update={"known": known})
    mistakes = Mistakes(called, Lines(""))
    check_known(_draft(more), mistakes)
    mistakes.tell()
    return more, replaced


def _sites(study: Study, name: str, one: Known) -> set[str]:
    """Return where a measurement of a number holds."""
    wanted = one.material, one.surface, one.experiment
    found = (
        study.layout.site(name, place)
        for place in study.places
        if all(word is None or word == here for word, here in zip(wanted, place, strict=True))
    )
    return {site for site in found if site is not None}


def _draft(study: Study) -> Draft:
    """Return a whole study as the checks of its parts take it."""
    return Draft(
        data={"target": study.targets, "effects": study.effects},
        experiments=study.experiments,
        run=study.run,
        materials=dict(enumerate(study.materials)),
        surfaces=dict(enumerate(study.surfaces)),
        rigs=dict(enumerate(study.rigs)),
        targets=dict(enumerate(study.targets)),
        shared=dict(enumerate(study.shared)),
        stages=dict(enumerate(study.stages)),
        parameters=study.parameters,
        known={name: dict(enumerate(listed)) for name, listed in study.known.items()},
    )


def unheeded(study: Study) -> list[str]:
    """Say which measurements a calibration does not use: effects that are off and were not zero.

    Parameters
    ----------
    study : Study
    """
    off = {
        name: listed
        for name, listed in study.known.items()
        if study.layout.role(name) == "effect"
        and name not in study.parameters
        and not study.effects.get(name)
    }
    return [
        f"known.{name}: {one.value:g} with standard error {one.se:g} excludes zero, and a "
        f"calibration has it at zero; switch it on: [effects] {name} = {one.value:g}, or weigh it "
        "as a cause: 'bulkcal diagnose'"
        for name, listed in off.items()
        for one in listed
        if abs(one.value) > KNOWN_SPAN * one.se
    ]
