"""Grains resist spinning about the line of contact too, and not rolling alone."""

from __future__ import annotations

from typing import Any, Final

from liggghts_io.effects.base import Effect
from liggghts_io.experiments.setup import Setup


def apply(variables: dict[str, Any], _strength: float, _setup: Setup) -> dict[str, Any]:
    """Let the rolling resistance act on the whole relative spin."""
    return variables | {"torsion": True}


TORSION: Final = Effect(
    name="torsion",
    title="Torsion resistance",
    unit="-",
    meaning="rolling friction acts on spin about the contact normal too",
    scale=1.0,
    low=0.0,
    high=1.0,
    settled_by="how long a grain spins on the wall about the vertical",
    settled_se=0.1,
    settled_hours=0.5,
    apply=apply,
    switch=True,
)
