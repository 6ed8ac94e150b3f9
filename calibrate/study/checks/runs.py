"""Cases of a study: that a script can be made of each, and that this machine can run it."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from typing import Final

from calibrate.errors import CalibrationError
from calibrate.study.cases import Values, case_spec, middle
from calibrate.study.draft import Draft
from calibrate.study.mistakes import Mistakes
from calibrate.study.model import Study
from calibrate.study.places import Place
from liggghts_io.case.spec import BYTES_PER_GRAIN, script_of
from liggghts_io.errors import CaseError
from liggghts_io.measure.schedule import load_of
from liggghts_io.sizes import coarse_restitution

__all__ = ["check_runs"]

RESTITUTION: Final = "e_pp"
COARSE: Final = "coarse_graining"


def _memory() -> float:
    """Return the memory of this machine [bytes], infinite where the system does not tell."""
    try:
        return float(os.sysconf("SC_PAGE_SIZE")) * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):
        return math.inf


def check_runs(study: Study, draft: Draft, mistakes: Mistakes) -> None:
    """Note places of which no script can be made, or that no machine can run.

    Parameters
    ----------
    study : Study
        The whole study, free of other mistakes.
    draft : Draft
        Its places.
    mistakes : Mistakes
    """
    memory, values = _memory(), middle(study)
    rigs = {rig.name: ("experiment", number) for number, rig in draft.rigs.items()}
    impossible = _check_restitution(study, mistakes)
    for place, key in draft.places.items():
        if place.material in impossible:
            continue
        with mistakes.noting(rigs.get(place.experiment, key)):
            spec = case_spec(study, place, values, study.run.seed)
            need = load_of(script_of(spec)).grains * BYTES_PER_GRAIN
            if need > memory:
                msg = (
                    f"{place.experiment} on {place.surface} needs about {need / 1e9:.1f} GB for "
                    f"its grains, and this machine has {memory / 1e9:.1f} GB; pour less, or take "
                    "a smaller scale"
                )
                raise CalibrationError(msg)
            for ends in _ends_of_grains(study, place, values):
                case_spec(study, place, ends, study.run.seed)


def _ends_of_grains(study: Study, place: Place, values: Values) -> Iterator[Values]:
    """Yield the ends of the ranges of numbers of the material, all else in the middle."""
    for name, instance in study.free:
        here = study.layout.instance(name, place) == instance
        if here and study.layout.role(name) == "material":
            for end in study.range_of(name, instance) or ():
                yield {**values, (name, instance): end}


def _check_restitution(study: Study, mistakes: Mistakes) -> set[str]:
    """Note ranges of restitution that coarse grains cannot stand for; return their materials."""
    found: dict[str, str] = {}
    for place in study.places:
        instance = study.layout.instance(RESTITUTION, place)
        if instance is None or place.material in found:
            continue
        stages = [stage for stage in study.stages if stage.material == place.material]
        ends = [study.range_of(RESTITUTION, instance, stage) for stage in (None, *stages)]
        lowest = min((min(span) for span in ends if span is not None), default=1.0)
        factor = study.value_of(COARSE, *place) or 1.0
        try:
            coarse_restitution(lowest, factor)
        except CaseError as err:
            found[place.material] = f"material '{place.material}': {err}"
    for message in found.values():
        mistakes.add(("parameter", RESTITUTION), message)
    return set(found)
