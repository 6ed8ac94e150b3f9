"""Random outputs of a small scene, from minidem and LIGGGHTS.

    python benchmarks/engine/random_outputs.py --count 20 --first 0 [--keep FOLDER]

Every seed makes one script: two dozen grains that fall on a plate, some computes, variables,
averages, dumps and thermo words, and two to four runs of odd lengths, between which some of these
go and others come. Every file that LIGGGHTS writes is compared with that of minidem, word by word;
numbers may differ by rounding.
"""

from __future__ import annotations

import argparse
import random
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from itertools import zip_longest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from minidem import run_script
from tests.minidem.output.scenes import HEAD, STL

RELATIVE = 2e-5
"""Six digits are printed of most numbers, and the last one rounds either way."""
SMALL = 1e-9
"""Of the largest number of a file: sums that cancel."""
NOT_COMPARED = ("in.script", "m.stl", "log.liggghts", "log.lammps")
THERMO = [
    "ke", "atoms", "vol", "lx", "ly", "lz", "xlo", "xhi", "ylo", "yhi", "zlo", "zhi", "step",
    "elapsed", "elaplong", "dt", "time", "erotate",
]  # fmt: skip
COLUMNS = [
    "type", "x", "y", "z", "xs", "ys", "zs", "xu", "yu", "zu", "ix", "iy", "iz", "vx", "vy", "vz",
    "fx", "fy", "fz", "mass", "radius", "diameter", "density", "omegax", "omegay", "omegaz", "tqx",
    "tqy", "tqz",
]  # fmt: skip
MEANS = ["vx", "vy", "vz", "fx", "fy", "fz"]
"""What all averages take of a particle, besides computes, fixes and variables."""
PLACES = ["x", "y", "z"]


