"""Contacts are tangentially softer, or stiffer, than Mindlin's; an extension of minidem."""

from __future__ import annotations

from typing import Any, Final

from liggghts_io.effects.base import Effect
from liggghts_io.experiments.setup import Setup


def apply(variables: dict[str, Any], strength: float, _setup: Setup) -> dict[str, Any]:
    """Scale the tangential stiffness of contacts between grains and with the wall under test."""
    return variables | {"tangential_stiffness": 1.0 + strength}


TANGENTIAL_STIFFNESS: Final = Effect(
    name="tangential_stiffness",
    title="Tangential stiffness",
    unit="-",
    meaning="tangential stiffness of contacts over Mindlin's, less one",
    # Mindlin's k_t / k_n is 0.86 at a Poisson's ratio of 0.25, from 0.67 to 1 at all others
    scale=0.2,
    low=-0.8,
    high=1.0,
    settled_by="tangential restitution of single grains in steep impacts on the wall",
    settled_se=0.05,
    settled_hours=8.0,
    apply=apply,
    scope="material",
    extension="tangentialStiffness",
)
