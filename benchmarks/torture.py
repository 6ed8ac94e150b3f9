"""Campaigns in trouble: python benchmarks/torture.py --out benchmarks/torture.md.

Campaigns of small cases are killed, interrupted, stopped and run several at once at random times,
their disk fills and is freed, their stored files are cut, emptied, flipped, edited, deleted and
dated otherwise. After each round a campaign continues undisturbed; printed is how many incidents
there were, how many ways to ask a harmed case were refused by name, how many engine starts there
were beyond one per case, and every fault: another number than the undisturbed campaign found, a
refusal without a name, a run too many, a process left behind. Exit code 1 when there is any.
"""

from __future__ import annotations

import argparse
import random
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from tests.torture.accidents import ACCIDENTS
from tests.torture.disk import mountable
from tests.torture.judge import Verdict
from tests.torture.rounds import Torture, accident_round, damage_round, disk_round, undisturbed
from tests.torture.study import record_round, study_arena, study_round

CASES = 8
ENGINES = ("minidem", "liggghts")
# Rounds and incidents in each, with minidem and with LIGGGHTS.
PLAN = {
    "kill -9 of the campaign": ((8, 5), (5, 5)),
    "kill -9 of a worker": ((8, 6), (5, 5)),
    "kill -9 of LIGGGHTS": ((0, 0), (7, 5)),
    "SIGINT or SIGTERM": ((8, 5), (5, 5)),
    "SIGSTOP, then SIGCONT": ((8, 2), (5, 2)),
    "two campaigns at once": ((6, 1), (4, 1)),
    "four campaigns at once": ((4, 1), (2, 1)),
}
DAMAGE = ("cut", "emptied", "bit flipped", "deleted")
DAMAGE_ROUNDS = {"damaged files": (DAMAGE, 9), "edited scripts, meshes, records": (("edited",), 4),
                 "clocks set back and ahead": (("dated back", "dated ahead"), 3),
                 "left by dead processes": (("littered",), 2)}  # fmt: skip
DISK_ROUNDS = {"minidem": (5, 3), "liggghts": (3, 3)}
STUDY_ROUNDS = {"minidem": (3, 3), "liggghts": (2, 3)}
RECORDS = 20


def rounds(torture: Torture, draw: random.Random) -> Iterator[tuple[str, Verdict]]:
    """Yield the verdict of every round of one engine."""
    which = ENGINES.index(torture.engine)
    for name in ACCIDENTS:
        count, times = PLAN[name][which]
        for _ in range(count):
            yield name, accident_round(torture, [name], times, draw)
    for name, (hows, count) in DAMAGE_ROUNDS.items():
        for _ in range(count):
            yield name, damage_round(torture, hows, draw)
    if mountable():
        count, times = DISK_ROUNDS[torture.engine]
        for _ in range(count):
            yield "disk of 5 MB fills and is freed", disk_round(torture, times, draw)
    else:
        print("no small disk: only root may mount one")


def study_rounds(side: Path, engine: str, draw: random.Random) -> Iterator[tuple[str, Verdict]]:
    """Yield the verdict of every round of the command `bulkcal calibrate`."""
    first = study_arena(side, engine)
    started = time.monotonic()
    ended = first.finish()
    wall_s = time.monotonic() - started
    if ended.table is None:
        msg = f"the undisturbed calibration failed: {ended}"
        raise RuntimeError(msg)
    count, times = STUDY_ROUNDS[engine]
    for _ in range(count):
        arena = study_arena(side, engine)
        yield (
            "bulkcal calibrate killed or interrupted",
            study_round(arena, ended.table, wall_s, times, draw),
        )
    yield "calibration.json damaged", record_round(first.out / "calibration.json", draw, RECORDS)


def markdown(found: dict[tuple[str, str], Verdict], seed: int, minutes: float) -> str:
    """Return the table of incidents."""
    total = sum(one.incidents for one in found.values())
    faults = sum(len(one.faults) for one in found.values())
    lines = [
        f"`python benchmarks/torture.py --seed {seed}`, {minutes:.0f} min: {total} incidents, "
        f"{faults} faults.",
        "",
        "| incident | engine | incidents | refused by name | starts beyond one per case | faults |",
        "|---|---|---|---|---|---|",
    ]
    lines += [
        f"| {name} | {engine} | {one.incidents} | {one.refused} | {one.starts} | "
        f"{len(one.faults)} |"
        for (name, engine), one in found.items()
    ]
    return "\n".join(lines) + "\n"


def main() -> int:
    """Torture campaigns of every engine and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--engine", choices=ENGINES, action="append")
    parser.add_argument("--cases", type=int, default=CASES)
    parser.add_argument("--out", type=Path, help="file for the table")
    chosen = parser.parse_args()
    draw, started = random.Random(chosen.seed), time.monotonic()
    found: dict[tuple[str, str], Verdict] = {}
    with tempfile.TemporaryDirectory(prefix="torture") as folder:
        for engine in chosen.engine or ENGINES:
            torture = undisturbed(Path(folder), engine, chosen.cases)
            for steps in (rounds(torture, draw), study_rounds(Path(folder), engine, draw)):
                for name, verdict in steps:
                    total = found.setdefault((name, engine), Verdict())
                    total += verdict
                    for fault in verdict.faults:
                        print(f"FAULT, {name}, {engine}: {fault}", flush=True)
    text = markdown(found, chosen.seed, (time.monotonic() - started) / 60.0)
    print(text)
    if chosen.out:
        chosen.out.write_text(text, encoding="utf-8")
    return int(any(one.faults for one in found.values()))


if __name__ == "__main__":
    sys.exit(main())