class _Outputs:
    """What a script has set up so far.

    Parameters
    ----------
    draw : random.Random
        Source of all choices.
    """

    def __init__(self, draw: random.Random) -> None:
        self.draw = draw
        self.count = 0
        self.scalars: list[str] = []
        self.atoms: list[str] = []
        self.removable: list[str] = []

    def name(self, letter: str) -> str:
        """Return a new name."""
        self.count += 1
        return f"{letter}{self.count}"

    def group(self) -> str:
        """Return a group."""
        return self.draw.choice(["all", "all", "big", "low", "lefty"])

    def some(self, values: list[str], least: int = 1, most: int = 3) -> str:
        """Return some of these, different ones."""
        count = min(len(values), self.draw.randint(least, most))
        return " ".join(self.draw.sample(values, count))

    # -- computes and variables --------------------------------------------------------------------

    def atom_compute(self) -> list[str]:
        """Make a compute of values per particle."""
        name, draw = self.name("c"), self.draw
        style, columns = draw.choice(
            [("ke/atom", 0), ("pe/atom", 0), ("stress/atom", 6), ("contact/atom", 0),
             ("coord/atom 0.0079", 0), ("displace/atom", 4), ("erotate/sphere/atom", 0),
             ("property/atom vx fz radius", 3), ("property/atom omegay", 0),
             ("cluster/atom 0.0079", 0)]
        )  # fmt: skip
        self.atoms += [f"c_{name}[{k}]" for k in range(1, columns + 1)] or [f"c_{name}"]
        return [f"compute {name} {self.group()} {style}"]

    def global_compute(self) -> list[str]:
        """Make a compute of a number or a few."""
        name, draw = self.name("c"), self.draw
        style, scalar, columns = draw.choice(
            [("ke", 1, 0), ("erotate/sphere", 1, 0), ("com", 0, 3), ("gyration", 1, 6),
             ("temp", 1, 6), ("msd", 0, 4), ("msd com yes", 0, 4), ("pressure thermo_temp", 1, 6)]
        )  # fmt: skip
        group = "all" if "pressure" in style else self.group()
        self.scalars += [f"c_{name}"] * scalar + [f"c_{name}[{k}]" for k in range(1, columns + 1)]
        return [f"compute {name} {group} {style}"]

    def reduction(self) -> list[str]:
        """Reduce values per particle to one."""
        name, draw = self.name("c"), self.draw
        values = draw.sample([*PLACES, *MEANS, *self.atoms], draw.choice([1, 2, 3]))
        mode = draw.choice(["sum", "min", "max", "ave"])
        style = draw.choice([f"reduce {mode}", f"reduce {mode}", f"reduce/region near {mode}"])
        several = [f"c_{name}[{k}]" for k in range(1, len(values) + 1)]
        self.scalars += several if len(values) > 1 else [f"c_{name}"]
        return [f"compute {name} {self.group()} {style} {' '.join(values)}"]

    def number(self) -> list[str]:
        """Make a variable of style equal."""
        name, draw, group = self.name("v"), self.draw, self.group()
        parts = [
            f"count({group})", f"mass({group})", f"xcm({group},x)", f"vcm({group},z)",
            f"bound({group},zmin)", f"bound({group},ymax)", f"fcm({group},z)", f"ke({group})",
            f"gyration({group})", f"angmom({group},y)", f"count({group},near)",
            f"vcm({group},x,near)", f"inertia({group},xx)", "ramp(1,3)", "step", "atoms",
            "vdisplace(1,2)", "swiggle(1,2,0.001)", "cwiggle(1,2,0.001)", "stagger(40,7)",
            "logfreq(10,4,10)", "ke", *(f"{one}" for one in self.scalars),
        ]  # fmt: skip
        a, b = draw.sample(parts, 2)
        formula = draw.choice(
            [f"{a}", f"{a}*{b}", f"sqrt(abs({a}))+{b}", f"-({a})-2.5*{b}^2", f"({a}>{b})+1",
             f"floor(10*{a})", f"atan2({a},1.5)", f"sin({a})+cos({b})"]
        )  # fmt: skip
        self.scalars.append(f"v_{name}")
        return [f"variable {name} equal {formula}"]

    def atom_number(self) -> list[str]:
        """Make a variable of style atom."""
        name, draw = self.name("v"), self.draw
        a, b = draw.sample(
            [*PLACES, *MEANS, *self.atoms, "id", "type", "mass", "gmask(big)", "rmask(near)"], 2
        )
        formula = draw.choice([f"{a}+{b}", f"{a}*{b}-1", f"sqrt({a}*{a}+{b}*{b})", f"({a}<{b})"])
        self.atoms.append(f"v_{name}")
        return [f"variable {name} atom {formula}"]

    # -- fixes -------------------------------------------------------------------------------------

    def _times(self) -> str:
        every, repeat = self.draw.choice([(1, 1), (2, 3), (5, 4), (10, 1), (3, 5)])
        return f"{every} {repeat} {self.draw.choice([30, 60])}"

    def ave_time(self) -> list[str]:
        """Average numbers over time."""
        name, draw = self.name("f"), self.draw
        if not self.scalars:
            return []
        mode = draw.choice(["one", "one", "running", "window 3"])
        start = draw.choice(["", "", " start 60"])
        values = self.some(self.scalars)
        self.removable.append(f"unfix {name}")
        return [
            f"fix {name} all ave/time {self._times()} {values} ave {mode}{start} file {name}.txt"
        ]

    def ave_spatial(self) -> list[str]:
        """Average values per particle in slabs."""
        name, draw = self.name("f"), self.draw
        axis = draw.choice("xyz")
        origin, delta = draw.choice(["lower", "center", "0.01"]), draw.choice(["0.02", "0.05"])
        extra = draw.choice(["", " norm sample", " ave running", " ave window 2"])
        values = self.some([*MEANS, *self.atoms, "density/mass", "density/number"])
        self.removable.append(f"unfix {name}")
        return [
            f"fix {name} {self.group()} ave/spatial {self._times()} {axis} {origin} {delta} "
            f"{values} units box file {name}.txt{extra}"
        ]

    def ave_histo(self) -> list[str]:
        """Count values in bins."""
        name, draw = self.name("f"), self.draw
        extra = draw.choice(["", " beyond end", " beyond extra"])
        extra += draw.choice(["", " ave running", " ave window 2"])
        self.removable.append(f"unfix {name}")
        return [
            f"fix {name} {self.group()} ave/histo {self._times()} -0.5 0.5 7 "
            f"{draw.choice([*PLACES, *MEANS, *self.atoms])} mode vector file {name}.txt{extra}"
        ]

    def ave_correlate(self) -> list[str]:
        """Correlate numbers over time."""
        name, draw = self.name("f"), self.draw
        if len(self.scalars) < 2:
            return []
        kind = draw.choice(["auto", "upper", "lower", "auto/upper", "full"])
        self.removable.append(f"unfix {name}")
        return [
            f"fix {name} all ave/correlate 5 4 60 {self.some(self.scalars, 2, 3)} type {kind} "
            f"ave {draw.choice(['one', 'running'])} file {name}.txt"
        ]

    def ave_atom(self) -> list[str]:
        """Average values per particle over time."""
        name = self.name("f")
        values = self.draw.sample([*PLACES, *MEANS, *self.atoms], self.draw.choice([1, 2]))
        # between its times LIGGGHTS refuses to tell them: for dumps of the same interval
        dump = self.name("d")
        columns = [f"f_{name}[1]", f"f_{name}[2]"] if len(values) > 1 else [f"f_{name}"]
        return [
            f"fix {name} {self.group()} ave/atom 5 4 60 {' '.join(values)}",
            f"dump {dump} {self.group()} custom 60 {dump}.dump id {' '.join(columns)}",
            f"dump_modify {dump} sort id",
        ]

    def store(self) -> list[str]:
        """Keep values."""
        name = self.name("f")
        values = self.draw.sample([*COLUMNS, *self.atoms], self.draw.choice([1, 2]))
        columns = [f"f_{name}[1]", f"f_{name}[2]"] if len(values) > 1 else [f"f_{name}"]
        self.atoms += columns
        return [f"fix {name} all store/state {self.draw.choice([0, 0, 30])} {' '.join(values)}"]

    def printed(self) -> list[str]:
        """Print numbers."""
        name = self.name("f")
        names = [one[2:] for one in self.scalars if one.startswith("v_")]
        if not names:
            return []
        self.removable.append(f"unfix {name}")
        return [
            f'fix {name} all print {self.draw.choice([10, 40])} "n ${{{self.draw.choice(names)}}}" '
            f"file {name}.txt screen no"
        ]

    # -- dumps and thermo --------------------------------------------------------------------------

    def dump(self) -> list[str]:
        """Dump particles."""
        name, draw = self.name("d"), self.draw
        columns = f"id {self.some([*COLUMNS, *self.atoms], 2, 6)}"
        every = draw.choice([20, 30, 50])
        file = draw.choice([f"{name}.dump", f"{name}.dump", f"{name}.*"])
        lines = [f"dump {name} {self.group()} custom {every} {file} {columns}"]
        extra = draw.choice(
            ["", "", "thresh vz < 0", "region near", "thresh radius > 0.0035 thresh x > 0",
             "first yes", "every 70"]
        )  # fmt: skip
        lines.append(f"dump_modify {name} sort {draw.choice(['id', '2', '-2 '])} {extra}".rstrip())
        lines[1] = lines[1].replace("sort 2", "sort id").replace("sort -2", "sort id")
        self.removable.append(f"undump {name}")
        return lines

    def thermo(self) -> list[str]:
        """Set what stands in the log."""
        words = self.draw.sample([*THERMO, *self.scalars], self.draw.choice([3, 5, 8]))
        return [
            f"thermo_style custom step {' '.join(words)}",
            f"thermo_modify lost ignore norm {self.draw.choice(['yes', 'no'])}",
        ]


