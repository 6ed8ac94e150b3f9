"""Effects that a user's own experiment describes: a variable is added to or scaled."""

from __future__ import annotations

from typing import Any

from liggghts_io.effects.base import Effect
from liggghts_io.experiments.numbers import Adjustment
from liggghts_io.experiments.setup import Setup


def adjusting(one: Adjustment, experiment: str) -> Effect:
    """Return the effect that an own experiment describes, for that experiment alone."""

    def apply(variables: dict[str, Any], strength: float, _setup: Setup) -> dict[str, Any]:
        value = variables[one.variable]
        return variables | {
            one.variable: value + strength if one.how == "add" else value * (1.0 + strength)
        }

    return Effect(
        name=one.name,
        title=one.title,
        unit=one.unit,
        meaning=one.meaning,
        scale=one.step,
        low=one.low,
        high=one.high,
        settled_by=one.settled_by,
        settled_se=one.settled_se,
        settled_hours=one.settled_hours,
        apply=apply,
        experiments=(experiment,),
        candidate=one.candidate,
    )
