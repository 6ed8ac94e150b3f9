"""HSP13 on steel from disjoint halves of recorded engine runs: the answers have to agree."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from calibrate.emulator.emulator import train_emulator
from calibrate.inference.priors import Prior
from calibrate.inference.problem import Place, Problem, Reading, Source
from calibrate.inference.sampling import sample
from calibrate.inference.space import Space, Unknown
from tests.calibrate.emulator.recorded import PLACES, RANGES, read_runs
from tests.paths import CASES

ROWS = {"heap steel": "steel", "heap glued": "glued", "conveyor steel": "steel",
        "conveyor glued": "glued", "plate impact": "steel"}  # fmt: skip


def measured(place: str) -> tuple[list[float], list[float]]:
    """Return values and errors on the model scale, of Tables B.5 and B.6 of the paper."""
    experiment = PLACES[place][0]
    file = "angle_of_repose" if experiment == "heap" else experiment
    table = pd.read_csv(CASES / f"{file}.csv", comment="#")
    row = table[(table["particle"] == "Carbo HSP13") & (table["surface"] == ROWS[place])].iloc[0]
    if experiment == "heap":
        return [row["angle_deg"]], [row["sem_deg"]]
    if experiment == "conveyor":
        return [np.log(row["t100_s"])], [row["sem_s"] / row["t100_s"]]
    boxes = (1, 2, 3)
    values = [np.sqrt(row[f"m{k}_g"]) for k in boxes]
    return values, [row[f"m{k}_sem"] / (2.0 * np.sqrt(row[f"m{k}_g"])) for k in boxes]


def problem_of_half(half: int) -> Problem:
    """Return the problem whose emulators know every second point."""
    names = list(RANGES)
    unknowns = tuple(
        Unknown(n, "", Prior.uniform(*RANGES[n], "log" if n.startswith("mu") else "linear"))
        for n in names
    )
    places = []
    for name in PLACES:
        runs = read_runs(name, effects=False)
        runs = runs.rows(np.flatnonzero(runs.points % 2 == half))
        # The last column of the conveyor's curve is the time for 100 g; boxes 1 to 3 are used.
        keep = [-1] if name.startswith("conveyor") else [0, 1, 2][: runs.y.shape[1]]
        y = runs.y[:, keep]
        outputs = [type(runs.outputs[0])(f"y{k}", slice(k, k + 1)) for k in range(len(keep))]
        emulator = train_emulator(runs.inputs, outputs, y)
        values, errors = measured(name)
        readings = tuple(
            Reading(f"{name} {k}", slice(k, k + 1), np.array([v]), np.array([e]))
            for k, (v, e) in enumerate(zip(values, errors, strict=True))
        )
        sources = tuple(
            Source(names.index(p), 0.0, *RANGES[p], "log" if p.startswith("mu") else "linear")
            for p in runs.parameters
        )
        places.append(Place(name, emulator, sources, (), readings))
    return Problem(Space(unknowns), tuple(places))


@pytest.fixture(scope="module")
def halves():
    return [sample(problem_of_half(half), np.random.default_rng(half)) for half in (0, 1)]


@pytest.mark.slow
def test_intervals_of_disjoint_designs_overlap(halves) -> None:
    one, other = halves
    for name in one.names:
        a, b = one.interval(name, 0.9), other.interval(name, 0.9)
        assert max(a.low, b.low) < min(a.high, b.high), name
