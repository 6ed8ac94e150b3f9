"""Compare the speed of minidem and LIGGGHTS on the same scripts in the same run.

    python benchmarks/engine/engine_speed.py [--repeat 2] [--only settled heap] [--against TREE]

Prints a table: the better of the repeats of each program, which take turns. One-core rows are in
CPU seconds, which on a busy machine mean more than wall-clock time; the row of two threads is in
wall-clock seconds of the loop and wants an idle machine. ``script`` is the whole process with its
start, ``loop`` the time steps alone. Kernels are compiled before anything is timed; what that
takes on a machine that never ran minidem is the last row.

With ``--against`` the other program is the minidem of another source tree, say that of the commit
before (``git worktree add ../before HEAD~1``): each row says what a change costs or gains.
"""

from __future__ import annotations

import argparse
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from benchmarks.engine.mixture import COUNT as MIXED
from benchmarks.engine.mixture import head, mixture_script
from benchmarks.engine.size.machine import described
from calibrate.study.resources import bundled_particles
from liggghts_io import CaseSpec, particle_named, write_case
from liggghts_io.materials import ONE
from minidem import run_script

RADIUS = 0.0008  # m
COUNT = 8000
HSP13 = {
    "mu_pp": 0.694, "mu_roll_pp": 0.0856, "mu_pw": 0.307, "mu_roll_pw": 0.274, "e_pp": 0.742,
    "e_pw": 0.439,
}  # fmt: skip
HEAD = head(1, 2e-5)

FILL = f"""fix pts all particletemplate/sphere 15485863 atom_type 1 density constant 3500 &
 radius constant {RADIUS}
fix pdd all particledistribution/discrete 32452843 1 pts 1.0
region fill cylinder z 0 0 0.021 0.001 0.078 units box
fix ins all insert/pack seed 86028121 distributiontemplate pdd maxattempt 100 insert_every once &
 overlapcheck yes all_in yes vel constant 0 0 -0.4 region fill particles_in_region {COUNT}
dump d all custom 6000 settled.dump id x y z
dump_modify d sort id format "%d %.17g %.17g %.17g"
run 6000
"""


OURS, LIGGGHTS = "minidem", "liggghts"
"""The two programs; the folder of a source tree may stand for the second."""
_CALL = "import sys; from minidem.cli import main; sys.exit(main())"
"""What `python -m minidem` does, in older source trees as well."""


@dataclass(frozen=True)
class Timing:
    """What one run of a program took, s.

    Attributes
    ----------
    cpu_s, wall_s : float
        Of the whole process.
    loops_s : tuple of float
        Wall-clock time of each ``run`` command, from the log.
    """

    cpu_s: float
    wall_s: float
    loops_s: tuple[float, ...]

    def loop_cpu_s(self, first: int = 0) -> float:
        """CPU time of the runs from `first` on: wall time by the share of it that was ours."""
        return sum(self.loops_s[first:]) * min(1.0, self.cpu_s / self.wall_s)


def run_program(
    engine: str, folder: Path, script: str, processes: int = 1, cache: str = ""
) -> Timing:
    """Run a script in a folder with one of the programs and time it."""
    tree = str(Path(__file__).parents[2]) if engine == OURS else engine
    command = [sys.executable, "-c", _CALL, "-threads", str(processes)]
    if engine == LIGGGHTS:
        command = ["liggghts"]
        if processes > 1:
            # Open MPI refuses to run as root unless it is told so
            command = ["mpirun", "--allow-run-as-root", "-np", str(processes), "liggghts"]
    command += ["-in", script, "-log", "log.run"]
    changed = {"PYTHONPATH": tree, "OMP_NUM_THREADS": "1"}
    changed |= {"XDG_CACHE_HOME": cache} if cache else {"MINIDEM_COMPILE": "first"}
    # byte code is stored, as it is after an ordinary installation
    env = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"} | changed
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    started = time.perf_counter()
    with (folder / "screen.txt").open("w") as screen:
        subprocess.run(
            command, cwd=folder, stdout=screen, stderr=subprocess.STDOUT, check=True, env=env
        )
    wall = time.perf_counter() - started
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    loops = re.findall(r"^Loop time of (\S+)", (folder / "log.run").read_text(), re.MULTILINE)
    cpu = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
    return Timing(cpu, wall, tuple(float(loop) for loop in loops))


