"""Random computes, variables, averages and dumps, for `random_outputs`."""

from __future__ import annotations

import random

__all__ = ["Outputs"]

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


class Outputs:
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
