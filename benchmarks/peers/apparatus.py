"""The experiments of the comparison: places, ranges, a reduced apparatus and what is kept back.

Only documented numbers of the apparatus differ from the scale `quick` (`bulkcal apparatus`): fewer
grains, shorter pours and plates and the longest time step allowed. A run of all five places costs
about a sixth of `quick` and the observables still follow the parameters; `python -m
benchmarks.peers sensitivity` prints slopes and seed noise.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, NamedTuple

RANGES: Final = {
    "mu_pp": (0.1, 0.8),
    "mu_roll_pp": (0.03, 0.6),
    "mu_pw": (0.1, 0.8),
    "mu_roll_pw": (0.03, 0.6),
    "e_pp": (0.4, 0.9),
    "e_pw": (0.2, 0.9),
}
"""What every method is told about the six parameters."""

MATERIAL: Final = "Carbo HSP13"
SCALE: Final = "quick"

_HEAP: Final = {
    "timestep_fraction": 0.3,
    "slice_width_d": 2.5,
    "plate_half_length_d": 9.0,
    "pour_grains": 220.0,
    "pour_tau": 36.0,
    "settle_tau": 2.0,
    "frames": 20.0,
}
_CONVEYOR: Final = {
    "timestep_fraction": 0.3,
    "length_fraction": 0.05,
    "width_fraction": 0.09,
    "duration_flat_s": 12.5,
    "duration_glued_s": 20.5,
    "frames": 1.0,
}
_IMPACT: Final = {
    "timestep_fraction": 0.3,
    "mass_fraction": 0.05,
    "flight_s": 0.28,
    "frames": 1.0,
}


class Place(NamedTuple):
    """Where something is measured.

    Attributes
    ----------
    experiment, surface : str
    apparatus : Mapping of str to float
        Numbers that differ from the scale's.
    material : str
        A row of the table of particles.
    """

    experiment: str
    surface: str
    apparatus: Mapping[str, float]
    material: str = MATERIAL


PLACES: Final = {
    "heap/steel": Place("heap", "steel", _HEAP),
    "heap/glued": Place("heap", "glued", _HEAP),
    "conveyor/steel": Place("conveyor", "steel", _CONVEYOR),
    "conveyor/glued": Place("conveyor", "glued", _CONVEYOR),
    "plate_impact/steel": Place("plate_impact", "steel", _IMPACT),
}
"""One parameter vector is simulated at all of these: the unit in which budgets are given."""

KEPT_BACK: Final = {
    "heap/steel, twice the grains": Place(
        "heap",
        "steel",
        {**_HEAP, "pour_grains": 440.0, "pour_tau": 54.0, "plate_half_length_d": 12.0},
    ),
    "conveyor/steel, slower": Place("conveyor", "steel", {**_CONVEYOR, "period_s": 0.09}),
    "plate_impact/steel": PLACES["plate_impact/steel"],
}
"""Simulated at the truth and at every answer; no method sees them."""


class Measurement(NamedTuple):
    """One measured number.

    Attributes
    ----------
    place : str
        Its place.
    observable : str
    error : float
        Standard error in the tables of the paper (`cases/proppants`), in the observable's unit.
    """

    place: str
    observable: str
    error: float


TARGETS: Final = {
    "angle_steel": Measurement("heap/steel", "angle_deg", 0.16),
    "angle_glued": Measurement("heap/glued", "angle_deg", 0.61),
    "t100_steel": Measurement("conveyor/steel", "t100_s", 0.06),
    "t100_glued": Measurement("conveyor/glued", "t100_s", 0.02),
    "m1_steel": Measurement("plate_impact/steel", "m1_g", 0.15),
    "m2_steel": Measurement("plate_impact/steel", "m2_g", 0.09),
    "m3_steel": Measurement("plate_impact/steel", "m3_g", 0.04),
}
"""What is given to the methods."""

UNSEEN: Final = {
    "angle_more_grains": Measurement("heap/steel, twice the grains", "angle_deg", 0.16),
    "t100_slower": Measurement("conveyor/steel, slower", "t100_s", 0.06),
    "m4_steel": Measurement("plate_impact/steel", "m4_g", 0.03),
}
"""What an answer has to predict."""