def script(seed: int) -> str:
    """Return the script of a seed."""
    draw = random.Random(seed)
    outputs = _Outputs(draw)
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
    text = script(seed)
    for engine in ("minidem", "liggghts"):
        place = folder / engine
        place.mkdir(parents=True)
        (place / "in.script").write_text(text)
        (place / "m.stl").write_text(STL)
    program = shutil.which("liggghts") or "liggghts"
    done = subprocess.run(
        ["stdbuf", "-oL", program, "-in", "in.script"], cwd=folder / "liggghts", check=False,
        capture_output=True, text=True, errors="replace", timeout=300,
    )  # fmt: skip
    error = next((line for line in done.stdout.splitlines() if "ERROR" in line), "")
    try:
        run_script(folder / "minidem" / "in.script", root=folder / "minidem")
    except RuntimeError as err:
        verdict = "both refuse" if done.returncode else "MINIDEM FAILS"
        return f"{verdict}: {err} | {error}"
    if done.returncode:
        return f"LIGGGHTS FAILS: {error}"
    found = []
    for path in sorted((folder / "liggghts").iterdir()):
        other = folder / "minidem" / path.name
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
            for e in ("minidem", "liggghts")]  # fmt: skip
    if apart := words_apart(*logs):
        found.append(f"log {apart}")
    return "DIFFERS: " + "; ".join(found) if found else "same"


def main() -> None:
    """Compare a range of seeds."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--count", type=int, default=20, help="number of seeds")
    parser.add_argument("--keep", type=Path, help="folder that keeps scripts and outputs")
    args = parser.parse_args()
    for seed in range(args.first, args.first + args.count):
        with tempfile.TemporaryDirectory() as spare:
            folder = args.keep / str(seed) if args.keep else Path(spare)
            if args.keep:
                shutil.rmtree(folder, ignore_errors=True)
            print(f"{seed:5d} {compare(seed, folder)}", flush=True)


if __name__ == "__main__":
    main()
