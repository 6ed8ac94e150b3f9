"""Rough grains rebound differently each time: restitution scatters; an extension of minidem."""

from __future__ import annotations

from typing import Any, Final

from liggghts_io.effects.base import Effect
from liggghts_io.experiments.setup import Setup


def apply(variables: dict[str, Any], strength: float, _setup: Setup) -> dict[str, Any]:
    """Let restitution between grains and on the wall under test differ from contact to contact."""
    return variables | {"restitution_scatter": strength}


RESTITUTION_SCATTER: Final = Effect(
    name="restitution_scatter",
    title="Restitution scatters",
    unit="-",
    meaning="standard deviation of restitution over contacts, as a part of its mean; e is cut at 1",
    scale=0.1,
    low=0.0,
    high=0.5,
    settled_by="drop tests of many single grains",
    settled_se=0.02,
    settled_hours=4.0,
    apply=apply,
    scope="material",
    extension="restitutionScatter",
)
