"""What a study will cost on this machine: one cheap case per experiment is run and timed.

Stated model: a run takes time in proportion to its time steps times the grains that are in it on
average. The probe is the experiment at the smallest scale, without the study's overrides of the
apparatus; grains leave the simulation at another rate in other set-ups, crowd caches at larger
scales, and share the machine with other runs, so the estimate is right to a factor, not to a
per cent.
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from calibrate.study.cases import case_spec, middle, planned_at_most
from calibrate.study.model import Study
from calibrate.study.places import Place
from liggghts_io import CaseResult, CaseSpec, execute, experiment_of
from liggghts_io.case.spec import BYTES_PER_GRAIN, build_case, script_of
from liggghts_io.experiments import SCALES
from liggghts_io.measure.schedule import load_of, schedule_of
from liggghts_io.scripts.filters import steps

__all__ = ["Cost", "PlaceCost", "cost_of", "work_of"]

NEAR: Final = 2.0
"""Factor of uncertainty where probe and run have the same scale."""
FAR: Final = 4.0
"""The same from one scale to another."""


@dataclass(frozen=True)
class PlaceCost:
    """Cost of one place of a study.

    Attributes
    ----------
    material, surface, experiment : str
    runs : int
        Planned runs.
    steps : int
        Time steps of a run.
    grains : float
        Grains that are poured in a run.
    run_s : float
        Time of a run on one core [s]; nan when the probe failed.
    disk_mb : float
        What a run leaves on disk [MB]; nan when the probe failed.
    memory_mb : float
        What a run keeps in memory [MB], without the program.
    """

    material: str
    surface: str
    experiment: str
    runs: int
    steps: int
    grains: float
    run_s: float
    disk_mb: float
    memory_mb: float


@dataclass(frozen=True)
class Cost:
    """Cost of a study.

    Attributes
    ----------
    places : tuple of PlaceCost
    workers : int
        Processes.
    factor : float
        By how much times may be wrong in either direction.
    failed : tuple of str
        Why probes failed, if they did.
    """

    places: tuple[PlaceCost, ...]
    workers: int
    factor: float
    failed: tuple[str, ...]

    @property
    def runs(self) -> int:
        """Planned runs, at most."""
        return sum(one.runs for one in self.places)

    @property
    def wall_s(self) -> float:
        """Time of all runs on all processes [s]."""
        return sum(one.runs * one.run_s for one in self.places) / self.workers

    @property
    def disk_mb(self) -> float:
        """What all runs leave on disk [MB]."""
        return sum(one.runs * one.disk_mb for one in self.places)


def cost_of(
    study: Study,
    workers: int,
    run: Callable[[CaseSpec, Path], CaseResult] = execute,
    tell: Callable[[str], None] = lambda _line: None,
) -> Cost:
    """Run the probes and extrapolate.

    Parameters
    ----------
    study : Study
        Checked study.
    workers : int
        Processes that will share the work.
    run : callable
        Runs a case under a directory.
    tell : callable
        Receives a line before each probe.
    """
    values, runs = middle(study), planned_at_most(study)
    specs = {place: case_spec(study, place, values, study.run.seed) for place in runs}
    probes: dict[str, _Probe] = {}
    failed: list[str] = []
    with tempfile.TemporaryDirectory() as scratch:
        for place, spec in specs.items():
            experiment = place.experiment
            if experiment not in probes:
                tell(f"probe: {experiment} on {place.surface} at scale '{SCALES[0]}'")
                probes[experiment] = _probe(spec, run, Path(scratch))
                if probes[experiment].reason:
                    failed.append(f"{experiment}: {probes[experiment].reason}")
    places = [_cost(place, spec, runs[place], probes[place.experiment])
              for place, spec in specs.items()]  # fmt: skip
    changed = any(rig.apparatus for rig in study.rigs)
    same = study.run.scale == SCALES[0] and not changed and study.run.engine == "minidem"
    return Cost(tuple(places), workers, NEAR if same else FAR, tuple(failed))


def work_of(spec: CaseSpec) -> float:
    """Return what a run costs beside other runs of a study, the same on every machine.

    Steps times the root of the mean number of grains: a part of every step takes its time whatever
    there is to move, and grains leave. Relative to the conveyor with a flat plate it says 1.1 for
    the heap, 1.3 for the plate impact and 1.8 for the conveyor with a glued one, which take 1.6,
    0.7 and 1.7 times as long (HSP13 at the smallest scale; medians of 760 runs each, suite 5).
    Measured times would say it better, but what they say differs from hour to hour, and with it the
    runs that are chosen.

    Parameters
    ----------
    spec : CaseSpec
    """
    amount = _amount(spec)
    return math.sqrt(max(amount.steps * amount.work, 1.0))


@dataclass(frozen=True)
class _Probe:
    """What a probe took: time, work, bytes on disk, grains in its dumps; or why it failed."""

    seconds: float
    work: float
    size: float
    stored: float
    reason: str


def _probe(spec: CaseSpec, run: Callable[[CaseSpec, Path], CaseResult], root: Path) -> _Probe:
    small = replace(spec, scale=SCALES[0], apparatus={}, engine="minidem")
    result = run(small, root)
    size = sum(file.stat().st_size for file in result.path.rglob("*") if file.is_file())
    amount = _amount(small)
    reason = "" if result.wall_s > 0.0 else result.reason or "it took no time"
    return _Probe(result.wall_s, amount.work, float(size), amount.stored, reason)


@dataclass(frozen=True)
class _Amount:
    """Steps, grains, steps times mean grains, and rows of all dumps of a case."""

    steps: int
    grains: float
    work: float
    stored: float


def _amount(spec: CaseSpec) -> _Amount:
    v: Mapping[str, float] = build_case(spec).variables
    if experiment_of(spec).definition_digest:
        return _written_amount(spec)
    # Grains come in at a constant rate until all are there.
    filling = min(v["grain_count"] / v["grain_rate"], v["duration"])
    mean = v["grain_count"] * (1.0 - 0.5 * filling / v["duration"])
    count = steps(v["duration"], v["dt"])
    return _Amount(count, v["grain_count"], count * mean, v["frames"] * mean)


def _written_amount(spec: CaseSpec) -> _Amount:
    """Return the amount of an experiment that a folder describes, all grains there from the start.

    Where its script does not tell how many there are, a run is as long as its steps.
    """
    script = script_of(spec)
    load, frames = load_of(script), len(schedule_of(script).frames)
    grains = load.grains or 1.0
    return _Amount(int(load.steps), load.grains, load.steps * grains, max(frames, 1) * grains)


def _cost(place: Place, spec: CaseSpec, runs: int, probe: _Probe) -> PlaceCost:
    amount = _amount(spec)
    good = not probe.reason
    return PlaceCost(
        material=place.material,
        surface=place.surface,
        experiment=place.experiment,
        runs=runs,
        steps=amount.steps,
        grains=amount.grains,
        run_s=probe.seconds * amount.work / probe.work if good else float("nan"),
        disk_mb=probe.size * amount.stored / probe.stored / 1e6 if good else float("nan"),
        memory_mb=amount.grains * BYTES_PER_GRAIN / 1e6,
    )
