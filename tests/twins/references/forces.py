"""Forces and motions that fixes give: many of them at once on overlapping groups, in two runs.

Some fixes, groups and regions move or follow variables; between the runs some go, others come.
Spheres whose velocity no force changes do not touch each other or walls: their contacts slide
exactly at the limit of friction when a run begins, and rounding decides whether they do. There is
no wall in a periodic box: LIGGGHTS goes on with the history of a sphere that the period has taken
from the wall.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from tests.twins.references.batch import Batch
from tests.twins.references.places import HALF, atoms, dump, words

SIDE = 4  # spheres in a row
STEPS = 240
EVERY = 40
REGIONS = (
    "block -0.03 0.1 -0.1 0.04 -0.1 0.02 units box",
    "sphere 0.01 0 0 0.05 side out units box",
    "cylinder z 0 0.01 0.06 -0.08 0.05 units box",
    "sphere 0 0 0.02 0.05 units box move v_way NULL v_way",
    "block -0.05 0.05 -0.1 0.1 -0.1 0.1 units box rotate v_turn 0 0 0 0 0 1",
)
HARD = ("sphere 0 0 0 0.13 units box", "block -0.09 0.09 -0.09 0.09 -0.09 0.09 units box")


class Scene:
    """Spheres in a box, and fixes drawn at random."""

    def __init__(self, rng: np.random.Generator) -> None:
        self.rng = rng
        self.count = 0
        self.taken: list[str] = []  # names of fixes with numbers to print
        self.living: list[str] = []
        self.held = ""  # the group whose motion is given
        self.upright = bool(rng.uniform() < 0.5)  # gravity against z, as buoyancy asks for

    def number(self, scale: float) -> str:
        """Return a number of a scale, zero at times."""
        x = float(self.rng.normal() * scale)
        return "0" if self.rng.uniform() < 0.25 else f"{x:.4g}"

    def three(self, scale: float) -> str:
        """Return three numbers."""
        return " ".join(self.number(scale) for _ in range(3))

    def direction(self) -> str:
        """Return a vector that is not zero."""
        return words(np.round(self.rng.normal(size=3) + 0.01, 3))

    def component(self, scale: float) -> str:
        """Return a number, or a variable."""
        kind = self.rng.uniform()
        if kind < 0.7:
            return self.number(scale)
        return "v_pull" if kind < 0.85 else "v_each"

    def group(self) -> str:
        """Return one of the groups."""
        return str(self.rng.choice(["all", "one", "two", "left", "odd"]))

    def region(self) -> str:
        """Return the option of a region, or nothing."""
        return f" region r{int(self.rng.integers(5))}" if self.rng.uniform() < 0.35 else ""

    def point(self) -> str:
        """Return coordinates, some of which do not count."""
        return " ".join(x if self.rng.uniform() < 0.8 else "NULL" for x in self.three(0.05).split())

    def added(self) -> str:
        """Return a force with variables, in a region at times."""
        return " ".join(self.component(2e-3) for _ in range(3)) + self.region()

    def replaced(self) -> str:
        """Return a force of which some components stay."""
        parts = [self.component(2e-3) if self.rng.uniform() < 0.6 else "NULL" for _ in range(3)]
        return " ".join(parts) + self.region()

    def averaged(self) -> str:
        """Return the same without values of each particle."""
        return self.replaced().replace("v_each", "v_pull")

    def slowed(self) -> str:
        """Return what is taken of a common motion."""
        axes = " ".join(map(str, self.rng.integers(2, size=3)))
        turning = " angular" if self.rng.uniform() < 0.5 else ""
        return f"{int(self.rng.choice([1, 3, 7, 40]))} linear {axes}{turning}"

    def tethered(self) -> str:
        """Return a spring to a point or another group."""
        kind = "couple two" if self.rng.uniform() < 0.5 else "tether"
        rest = self.rng.choice(["0", "0.02"])
        return f"{kind} {self.rng.uniform(1, 20):.3g} {self.point()} {rest}"

    def held(self) -> str:
        """Return a spring to where particles were."""
        return f"{self.rng.uniform(0.1, 5):.3g}" + str(self.rng.choice(["", " x", " xy", " yz"]))

    def braked(self) -> str:
        """Return a drag of one or two strengths."""
        return f"{self.rng.uniform(0, 5e-3):.3g}" + str(self.rng.choice(["", " scale 2 3.5"]))

    def drawn(self) -> str:
        """Return a force towards a point."""
        reach = self.rng.choice(["0.01", "0.05"])
        return f"{self.point()} {self.rng.uniform(0, 5e-3):.3g} {reach}"

    def repelled(self) -> str:
        """Return the potential of a region's surface."""
        style = str(self.rng.choice(["harmonic", "lj93", "lj126", "colloid"]))
        strength = (200.0 if style == "harmonic" else 1e-7) * self.rng.uniform(0.2, 1.0)
        return f"h{int(self.rng.integers(2))} {style} {strength:.3g} 0.01 0.03"

    def lifted(self) -> str:
        """Return a liquid."""
        level, density = self.rng.uniform(0.001, 0.05), self.rng.uniform(200, 1500)
        return f"level {level:.3g} dim z density {density:.4g}" + self.region()

    def add(self) -> list[str]:
        """Return the line of a new fix."""
        kinds = list(KINDS) if self.upright else [kind for kind in KINDS if kind != "buoyancy"]
        kind = str(self.rng.choice(kinds))
        numbers, write = KINDS[kind]
        told, group = f"{kind} {write(self)}", self.group()
        if "couple" in told:
            group = "one"
        elif kind in ("lineforce", "planeforce"):
            group = str(self.rng.choice(["odd", "left"]))
        name = f"f{self.count}"
        self.count += 1
        self.living.append(f"{name} {told}")
        self.taken += [f"f_{name}[{k + 1}]" for k in range(numbers)]
        return [f"fix {name} {group} {told}"]

    def weight(self) -> str:
        """Return the line of the one gravity."""
        ways = (f"vector {self.direction()}", "chute 25", "spherical 30 v_tilt")
        way = "vector 0 0 -1" if self.upright else ways[int(self.rng.integers(3))]
        return f"fix weight all gravity {self.rng.choice(['4.5', 'v_grow'])} {way}"

    def movers(self) -> list[str]:
        """Return what moves the two types and those on the left, groups that do not overlap."""
        rng = self.rng
        ways = [
            "nve/sphere", "nve", "nve/noforce", "nve/limit absolute 2e-6",
            "nve/limit radius_ratio 0.001", f"move linear {self.three(0.3)} units box",
            "move linear 0.2 NULL NULL units box",
            f"move wiggle {self.three(0.004)} 0.003 units box",
            f"move rotate 0 0 0 {self.direction()} 0.02 units box",
            "move variable v_here NULL NULL v_speed NULL NULL units box",
        ]  # fmt: skip
        chosen = [ways[int(rng.choice([0, 0, 1, 3, 4]))], ways[int(rng.integers(len(ways)))]]
        if "limit" in chosen[0] and chosen[1] not in ways[:2]:
            chosen[0] = ways[0]
        if rng.uniform() < 0.5:
            chosen.reverse()
        lines = []
        for number, (group, way) in enumerate(zip(("one", "two"), chosen, strict=True), start=1):
            lines.append(f"fix m{number} {group} {way}")
            if "nve/noforce" in way or "move" in way:
                self.held = group
                lines.append(f"neigh_modify exclude type {number} {number}")
        if rng.uniform() < 0.3 and len(lines) == 2:
            lines += ["fix ice odd freeze", "neigh_modify exclude group odd odd"]
        return lines


