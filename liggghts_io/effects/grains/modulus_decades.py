"""Grains are stiffer than simulated, as all are: no engine takes a modulus below the usual one."""

from __future__ import annotations

from typing import Any, Final

from liggghts_io.effects.base import Effect
from liggghts_io.experiments.setup import Setup


def apply(variables: dict[str, Any], strength: float, _setup: Setup) -> dict[str, Any]:
    """Multiply Young's modulus by a power of ten; the time step follows."""
    return variables | {"youngs_modulus": variables["youngs_modulus"] * 10.0**strength}


MODULUS_DECADES: Final = Effect(
    name="modulus_decades",
    title="Young's modulus",
    unit="-",
    meaning="decimal logarithm of the true over the simulated Young's modulus",
    scale=0.5,
    low=0.0,
    high=1.0,
    settled_by="two runs of each experiment with a modulus ten times higher",
    settled_se=0.2,
    settled_hours=1.0,
    apply=apply,
    scope="material",
)
