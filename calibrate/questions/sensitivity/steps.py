"""The runs of a study of one parameter at a time, each at several values and seeds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from calibrate.questions.core.problem import place_name
from calibrate.questions.sensitivity.baseline import Varied, varied_at
from calibrate.study.cases import case_spec
from calibrate.study.model import Study
from calibrate.study.places import Place
from liggghts_io import CaseSpec
from liggghts_io.case.spec import script_of

__all__ = ["LEVELS", "SEEDS", "Series", "distinct_places", "series_of", "specs_of"]

LEVELS: Final = 5
"""Values over the range of a parameter; the baseline comes on top."""
SEEDS: Final = 3
"""Runs of every value; their scatter is what a curve has to stand out from."""
FIRST_SEED: Final = 4_000_000
"""Added to the study's seed, far from those of stages, designs and checks."""


@dataclass(frozen=True)
class Series:
    """One parameter varied at one place, all others at the baseline.

    Attributes
    ----------
    place : Place
    where : str
        The place in words, with all surfaces on which these very cases stand for it.
    varied : Varied
    values : tuple of float
        V values, rising, the baseline among them.
    specs : tuple of tuple of CaseSpec
        V by S, a seed in each column.
    """

    place: Place
    where: str
    varied: Varied
    values: tuple[float, ...]
    specs: tuple[tuple[CaseSpec, ...], ...]


def series_of(
    study: Study,
    baseline: Mapping[tuple[str, str], float],
    levels: int = LEVELS,
    seeds: int = SEEDS,
) -> list[Series]:
    """Return every parameter at every place where it is in the script.

    Places that would run the same cases are one.

    Parameters
    ----------
    study : Study
    baseline : mapping
        By name and instance, from `baseline_of`.
    levels : int
        Values over each range.
    seeds : int
        Runs of each value.

    Raises
    ------
    CalibrationError
        When a contact parameter has no value.
    """
    if levels == 0:
        return []
    numbers = [study.run.seed + FIRST_SEED + k for k in range(seeds)]
    found: list[Series] = []
    alike: dict[str, list[Place]] = {}
    for place in study.places:
        every = (
            _series(study, place, baseline, one, levels, numbers)
            for one in varied_at(study, place, baseline)
        )
        here = [one for one in every if _acts(one)]
        same = alike.setdefault(repr([(one.values, one.specs) for one in here]), [])
        same.append(place)
        if len(same) == 1:
            found += here
    words = {places[0]: _words(places) for places in alike.values()}
    return [Series(s.place, words[s.place], s.varied, s.values, s.specs) for s in found]


def _acts(series: Series) -> bool:
    """Whether a parameter is in the script at all; a script of one's own may not ask for it."""
    return script_of(series.specs[0][0]) != script_of(series.specs[-1][0])


def _words(places: Sequence[Place]) -> str:
    """Return places that differ in their surface only in words.

    Examples
    --------
    >>> _words([Place("A", "steel", "heap"), Place("A", "alumina", "heap")])
    'heap of A on steel, alumina'
    """
    return ", ".join([place_name(places[0]), *(place.surface for place in places[1:])])


def _series(
    study: Study,
    place: Place,
    baseline: Mapping[tuple[str, str], float],
    varied: Varied,
    levels: int,
    seeds: Sequence[int],
) -> Series:
    values = varied.values(levels)
    specs = tuple(
        tuple(
            case_spec(study, place, {**baseline, (varied.name, varied.instance): value}, seed)
            for seed in seeds
        )
        for value in values
    )
    return Series(place, "", varied, values, specs)


def distinct_places(study: Study, series: Sequence[Series]) -> dict[Place, str]:
    """Return places with their words, those that would run the same cases once."""
    return {one.place: one.where for one in series} or {p: place_name(p) for p in study.places}


def specs_of(series: Sequence[Series]) -> list[CaseSpec]:
    """Return all cases, each once; all parameters of a place share its baseline."""
    every = (spec for one in series for row in one.specs for spec in row)
    return list({repr(spec): spec for spec in every}.values())
