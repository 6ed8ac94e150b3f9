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
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from itertools import chain
from pathlib import Path
from typing import TypeAlias

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from tests.torture.accidents import ACCIDENTS
from tests.torture.arena import hear_ctrl_c
from tests.torture.disk import mountable
from tests.torture.judge import Verdict
from tests.torture.rounds import Torture, accident_round, damage_round, disk_round, undisturbed
from tests.torture.study import record_round, study_arena, study_round

CASES = 8
ENGINES = ("minidem", "liggghts")
# Rounds and incidents in each, with minidem and with LIGGGHTS.
PLAN = {
    "kill -9 of the campaign": ((5, 5), (4, 5)),
    "kill -9 of a worker": ((6, 6), (4, 5)),
    "kill -9 of LIGGGHTS": ((0, 0), (6, 5)),
    "SIGINT or SIGTERM": ((5, 5), (4, 5)),
    "SIGSTOP, then SIGCONT": ((5, 2), (4, 2)),
    "two campaigns at once": ((4, 1), (3, 1)),
    "four campaigns at once": ((2, 1), (2, 1)),
}
DAMAGE = {
    "files cut, emptied, flipped, deleted": (("cut", "emptied", "bit flipped", "deleted"), 8),
    "scripts, meshes, records edited": (("edited",), 3),
    "clocks set back and ahead": (("dated back", "dated ahead"), 2),
    "left by dead processes": (("littered",), 2),
}
DISK_ROUNDS = {"minidem": (4, 3), "liggghts": (3, 3)}
STUDY_ROUNDS = {"minidem": (2, 3), "liggghts": (1, 3)}
RECORDS = 10


DISK, STUDY = "disk of 5 MB fills and is freed", "bulkcal calibrate killed or interrupted"
Round: TypeAlias = Callable[[], Verdict]
Found: TypeAlias = dict[tuple[str, str], Verdict]


def rounds(torture: Torture, draw: random.Random) -> Iterator[tuple[str, Round]]:
    """Yield every round of one engine, to be called for its verdict."""
    which = ENGINES.index(torture.engine)
    for name in ACCIDENTS:
        count, times = PLAN[name][which]
        yield from [(name, partial(accident_round, torture, [name], times, draw))] * count
    for name, (hows, count) in DAMAGE.items():
        yield from [(name, partial(damage_round, torture, hows, draw))] * count
    if mountable():
        count, times = DISK_ROUNDS[torture.engine]
        yield from [(DISK, partial(disk_round, torture, times, draw))] * count
    else:
        print("no small disk: only root may mount one")


def study_rounds(side: Path, engine: str, draw: random.Random) -> Iterator[tuple[str, Round]]:
    """Yield every round of the command `bulkcal calibrate`."""
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
        yield STUDY, partial(study_round, arena, ended.table, wall_s, times, draw)
    record = first.out / "calibration.json"
    yield "calibration.json damaged", partial(record_round, record, draw, RECORDS)


def markdown(found: Found, seed: int, minutes: float) -> str:
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


def torment(engine: str, chosen: argparse.Namespace, folder: Path, found: Found) -> None:
    """Torture campaigns of one engine, adding to `found` and to the file after every round."""
    draw, started = random.Random(chosen.seed), time.monotonic()
    torture = undisturbed(folder / engine, engine, chosen.cases)
    study = iter(()) if chosen.only else study_rounds(folder / engine, engine, draw)
    for name, one_round in chain(rounds(torture, draw), study):
        if not name.startswith(chosen.only):
            continue
        verdict = one_round()
        total = found.setdefault((name, engine), Verdict())
        total += verdict
        for fault in verdict.faults:
            print(f"FAULT, {name}, {engine}: {fault}", flush=True)
        if chosen.out:
            minutes = (time.monotonic() - started) / 60.0
            chosen.out.write_text(markdown(dict(found), chosen.seed, minutes), encoding="utf-8")


def main() -> int:
    """Torture campaigns of both engines at once and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--engine", choices=ENGINES, action="append")
    parser.add_argument("--cases", type=int, default=CASES)
    parser.add_argument("--out", type=Path, help="file for the table")
    parser.add_argument("--only", default="", help="only accidents whose name starts like this")
    chosen, started = parser.parse_args(), time.monotonic()
    hear_ctrl_c()
    found: Found = {}
    engines = chosen.engine or ENGINES
    with tempfile.TemporaryDirectory(prefix="torture") as folder, ThreadPoolExecutor() as pool:
        work = [pool.submit(torment, one, chosen, Path(folder), found) for one in engines]
        for one in work:
            one.result()
    print(markdown(found, chosen.seed, (time.monotonic() - started) / 60.0))
    return int(any(one.faults for one in found.values()))


if __name__ == "__main__":
    sys.exit(main())