def settled_script(folder: Path, steps: int) -> None:
    """Let minidem settle a packing, and write a script that starts from it."""
    (folder / "in.fill").write_text(HEAD + "thermo 6000\n" + FILL)
    run_script(folder / "in.fill", root=folder)
    rows = (folder / "settled.dump").read_text().splitlines()[-COUNT:]
    points = np.array([[float(word) for word in row.split()[1:]] for row in rows])
    lines = [f"create_atoms 1 single {x:.17g} {y:.17g} {z:.17g} units box" for x, y, z in points]
    lines.append(f"set type 1 density 3500 diameter {2 * RADIUS}")
    text = HEAD + "thermo 100000\n" + "\n".join(lines) + f"\nrun 300\nrun {steps}\n"
    (folder / "in.script").write_text(text)


def column(base: Path, other: str, repeat: int) -> None:
    """Time a column that collapses."""
    folder = base / "column"
    folder.mkdir()
    shutil.copy(Path(__file__).with_name("column.in"), folder / "in.script")
    found = take_turns(folder, other, repeat)
    row("column collapsing, 8600 particles, script", best(found, lambda one: one.cpu_s), 3.0, 4.0)
    row("the same, loop", best(found, lambda one: one.loop_cpu_s()), 3.0, 4.0)


def case_script(folder: Path, experiment: str, scale: str, steps: int = 0) -> None:
    """Write the case of an experiment, cut short if `steps` is given."""
    grain = replace(particle_named("Carbo HSP13", bundled_particles()), sizes=ONE)
    write_case(CaseSpec(experiment, grain, "steel", scale, HSP13, {}, {}, 1), folder)
    if steps:
        script = folder / "in.script"
        script.write_text(re.sub(r"(?m)^run \d+", f"run {steps}", script.read_text()))


def take_turns(
    folder: Path, other: str, repeat: int, processes: int = 1
) -> dict[str, list[Timing]]:
    """Run both programs in turn in copies of a folder, after a run of each that compiles."""
    found: dict[str, list[Timing]] = {OURS: [], other: []}
    for turn in range(-1, repeat):
        for engine in (OURS, other):
            if turn < 0 and engine == LIGGGHTS:
                continue
            copy = folder.parent / "run"
            shutil.rmtree(copy, ignore_errors=True)
            shutil.copytree(folder, copy)
            timing = run_program(engine, copy, "in.script", processes)
            if turn >= 0:
                found[engine].append(timing)
    return found


def row(name: str, seconds: dict[str, float], must: float, aim: float) -> None:
    """Print a row with the ratio of the two programs."""
    ours, theirs = seconds.values()
    ratio = theirs / ours
    end = f"{ratio:.2f} | {must} | {aim} |" if LIGGGHTS in seconds else f"{ratio:.3f} | | |"
    print(f"| {name} | {ours:.2f} s | {theirs:.2f} s | {end}", flush=True)


def best(timings: dict[str, list[Timing]], value: Callable[[Timing], float]) -> dict[str, float]:
    """Return the least of a value over the repeats of each program."""
    return {engine: min(value(timing) for timing in all_) for engine, all_ in timings.items()}


def settled(base: Path, other: str, repeat: int) -> None:
    """Time 1000 steps of a settled heap, on one core and with two."""
    folder = base / "settled"
    folder.mkdir()
    settled_script(folder, 1000)
    found = take_turns(folder, other, repeat)
    name = f"settled heap, {COUNT} particles"
    row(f"{name}, loop", best(found, lambda one: one.loop_cpu_s(1)), 3.5, 5.0)
    found = take_turns(folder, other, repeat + 1, processes=2)
    row(f"{name}, two threads, loop, wall", best(found, lambda one: one.loops_s[-1]), 3.0, 4.0)


