"""What a laboratory could measure alone of the unknowns of a study's base model."""

from __future__ import annotations

from typing import Final, NamedTuple

from calibrate.causes.offers import Feasible
from calibrate.questions.core.problem import unknown_at
from calibrate.study.model import Study
from calibrate.study.places import Place

__all__ = ["measured_unknowns"]


class Bench(NamedTuple):
    """How a contact parameter is measured alone.

    Attributes
    ----------
    words : str
    se : float
        Standard error of the parameter.
    hours : float
    """

    words: str
    se: float
    hours: float


BENCHES: Final = {
    # A degree on the plate is 0.0175 (1 + mu^2) of friction; ten tilts, a raft made before.
    "mu_pw": Bench("the angle at which a raft of grains slides on a tilted plate of", 0.02, 1.0),
    "mu_roll_pw": Bench("the angle at which single grains roll on a tilted plate of", 0.03, 1.0),
    # Twenty drops, filmed beside a ruler; grains differ by 0.1 from drop to drop.
    "e_pw": Bench("the rebound of single grains that are dropped on", 0.03, 2.0),
    "e_pp": Bench("the rebound of single grains that are dropped on grains of", 0.03, 4.0),
}
"""Friction and rolling friction between grains have no such test: nothing here measures them
alone."""


def measured_unknowns(study: Study) -> tuple[Feasible, ...]:
    """Return the measurements that tell one unknown of the base model, each once.

    Effects that the study frees are among them, by the measurement that settles them.

    Parameters
    ----------
    study : Study
    """
    found: dict[str, Feasible] = {}
    for name in study.parameters:
        for place in study.places:
            key = unknown_at(study, name, place)
            if key is not None and key not in found:
                one = _measured(study, name, place, key)
                found |= {key: one} if one is not None else {}
    return tuple(found.values())


def _measured(study: Study, name: str, place: Place, key: str) -> Feasible | None:
    instance = study.layout.instance(name, place) or ""
    called = f"{name}:{instance}" if len(study.instances(name)) > 1 else name
    if name in BENCHES:
        bench = BENCHES[name]
        against = place.surface if name.endswith("_pw") else place.material
        words = f"{bench.words} {against}"
        return Feasible(called, words, "-", bench.se, bench.hours, unknown=key)
    effect = study.layout.effects.get(name)
    if effect is None or effect.settled_se <= 0.0:
        return None
    words, se, hours = effect.settled_by, effect.settled_se, effect.settled_hours
    return Feasible(called, words, effect.unit, se, hours, unknown=key)
