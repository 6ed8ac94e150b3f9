"""What trust costs: id, lock, copies, digests, marks and the rename of a case, without its run.

`python benchmarks/case_overhead.py` runs each experiment at `quick` scale with minidem as a
campaign does, and takes the time of the engine and of the observables off the whole.
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any
from unittest.mock import patch

from calibrate.study.resources import bundled_particles
from liggghts_io import CaseSpec, execute, particle_named
from liggghts_io.case import attempt, observation
from liggghts_io.experiments import EXPERIMENTS, Experiment

PARAMETERS = {
    "mu_pp": 0.694, "mu_roll_pp": 0.0856, "mu_pw": 0.307, "mu_roll_pw": 0.274,
    "e_pp": 0.742, "e_pw": 0.439,
}  # fmt: skip


@dataclass
class Watch:
    """Adds up the time inside functions.

    Attributes
    ----------
    clock : callable
        Seconds: on the wall, or of the processor.
    seconds : dict of str to float
        By name.
    """

    clock: Callable[[], float]
    seconds: dict[str, float] = field(default_factory=dict)

    def around(self, name: str, function: Callable[..., Any]) -> Callable[..., Any]:
        """Return a function that does the same and is timed under a name."""

        def timed(*args: Any, **words: Any) -> Any:
            began = self.clock()
            try:
                return function(*args, **words)
            finally:
                self.seconds[name] = self.clock() - began

        return timed


def run_once(spec: CaseSpec, root: Path) -> dict[str, float]:
    """Return seconds of engine, observables and everything else of one case."""
    watches = {"wall": Watch(time.perf_counter), "CPU": Watch(time.process_time)}
    run, act = attempt.run_engine, execute
    measure = EXPERIMENTS[spec.experiment].observe
    for watch in watches.values():
        run, measure = watch.around("engine", run), watch.around("observables", measure)
        act = watch.around("whole", act)

    def timed_experiment(spec: CaseSpec) -> Experiment:
        return replace(EXPERIMENTS[spec.experiment], observe=measure)

    with (
        patch.object(attempt, "run_engine", run),
        patch.object(observation, "experiment_of", timed_experiment),
    ):
        result = act(spec, root)
    if result.status != "ok":
        print(result.reason)
    seconds = watches["wall"].seconds
    found = {"engine": seconds["engine"], "observables": seconds["observables"]}
    for name, watch in watches.items():
        parts = watch.seconds
        found[name] = parts["whole"] - parts["engine"] - parts["observables"]
    return found


def main() -> None:
    """Print a row per experiment."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeat", type=int, default=5, help="cases of each experiment")
    chosen = parser.parse_args()
    grain = particle_named("Carbo HSP13", bundled_particles())
    print("| experiment | engine | observables | the rest | of that CPU | first of a process |")
    print("|---|---|---|---|---|---|")
    for name in EXPERIMENTS:
        with tempfile.TemporaryDirectory() as root:
            rows = [
                run_once(CaseSpec(name, grain, "steel", "quick", PARAMETERS, seed=seed), Path(root))
                for seed in range(1, chosen.repeat + 2)
            ]
        typical = {part: statistics.median(row[part] for row in rows[1:]) for part in rows[0]}
        print(
            f"| {name} | {typical['engine']:.2f} s | {typical['observables'] * 1e3:.0f} ms | "
            f"{typical['wall'] * 1e3:.1f} ms | {typical['CPU'] * 1e3:.1f} ms | "
            f"{rows[0]['wall'] * 1e3:.0f} ms |",
            flush=True,
        )


if __name__ == "__main__":
    main()
