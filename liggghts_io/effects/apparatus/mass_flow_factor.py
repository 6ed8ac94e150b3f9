"""The funnel of the conveyor gives more or less than the flow that was measured beforehand."""

from __future__ import annotations

from typing import Any, Final

from liggghts_io.effects.base import Effect
from liggghts_io.experiments.setup import Setup


def apply(variables: dict[str, Any], strength: float, _setup: Setup) -> dict[str, Any]:
    """Scale the rate at which grains appear; the poured mass stays."""
    return variables | {"grain_rate": variables["grain_rate"] * (1.0 + strength)}


MASS_FLOW_FACTOR: Final = Effect(
    name="mass_flow_factor",
    title="Funnel mass flow",
    unit="-",
    meaning="relative deviation of the funnel's flow from the measured one",
    scale=0.05,
    low=-0.5,
    high=0.5,
    settled_by="the funnel's flow weighed over time",
    settled_se=0.01,
    settled_hours=0.5,
    experiments=("conveyor",),
    apply=apply,
    # Table B.9 of Grobbel et al., Powder Technology 2019: each conveyor plate is fed by its own
    # funnel, and two of equal nominal size differ by up to a fifth.
    scope="funnel",
)