def mixture(base: Path, other: str, repeat: int, classes: int) -> None:
    """Time 1000 steps of a settled heap of grains of several sizes."""
    folder = base / f"mixture_{classes}"
    folder.mkdir()
    mixture_script(folder, classes, 1000)
    found = take_turns(folder, other, repeat)
    name = f"settled, {MIXED} particles of {classes} sizes 1:3, loop"
    row(name, best(found, lambda one: one.loop_cpu_s(1)), 3.0, 5.0)


def script(
    base: Path, other: str, repeat: int, experiment: str, scale: str, steps: int = 0
) -> None:
    """Time the script of an experiment."""
    must, aim = (2.5, 4.0) if experiment == "heap" else (3.0, 4.0)
    folder = base / f"{experiment}_{scale}"
    case_script(folder, experiment, scale, steps)
    found = take_turns(folder, other, repeat)
    name = f"{experiment}, `{scale}`" + (f", first {steps} steps" if steps else "")
    row(f"{name}, script", best(found, lambda one: one.cpu_s), must, aim)
    row(f"{name}, loop", best(found, lambda one: one.loop_cpu_s()), must, aim)


def start(base: Path, other: str, repeat: int) -> None:
    """Time one step, with compiled kernels and without."""
    folder = base / "start"
    case_script(folder, "heap", "quick", 1)
    found = take_turns(folder, other, repeat + 1)
    for name, value in (("wall", lambda one: one.wall_s), ("CPU", lambda one: one.cpu_s)):
        ours, theirs = best(found, value).values()
        print(f"| start to first step, {name} | {ours:.2f} s | {theirs:.2f} s | | | |")
    cold: list[str] = []
    for engine in (OURS, other):
        if engine == LIGGGHTS:
            cold.append("")
            continue
        with tempfile.TemporaryDirectory() as cache:
            cold.append(f"{run_program(engine, folder, 'in.script', cache=cache).cpu_s:.1f} s")
    print(f"| the same on a new machine, CPU | {' | '.join(cold)} | | | |")


def main() -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeat", type=int, default=2)
    parser.add_argument("--against", metavar="TREE", default=LIGGGHTS)
    parts: dict[str, Callable[[Path, str, int], None]] = {
        "settled": settled,
        "column": column,
        "mixture_4": lambda *args: mixture(*args, 4),
        "mixture_16": lambda *args: mixture(*args, 16),
        "heap": lambda *args: script(*args, "heap", "quick"),
        "large": lambda *args: script(*args, "heap", "paper", 40_000),
        "lab": lambda *args: script(*args, "heap", "lab"),
        "conveyor": lambda *args: script(*args, "conveyor", "quick"),
        "plate_impact": lambda *args: script(*args, "plate_impact", "quick"),
        "start": start,
    }
    parser.add_argument(
        "--only", nargs="*", default=[p for p in parts if p != "lab"], choices=list(parts)
    )
    args = parser.parse_args()
    against = args.against
    if against != LIGGGHTS:
        against = str(Path(against).resolve())
        if not (Path(against) / "minidem").is_dir():
            print(f"{against}: no source tree of minidem")
            return 2
    for program in ("liggghts", "mpirun"):
        if against == LIGGGHTS and shutil.which(program) is None:
            print(f"{program} is not installed (Debian: apt-get install liggghts)")
            return 2
    print(described() + "\n")
    second = "LIGGGHTS" if against == LIGGGHTS else against
    print(f"| what | minidem | {second} | ratio | must | aim |")
    print("|---|---|---|---|---|---|", flush=True)
    with tempfile.TemporaryDirectory() as scratch:
        for name in args.only:
            parts[name](Path(scratch), against, args.repeat)
    return 0


if __name__ == "__main__":
    sys.exit(main())
