"""What trust costs: id, lock, copies, digests, marks and the rename of a case, without its run.

`python benchmarks/case_overhead.py` runs each experiment at `quick` scale with minidem as a
campaign does, and takes the time of the engine and of the observables off the whole. Then whole
campaigns run with a stand-in that costs nothing for engine and observables: what is left is all
that happens around a run, handing it to a worker and taking its result included.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import statistics
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any
from unittest.mock import patch

from calibrate.runs.campaign import Campaign
from calibrate.runs.executors.choose import executor_of
from calibrate.runs.others import held_case
from calibrate.runs.stored import stored_case
from calibrate.study.resources import bundled_particles
from liggghts_io import CaseResult, CaseSpec, execute, particle_named
from liggghts_io.case import attempt, observation
from liggghts_io.experiments import EXPERIMENTS, Experiment, Observed
from liggghts_io.measure.schedule import read_schedule

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


def free_engine(folder: Path, script: str, engine: str, *_rest: object) -> None:
    """Leave what an engine leaves behind that completed at once: the log with its mark."""
    del engine
    text = (folder / script).read_text()
    steps = read_schedule(folder / script).steps
    mark = text.rstrip().rpartition('print "')[2].rstrip('"').replace("$(step)", str(steps))
    (folder / "log.liggghts").write_text(f"{mark}\n")


def free_observables(experiment: Experiment) -> Experiment:
    """Return an experiment that measures without looking."""
    values = {one.name: 1.0 for one in experiment.observables}
    return replace(experiment, observe=lambda *_: Observed(values, {}))


def execute_free(spec: CaseSpec, root: Path) -> CaseResult:
    """Run a case as `execute` does, on an engine and with observables that cost nothing."""
    with (
        patch.object(attempt, "run_engine", free_engine),
        patch.object(attempt, "check_complete", lambda *_: 0),  # there are no frames
        patch.object(
            observation,
            "experiment_of",
            lambda spec: free_observables(EXPERIMENTS[spec.experiment]),
        ),
    ):
        return execute(spec, root)


def cpu_s() -> float:
    """Return the processor time of this process and its workers so far [s]."""
    ticks = 0.0
    for child in multiprocessing.active_children():
        fields = Path(f"/proc/{child.pid}/stat").read_text().rpartition(")")[2].split()
        ticks += float(fields[11]) + float(fields[12])  # user and system, see proc(5)
    return time.process_time() + ticks / os.sysconf("SC_CLK_TCK")


def campaign_overhead(executor: str, workers: int, runs: int) -> tuple[float, float]:
    """Return wall time (times workers) and processor time per run that costs nothing [s]."""
    grain = particle_named("Carbo HSP13", bundled_particles())

    def specs(first: int, count: int) -> list[CaseSpec]:
        names = list(EXPERIMENTS)
        return [
            CaseSpec(names[i % len(names)], grain, "steel", "quick", PARAMETERS, seed=i + 1)
            for i in range(first, first + count)
        ]

    with (
        tempfile.TemporaryDirectory() as folder,
        executor_of(executor, workers) as pool,
        Campaign(
            Path(folder), execute_free, stored=stored_case, held=held_case, workers=workers,
            executor=pool,
        ) as campaign,
    ):  # fmt: skip
        campaign(specs(0, 6 * workers), "processes start, sources are read")
        began, used = time.perf_counter(), cpu_s()
        table = campaign(specs(1000, runs), "measured")
        spent, used = time.perf_counter() - began, cpu_s() - used
    if (table["status"] != "ok").any():
        print(table["reason"].iloc[0])
    return spent * workers / runs, used / runs


def main() -> None:
    """Print a row per experiment, then one per kind of campaign."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeat", type=int, default=5, help="cases of each experiment")
    parser.add_argument("--runs", type=int, default=300, help="runs of a campaign")
    parser.add_argument("--workers", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--executors", nargs="+", default=["local", "dask-local"])
    parser.add_argument("--campaigns-only", action="store_true")
    chosen = parser.parse_args()
    if not chosen.campaigns_only:
        cases(chosen.repeat)
    print("| campaign | workers | around a run, wall | CPU |\n|---|---|---|---|")
    for executor in chosen.executors:
        for workers in chosen.workers:
            wall, cpu = campaign_overhead(executor, workers, chosen.runs)
            print(
                f"| {executor} | {workers} | {wall * 1e3:.1f} ms | {cpu * 1e3:.1f} ms |", flush=True
            )


def cases(repeat: int) -> None:
    """Print a row per experiment."""
    grain = particle_named("Carbo HSP13", bundled_particles())
    print("| experiment | engine | observables | the rest | of that CPU | first of a process |")
    print("|---|---|---|---|---|---|")
    for name in EXPERIMENTS:
        with tempfile.TemporaryDirectory() as root:
            rows = [
                run_once(CaseSpec(name, grain, "steel", "quick", PARAMETERS, seed=seed), Path(root))
                for seed in range(1, repeat + 2)
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
