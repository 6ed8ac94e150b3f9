"""Recorded runs of the engine, as an emulator takes them.

HSP13 at quick scale, Sobol points over `RANGES`; the tables in tests/data/emulator say with which
command they were made. Times are taken as logarithms, masses as square roots.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd

from calibrate.arrays import Array
from calibrate.emulator.types import Inputs, Output
from tests.paths import ROOT

RANGES: Final = {
    "mu_pp": (0.1, 0.8),
    "mu_roll_pp": (0.03, 0.6),
    "mu_pw": (0.1, 0.8),
    "mu_roll_pw": (0.03, 0.6),
    "e_pp": (0.4, 0.9),
    "e_pw": (0.2, 0.9),
}
"""Ranges of the columns of u; friction is spaced by its logarithm, restitution evenly."""
FOLDER: Final = ROOT / "tests" / "data" / "emulator"
PLACES: Final = {
    "heap steel": ("heap", "steel"),
    "heap glued": ("heap", "glued"),
    "conveyor steel": ("conveyor", "steel"),
    "conveyor glued": ("conveyor", "glued"),
    "plate impact": ("plate_impact", "steel"),
}
_SCALARS: Final = {"heap": ("angle_deg",), "plate_impact": ("m1_g", "m2_g", "m3_g", "m4_g")}
_LEVELS: Final = 10


@dataclass(frozen=True)
class Runs:
    """The runs of one place.

    Attributes
    ----------
    inputs : Inputs
        n runs; the glued places leave the parameters of the wall out.
    outputs : tuple of Output
        Angle, boxes, or the curve of the conveyor.
    y : (n, M) float64
        On the model scale.
    points : (n,) int
    parameters, effects : tuple of str
        What the columns of u and of the strengths are.
    """

    inputs: Inputs
    outputs: tuple[Output, ...]
    y: Array
    points: Array
    parameters: tuple[str, ...]
    effects: tuple[str, ...]

    def rows(self, which: Array) -> Runs:
        """Return some of the runs, by mask or indices."""
        return Runs(
            self.inputs.rows(which),
            self.outputs,
            self.y[which],
            self.points[which],
            self.parameters,
            self.effects,
        )


def read_runs(place: str, *, effects: bool = True) -> Runs:
    """Return the runs of a place.

    Parameters
    ----------
    place : str
        A key of `PLACES`.
    effects : bool
        False leaves the runs with an effect out, and the strengths without columns.
    """
    experiment, surface = PLACES[place]
    table = pd.read_csv(FOLDER / f"{experiment}.csv", comment="#").fillna({"effect": ""})
    table = table[table["surface"] == surface]
    table = (table if effects else table[table["effect"] == ""]).reset_index(drop=True)
    parameters = tuple(n for n in RANGES if surface != "glued" or not n.endswith("_pw"))
    points = pd.read_csv(FOLDER / "points.csv", comment="#").set_index("point")
    names = tuple(sorted(set(table["effect"]) - {""}))
    inputs = Inputs(
        points.loc[table["point"], list(parameters)].to_numpy(float),
        np.column_stack(
            [np.zeros((len(table), 0))]
            + [np.where(table["effect"] == n, table["strength"], 0.0) for n in names]
        ),
        table["seed"].to_numpy(float),
    )
    outputs, y = _outputs(experiment, table)
    return Runs(inputs, outputs, y, table["point"].to_numpy(), parameters, names)


def _outputs(experiment: str, table: pd.DataFrame) -> tuple[tuple[Output, ...], Array]:
    if experiment == "conveyor":
        columns = [f"t{10 * (k + 1)}_s" for k in range(_LEVELS)]
        curve = Output("mass_time", slice(0, _LEVELS))
        return (curve,), np.log(table[columns].to_numpy(float))
    names = _SCALARS[experiment]
    outputs = tuple(Output(name, slice(k, k + 1)) for k, name in enumerate(names))
    y = table[list(names)].to_numpy(float)
    return outputs, y if experiment == "heap" else np.sqrt(y)
