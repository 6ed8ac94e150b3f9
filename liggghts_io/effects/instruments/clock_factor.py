"""The clock of the scale runs fast or slow."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from liggghts_io.effects.base import Effect
from liggghts_io.experiments.setup import Observed, Setup


def read(observed: Observed, strength: float, _setup: Setup) -> Observed:
    """Stretch all times that were read; rates fall by as much."""
    factor = 1.0 + strength
    powers = (("_g_s", 1.0 / factor), ("_s", factor))

    def shown(name: str) -> float:
        return next((by for ending, by in powers if name.endswith(ending)), 1.0)

    values = {k: v * shown(k) for k, v in observed.values.items()}
    tables = {
        file: {k: column * shown(k) for k, column in table.items()}
        for file, table in observed.tables.items()
    }
    return replace(observed, values=values, tables=tables)


CLOCK_FACTOR: Final = Effect(
    name="clock_factor",
    title="Clock of the scale",
    unit="-",
    meaning="relative deviation of times that were read from true ones",
    scale=0.01,
    low=-0.2,
    high=0.2,
    settled_by="the scale's log of ten minutes beside another clock",
    settled_se=0.001,
    settled_hours=0.2,
    experiments=("conveyor",),
    read=read,
)