KINDS: Mapping[str, tuple[int, Callable[[Scene], str]]] = {
    "addforce": (3, Scene.added), "setforce": (3, Scene.replaced), "aveforce": (3, Scene.averaged),
    "lineforce": (0, Scene.direction), "planeforce": (0, Scene.direction),
    "momentum": (0, Scene.slowed), "spring": (3, Scene.tethered), "spring/self": (0, Scene.held),
    "viscous": (0, Scene.braked), "drag": (3, Scene.drawn), "wall/region": (3, Scene.repelled),
    "buoyancy": (0, Scene.lifted),
}  # fmt: skip
"""Style to how many numbers it tells, and what writes its arguments."""


def _spheres(rng: np.random.Generator, boundary: str) -> list[str]:
    """Return the lines up to the groups: two materials in a cube, variables and regions."""
    spacing = 0.016
    axis = (np.arange(SIDE) - 0.5 * (SIDE - 1)) * spacing
    points = np.stack(np.meshgrid(axis, axis, axis), axis=-1).reshape(-1, 3)
    points = np.round(points + rng.uniform(-1e-3, 1e-3, points.shape), 6)
    radii = np.round(rng.uniform(0.004, 0.0075, len(points)), 5)
    speeds = np.round(rng.normal(size=points.shape) * 0.5, 4)
    half = HALF if boundary != "p p p" else 0.035
    lines = [
        "atom_style granular", "atom_modify map array sort 0 0", f"boundary {boundary}",
        "newton off", "communicate single vel yes", "units si",
        f"region box block -{half} {half} -{half} {half} -{half} {half} units box",
        "create_box 2 box", "neighbor 0.002 bin", "neigh_modify delay 0",
        "fix y all property/global youngsModulus peratomtype 5e6 7e6",
        "fix nu all property/global poissonsRatio peratomtype 0.3 0.2",
        "fix e all property/global coefficientRestitution peratomtypepair 2 0.5 0.6 0.6 0.9",
        "fix mu all property/global coefficientFriction peratomtypepair 2 0.4 0.1 0.1 0.6",
        "pair_style gran model hertz tangential history", "pair_coeff * *", "timestep 1e-5",
        "thermo_modify lost ignore norm no",
        "variable way equal 0.1*step*dt*10", "variable turn equal 30*step*dt",
        "variable pull equal 0.002*sin(1000*step*dt)", "variable grow equal 3+1000*step*dt",
        "variable tilt equal 20+2000*step*dt", "variable each atom 0.01*(x+2*vy)",
        "variable here atom 0.1*y*sin(500*step*dt)", "variable speed atom 50*y*cos(500*step*dt)",
        *(f"region r{k} {text}" for k, text in enumerate(REGIONS)),
        *(f"region h{k} {text}" for k, text in enumerate(HARD)),
        *atoms(points, radii, speeds),
    ]  # fmt: skip
    second = rng.choice(len(points), len(points) // 2, replace=False) + 1
    lines += [f"set atom {k} type 2" for k in sorted(second)]
    return [
        *lines,
        "group one type 1", "group two type 2",
        "region half block -0.1 0 -0.1 0.1 -0.1 0.1 units box",
        "group left region half", "group odd id " + " ".join(map(str, range(1, len(points), 5))),
    ]  # fmt: skip


def batch(seed: int) -> Batch:
    """Return the scene of a seed."""
    rng = np.random.default_rng([45, seed])
    boundary = str(rng.choice(["f f f", "p p f", "p p p", "m f f"]))
    lines, scene = _spheres(rng, boundary), Scene(rng)
    fixes = [line for _ in range(int(rng.integers(2, 6))) for line in scene.add()]
    # LIGGGHTS reads uninitialized memory where buoyancy comes before a gravity that varies.
    fixes.insert(0 if scene.upright else int(rng.integers(len(fixes) + 1)), scene.weight())
    lines += fixes
    movers = scene.movers()
    lines = [*lines, *movers] if rng.uniform() < 0.5 else [*lines[:-1], *movers, lines[-1]]
    if boundary != "p p p" and rng.uniform() < 0.6:
        touching = "two" if scene.held == "one" else "one" if scene.held == "two" else "all"
        lines.append(
            f"fix wall {touching} wall/gran model hertz tangential history primitive type 1 "
            "zplane -0.03"
        )
    if scene.taken:
        lines.append(f"fix told all ave/time 1 1 {EVERY} {' '.join(scene.taken)} file told.txt")
    lines += dump("out", EVERY, "id x y z vx vy vz fx fy fz omegax omegay omegaz tqx tqy tqz")
    lines.append(f"run {STEPS}")
    if rng.uniform() < 0.5 and scene.living and not scene.taken:
        lines.append(f"unfix {scene.living.pop(int(rng.integers(len(scene.living)))).split()[0]}")
    lines += scene.add()
    if rng.uniform() < 0.3:
        lines.append(str(rng.choice([
            "velocity left set 0.1 NULL 0", "displace_atoms odd move 0.001 0 0 units box",
            "group odd id 2 7 12", "set group two density 1500", "reset_timestep 260",
        ])))  # fmt: skip
    lines += [f"run {STEPS}", ""]
    outputs = ("out.dump", "told.txt") if scene.taken else ("out.dump",)
    return Batch(f"forces-{seed}", "\n".join(lines), outputs, 1)
