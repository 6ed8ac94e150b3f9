"""Joint fits of planted sets, and the fits of their halves from the same runs.

A set has two materials on one wall, or one material on two walls. What the halves share should be
known better together than from either half alone. Halves and what is measured once for both (the
glued plates of one material) are fitted with the runs of the joint calibration, so that nothing
but the data differs.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
from threadpoolctl import threadpool_limits

from benchmarks.peers.apparatus import RANGES
from benchmarks.peers.joint_fits.planted import KINDS, plant_set
from benchmarks.peers.lines import append_line, read_lines
from benchmarks.peers.problem import Problem
from benchmarks.peers.simulator import Simulator
from benchmarks.peers.study import Planted, counting_runner, planted_study
from benchmarks.peers.truths import SEED
from calibrate.inference.posterior import Posterior
from calibrate.inference.sampling import sample
from calibrate.questions.core.emulate import emulators_of
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.problem import problem_of
from calibrate.questions.core.runs import Runs
from calibrate.questions.joint.calibration import calibrate_jointly
from liggghts_io.materials import GLUED

FITS: Final = "joint_fits.jsonl"
SEEDS: Final = 20
"""Runs behind every measured mean."""
RUNS: Final = 400
"""Runs of a joint calibration of two halves, its check among them."""
CHECK_RUNS: Final = 20
"""Two seeds at ten places."""
LEVEL: Final = 0.9
UNIFORM_SD: Final = 12**-0.5
"""What is known of an unknown without data."""


def fit_all(
    folder: Path,
    simulator: Simulator,
    sets: int,
    runs: int = RUNS,
    tell: Callable[[str], None] = print,
) -> None:
    """Plant and fit sets that are not on disk yet, kinds in turn, a line for each unknown.

    Parameters
    ----------
    folder : Path
        Of the campaign.
    simulator : Simulator
    sets : int
        Of each kind.
    runs : int
        Budget of a joint calibration.
    tell : callable
        Receives a line per set.
    """
    file = folder / FITS
    done = {(line["kind"], line["number"]) for line in read_lines(file) if line["last"]}
    for number in range(sets):
        for kind in KINDS:
            if (kind, number) in done:
                continue
            rows = fit_set(simulator, plant_set(simulator, kind, number, SEEDS), runs)
            for row in rows:
                append_line(file, row | {"last": row is rows[-1]})
            tell(f"{kind}, set {number}")


def fit_set(
    simulator: Simulator, planted: Mapping[str, Any], runs: int = RUNS
) -> list[dict[str, Any]]:
    """Fit a set jointly and its halves.

    Parameters
    ----------
    simulator : Simulator
    planted : mapping
        From `planted.plant_set`.
    runs : int
        Budget of the joint calibration.

    Returns
    -------
    list of dict
        A row per unknown: kind, number, parameter, owner, shared, true, and, as parts of the
        range, error of the mean, sd, width of the 90 % interval and whether it covers; ``halves``
        holds the sd of each half that has the unknown, ``common`` that from the targets which both
        have; runs, and particle_steps of all of them.
    """
    kind, number = planted["kind"], planted["number"]
    targets = [_planted(entry, k) for k, entry in enumerate(planted["targets"])]
    problem = Problem({}, {}, simulator, np.random.default_rng(0))
    seed = int(np.random.default_rng([SEED, list(KINDS).index(kind), number, 4]).integers(1, 2**30))
    design = {"runs": runs - CHECK_RUNS, "check_seeds": 2, "check_draws": 0}
    result = calibrate_jointly(planted_study(targets, seed, design), counting_runner(problem))
    halves = [_targets_at(targets, pair) for pair in KINDS[kind]]
    common = [one for one in halves[0] if one in halves[1]]
    fitted = [_fitted(half, result.runs, seed) for half in halves]
    before = _fitted(common, result.runs, seed) if common else None
    rows = []
    for name, (low, high) in RANGES.items():
        for owner, true in planted["truth"][name].items():
            known = _known(result.posterior, name, owner)
            parts = [
                _known(half, name, owner)["sd"]
                for half, pair in zip(fitted, KINDS[kind], strict=True)
                if owner in pair
            ]
            both = before is not None and name in before.names
            rows.append(
                {
                    "kind": kind,
                    "number": number,
                    "parameter": name,
                    "owner": owner,
                    "shared": len(parts) > 1,
                    "true": true,
                    "error": known["mean"] - (true - low) / (high - low),
                    "sd": known["sd"],
                    "width": known["high"] - known["low"],
                    "covered": known["low"] <= (true - low) / (high - low) <= known["high"],
                    "halves": parts,
                    "common": _known(before, name, owner)["sd"] if before and both else UNIFORM_SD,
                    "runs": problem.cost.runs,
                    "particle_steps": problem.cost.particle_steps,
                }
            )
    return rows


def _planted(entry: Mapping[str, Any], number: int) -> Planted:
    return Planted(
        f"{entry['name']}_{number}", entry["material"], entry["wall"], entry["experiment"],
        entry["observable"], entry["value"], entry["error"],
    )  # fmt: skip


def _targets_at(targets: Sequence[Planted], pair: tuple[str, str]) -> list[Planted]:
    """Return the targets of one material on one wall, those on glued plates among them."""
    material, wall = pair
    return [one for one in targets if one.material == material and one.wall in (wall, GLUED)]


def _fitted(targets: Sequence[Planted], runs: Runs, seed: int) -> Posterior:
    """Return the posterior of some targets of one material, from the runs with this material."""
    data = planted_study(targets, seed, {})
    forms = forms_of(data)
    own = [spec.particle.name == targets[0].material for spec in runs.specs]
    kept = tuple(spec for spec, keep in zip(runs.specs, own, strict=True) if keep)
    emulators = emulators_of(forms, Runs(kept, runs.table[own].reset_index(drop=True)))
    trained = {key: one.emulator for key, one in emulators.trained.items()}
    with threadpool_limits(limits=1):
        return sample(problem_of(data, forms, trained), np.random.default_rng(seed))


def _known(posterior: Posterior, name: str, owner: str) -> dict[str, float]:
    """Return mean, sd and 90 % interval of an unknown as parts of its range."""
    column = name if name in posterior.names else f"{name}[{owner}]"
    low, high = RANGES[name]
    values = (posterior.column(column) - low) / (high - low)
    span = posterior.interval(column, LEVEL)
    return {
        "mean": float(values.mean()),
        "sd": float(values.std(ddof=1)),
        "low": (span.low - low) / (high - low),
        "high": (span.high - low) / (high - low),
    }
