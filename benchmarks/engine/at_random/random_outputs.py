"""Random outputs of a small scene, from minidem and LIGGGHTS.

    python benchmarks/engine/at_random/random_outputs.py --count 20 --first 0 [--keep FOLDER]

Every seed makes one script: two dozen grains that fall on a plate, some computes, variables,
averages, dumps and thermo words, and two to four runs of odd lengths, between which some of these
go and others come. Every file that LIGGGHTS writes is compared with that of minidem, word by word;
numbers may differ by rounding.
"""

from __future__ import annotations

import random
import re
import sys
from collections.abc import Iterator
from itertools import zip_longest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3]))

from benchmarks.engine.at_random.both import LIGGGHTS, MINIDEM, each_seed, run_both, seeds
from benchmarks.engine.at_random.output_lines import Outputs
from tests.minidem.output.scenes import HEAD, STL

RELATIVE = 2e-5
"""Six digits are printed of most numbers, and the last one rounds either way."""
SMALL = 1e-9
"""Of the largest number of a file: sums that cancel."""
NOT_COMPARED = ("in.script", "m.stl", "log.liggghts", "log.lammps")


def script(seed: int) -> str:
    """Return the script of a seed."""
    draw = random.Random(seed)
    outputs = Outputs(draw)
    lines = HEAD.replace("boundary f f m", "boundary f f f").splitlines()
    points = [(i, j, k) for i in range(-1, 2) for j in range(-1, 2) for k in range(3)]
    for number, (i, j, k) in enumerate(draw.sample(points, draw.randint(12, 27)), start=1):
        x, y, z = (c * 0.012 + draw.uniform(-0.001, 0.001) for c in (i, j, k))
        lines += [
            f"create_atoms {draw.choice([1, 2])} single {x!r} {y!r} {z + 0.017!r} units box",
            f"set atom {number} density 2500 diameter {draw.choice([0.006, 0.008])}",
            f"set atom {number} vx {draw.uniform(-0.5, 0.5)!r} vz {draw.uniform(-2, 0)!r}",
        ]
    lines += [
        "region near sphere 0 0 0.02 0.02 units box", "region left block -0.1 0 -0.1 0.1 -0.1 0.1",
        "group big type 2", "group low region near", "group lefty region left",
        "fix integr all nve/sphere", "thermo_style custom step atoms ke",
        "thermo_modify lost ignore norm no", f"thermo {draw.choice([20, 50])}",
    ]  # fmt: skip
    base = [outputs.atom_compute, outputs.global_compute, outputs.number, outputs.atom_number]
    more = [
        outputs.reduction, outputs.ave_time, outputs.ave_spatial, outputs.ave_histo,
        outputs.ave_correlate, outputs.ave_atom, outputs.store, outputs.printed, outputs.dump,
        outputs.dump, outputs.thermo,
    ]  # fmt: skip
    for k in range(draw.choice([2, 3, 4])):
        for _ in range(3 if k == 0 else 1):
            lines += draw.choice(base)()
        for _ in range(draw.randint(2, 5)):
            lines += draw.choice(more)()
        lines.append(f"run {draw.choice([60, 97, 120, 133])}")
        if outputs.removable and draw.random() < 0.5:
            gone = draw.choice(outputs.removable)
            outputs.removable.remove(gone)
            lines.append(gone)
    return "\n".join([*lines, ""])


def thermo_rows(text: str) -> Iterator[list[str]]:
    """Return heads and rows of the tables in a log."""
    inside = False
    for line in text.splitlines():
        words = line.split()
        if words[:1] == ["Step"]:
            inside = True
        elif line.startswith("Loop time"):
            inside = False
        if inside and words and (words[0] == "Step" or words[0].isdigit()):
            yield words


def words_apart(mine: list[list[str]], theirs: list[list[str]]) -> str:
    """Return the first place where two texts differ, '' if they do not."""
    numbers = [abs(value) for row in theirs for value in map(number_of, row) if value is not None]
    small = SMALL * max(numbers, default=0.0)
    for at, (a, b) in enumerate(zip_longest(mine, theirs, fillvalue=[]), start=1):
        if a[:1] == b[:1] == ["#"]:  # with ave/correlate LIGGGHTS leaves names out
            continue
        if len(a) != len(b):
            return f"line {at}: {' '.join(a)[:80]} | {' '.join(b)[:80]}"
        for word, wanted in zip(a, b, strict=True):
            x, y = number_of(word), number_of(wanted)
            if x is None or y is None:
                same = word == wanted
            else:
                same = abs(x - y) <= RELATIVE * max(abs(x), abs(y)) + small
            if not same:
                return f"line {at}: {word} | {wanted}"
    return ""


def number_of(word: str) -> float | None:
    """Return a number, None for another word."""
    try:
        return float(word)
    except ValueError:
        return None


def compare(seed: int, folder: Path) -> str:
    """Run the script of a seed on both engines; return what differs."""
    if refused := run_both(folder, script(seed), {"m.stl": STL}):
        return refused
    found = []
    for path in sorted((folder / LIGGGHTS).iterdir()):
        other = folder / MINIDEM / path.name
        if path.name in NOT_COMPARED:
            continue
        if not other.exists():
            found.append(f"{path.name}: not written")
            continue
        rows = [[re.split(r"\s+", line.strip()) for line in one.read_text().splitlines()]
                for one in (other, path)]  # fmt: skip
        if apart := words_apart(*rows):
            found.append(f"{path.name} {apart}")
    logs = [list(thermo_rows((folder / e / "log.liggghts").read_text(errors="replace")))
            for e in (MINIDEM, LIGGGHTS)]  # fmt: skip
    if apart := words_apart(*logs):
        found.append(f"log {apart}")
    return "DIFFERS: " + "; ".join(found) if found else "same"


def main() -> None:
    """Compare a range of seeds."""
    each_seed(seeds(__doc__).parse_args(), compare)


if __name__ == "__main__":
    main()
