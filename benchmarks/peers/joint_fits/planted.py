"""Planted data for joint fits: two materials on one wall, and one material on two walls.

Where materials share a wall, the parameters against the wall are the same for both; where a
material meets two walls, its parameters between grains are. A joint fit must find intervals that
cover, and the shared parameters must be narrower than from either material or wall alone.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np
from scipy.stats import qmc

from benchmarks.peers.apparatus import MATERIAL, PLACES, RANGES, TARGETS, Place
from benchmarks.peers.problem import Array, draw_seed, observed
from benchmarks.peers.simulator import Simulator
from benchmarks.peers.truths import MARGIN, SEED, mean_error

SETS: Final = 8
"""Planted sets of each kind."""
OTHER: Final = "SG10H"
WALLS: Final = ("steel", "other steel")
_WALL: Final = "_pw"

KINDS: Final = {
    "two materials, one wall": ((MATERIAL, WALLS[0]), (OTHER, WALLS[0])),
    "one material, two walls": ((MATERIAL, WALLS[0]), (MATERIAL, WALLS[1])),
}
"""Pairs of material and wall that are measured together."""


def instances(pairs: Sequence[tuple[str, str]]) -> list[tuple[str, str]]:
    """Return every unknown of a kind as parameter and what it belongs to, in a fixed order."""
    owners = {
        name: [wall if name.endswith(_WALL) else material for material, wall in pairs]
        for name in RANGES
    }
    return [(name, owner) for name in RANGES for owner in dict.fromkeys(owners[name])]


def true_values(kind: str, number: int) -> dict[str, dict[str, float]]:
    """Return the planted parameters of set `number`: by name and by material or wall."""
    unknowns = instances(KINDS[kind])
    rng = np.random.default_rng([SEED, list(KINDS).index(kind), 2])
    unit = qmc.LatinHypercube(len(unknowns), rng=rng).random(SETS)[number]
    values: dict[str, dict[str, float]] = {name: {} for name in RANGES}
    for (name, owner), u in zip(unknowns, unit, strict=True):
        low, high = RANGES[name]
        values[name][owner] = float(low + (high - low) * (MARGIN + (1.0 - 2.0 * MARGIN) * u))
    return values


def plant_set(simulator: Simulator, kind: str, number: int, seeds: int) -> dict[str, Any]:
    """Simulate a set and return its truth and measured targets as plain data.

    Parameters
    ----------
    simulator : Simulator
    kind : str
        A key of `KINDS`.
    number : int
        Below `SETS`.
    seeds : int
        Runs behind every measured mean.

    Returns
    -------
    dict
        kind, number, truth (parameter to material or wall to value), and targets: a list of
        material, wall, name, experiment, surface, observable, value, error. Glued plates are
        measured once per material.
    """
    rng = np.random.default_rng([SEED, list(KINDS).index(kind), number, 3])
    truth = true_values(kind, number)
    targets: dict[tuple[str, ...], dict[str, Any]] = {}
    for material, wall in KINDS[kind]:
        theta = {
            name: owners[wall if name.endswith(_WALL) else material]
            for name, owners in truth.items()
        }
        for row in _measure(simulator, material, theta, seeds, rng):
            where = "glued" if row["surface"] == "glued" else wall
            entry = {"material": material, "wall": where, **row}
            targets.setdefault((material, where, row["name"]), entry)
    return {"kind": kind, "number": number, "truth": truth, "targets": list(targets.values())}


def _measure(
    simulator: Simulator,
    material: str,
    theta: Mapping[str, float],
    seeds: int,
    rng: np.random.Generator,
) -> list[dict[str, Any]]:
    """Return the targets of a material as means over seeds with the error of `truths.plant`."""
    places: dict[str, Place] = {
        name: place._replace(material=material) for name, place in PLACES.items()
    }
    runs = [
        {name: simulator.run(place, theta, seed).observables for name, place in places.items()}
        for seed in [draw_seed(rng) for _ in range(seeds)]
    ]
    rows = []
    for name, target in TARGETS.items():
        y: Array = np.array([observed(run, [target])[0] for run in runs])
        own = mean_error(y)
        error = max(own, target.error)
        value = float(np.nanmean(y) + rng.normal() * np.sqrt(error**2 - own**2))
        place = PLACES[target.place]
        rows.append(
            {
                "name": name,
                "experiment": place.experiment,
                "surface": place.surface,
                "observable": target.observable,
                "value": value,
                "error": error,
            }
        )
    return rows
