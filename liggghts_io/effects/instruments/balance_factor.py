"""The balance shows more or less than lies on it."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from liggghts_io.effects.base import Effect
from liggghts_io.experiments.setup import Observed, Setup
from liggghts_io.measure.mass_time import MassTime, time_to_reach

_CURVE: Final = "mass_time.csv"


def read(observed: Observed, strength: float, setup: Setup) -> Observed:
    """Scale all masses that were read; the target mass is then reached at another time."""
    factor = 1.0 + strength
    units = ("_g", "_g_s")
    values = {k: v * factor if k.endswith(units) else v for k, v in observed.values.items()}
    tables = {
        file: {k: column * factor if k.endswith(units) else column for k, column in table.items()}
        for file, table in observed.tables.items()
    }
    if "t100_s" in values and _CURVE in tables:
        curve = MassTime(tables[_CURVE]["time_s"], 1e-3 * tables[_CURVE]["mass_g"])
        values["t100_s"] = time_to_reach(curve, setup.apparatus["target_mass_kg"])
    return replace(observed, values=values, tables=tables)


BALANCE_FACTOR: Final = Effect(
    name="balance_factor",
    title="Balance",
    unit="-",
    meaning="relative deviation of masses that were read from true ones",
    scale=0.01,
    low=-0.2,
    high=0.2,
    settled_by="a calibration weight of about the mass that is measured",
    settled_se=0.001,
    settled_hours=0.1,
    experiments=("conveyor", "plate_impact"),
    read=read,
)
