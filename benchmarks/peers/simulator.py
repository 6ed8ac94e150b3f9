"""One simulation: parameters and seed in, observables and cost out, everything kept."""

from __future__ import annotations

import hashlib
import json
import shutil
import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final, Protocol

from benchmarks.peers.apparatus import MATERIAL, SCALE, Place
from benchmarks.peers.lines import append_line, read_lines
from calibrate.study.resources import bundled_particles
from liggghts_io import CaseSpec, execute, particle_named
from liggghts_io.case.spec import build_case

RUNS: Final = "runs.jsonl"
CASES: Final = "cases"
_DIGITS: Final = 8  # of a parameter: enough to tell points apart, and equal on every machine


@dataclass(frozen=True)
class Run:
    """What a simulation says and costs.

    Attributes
    ----------
    observables : Mapping[str, float]
        Empty where the run failed.
    particle_steps : float
        Steps times grains poured; a failed run has cost them too.
    """

    observables: Mapping[str, float]
    particle_steps: float


class Simulator(Protocol):
    """What runs one place at one parameter vector."""

    def run(self, place: Place, parameters: Mapping[str, float], seed: int) -> Run:
        """Return what the run says."""


class Engine:
    """The engine, with a line on disk for every finished run.

    A run that has its line is never done again, so that a killed comparison repeats what it asked
    for in no time and goes on. Case directories are removed when the line is written: forty
    thousand of them would fill a disk.

    Parameters
    ----------
    folder : Path
        Where lines and cases are kept.
    """

    def __init__(self, folder: Path) -> None:
        self._root = folder / CASES
        self._file = folder / RUNS
        self._particles = bundled_particles()
        folder.mkdir(parents=True, exist_ok=True)
        self._known = dict(stored_runs(self._file))

    def run(self, place: Place, parameters: Mapping[str, float], seed: int) -> Run:
        """Return the stored run, or do it."""
        spec = CaseSpec(
            place.experiment,
            particle_named(place.material, self._particles),
            place.surface,
            SCALE,
            {name: float(f"{value:.{_DIGITS}g}") for name, value in parameters.items()},
            apparatus=place.apparatus,
            seed=seed,
        )
        key = _key(spec, place.material)
        if key not in self._known:
            self._known[key] = self._simulate(spec, key)
        return self._known[key]

    def _simulate(self, spec: CaseSpec, key: str) -> Run:
        began = time.process_time()
        result = execute(spec, self._root)
        run = Run(dict(result.observables), particle_steps(spec))
        line = {
            "key": key,
            "experiment": spec.experiment,
            "surface": spec.surface,
            "parameters": spec.parameters,
            "seed": spec.seed,
            "reason": result.reason,
            "cpu_s": round(time.process_time() - began, 3),
            **asdict(run),
        }
        append_line(self._file, line)
        shutil.rmtree(result.path, ignore_errors=True)
        return run


def particle_steps(spec: CaseSpec) -> float:
    """Return steps times grains poured of a case."""
    variables = build_case(spec).variables
    return float(variables["grain_count"] * variables["duration"] / variables["dt"])


def _key(spec: CaseSpec, material: str) -> str:
    """Return what tells a run apart from all others of this comparison."""
    inputs = [spec.experiment, spec.surface, spec.scale, spec.seed, spec.parameters, spec.apparatus]
    if material != MATERIAL:
        inputs.append(material)
    words = json.dumps(inputs, sort_keys=True, default=dict)
    return hashlib.sha256(words.encode()).hexdigest()[:24]


def stored_runs(file: Path) -> list[tuple[str, Run]]:
    """Return the keys and runs on disk."""
    return [
        (line["key"], Run(line["observables"], line["particle_steps"])) for line in read_lines(file)
    ]
