"""Insertion: six commands per script, each in a cell of its own, of all styles and options."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from tests.twins.references.batch import Batch
from tests.twins.references.places import HALF, dump, header, words
from tests.twins.references.shapes import fan, plate
from tests.twins.scene import Mesh, stl_text

CELLS = 6
CELL = 0.03  # m, half the width
STEPS = 120
SMALL, LARGE = 0.0008, 0.002  # m, radii
STYLES = ("insert/pack", "insert/rate/region", "insert/stream")


def primes(count: int) -> list[int]:
    """Return primes above 10000, which LIGGGHTS wants for seeds."""
    found: list[int] = []
    number = 10_001
    while len(found) < count:
        if all(number % k for k in range(3, int(number**0.5) + 1, 2)):
            found.append(number)
        number += 2
    return found


class Cell:
    """One insertion command with its templates, distribution and region or face."""

    def __init__(self, rng: np.random.Generator, k: int, primes: list[int]) -> None:
        self.rng, self.k = rng, k
        self.primes = primes
        self.centre = np.array([(k % 3 - 1) * 0.06, (k // 3 - 0.5) * 0.06, 0.0])
        self.lines: list[str] = []
        self.files: dict[str, str] = {}

    def prime(self) -> int:
        """Take a prime that nobody has."""
        return self.primes.pop(int(self.rng.integers(len(self.primes))))

    def make(self) -> list[str]:
        """Return all lines."""
        self._distribution()
        style = str(self.rng.choice(STYLES))
        self.lines.append(self._command(style, ""))
        return self.lines

    def _distribution(self) -> None:
        rng, k = self.rng, self.k
        kinds = int(rng.integers(1, 4))
        shares = []
        for j in range(kinds):
            radius, density = rng.uniform(SMALL, LARGE), rng.uniform(1000.0, 3000.0)
            self.lines.append(
                f"fix t{k}{j} all particletemplate/sphere {self.prime()} atom_type 1 "
                f"density constant {density!r} radius constant {radius!r}"
            )
            shares += [f"t{k}{j}", repr(float(rng.uniform(0.2, 1.0)))]
        form = rng.choice(["", "/numberbased", "/massbased"])
        self.lines.append(
            f"fix d{k} all particledistribution/discrete{form} {self.prime()} {kinds} "
            + " ".join(shares)
        )

    def _command(self, style: str, suffix: str) -> str:
        """Return a command; what it refers to is added to the lines."""
        common = (
            f"fix i{self.k}{suffix} all {style} seed {self.prime()} distributiontemplate d{self.k}"
        )
        return f"{common} {getattr(self, '_' + style.split('/')[1])()}"

    def _yes(self) -> str:
        return str(self.rng.choice(["yes", "no"]))

    def _motion(self) -> str:
        v = self.rng.normal(size=3) * 0.1
        if self.rng.uniform() < 0.5:
            return f"vel constant {words(v)}"
        style = self.rng.choice(["uniform", "gaussian"])
        return f"vel {style} {words(v)} {words(self.rng.uniform(0.01, 0.1, 3))}"

    def _pack(self) -> str:
        rng = self.rng
        every = rng.choice(["once", "40"])
        target = rng.choice(
            [
                f"particles_in_region {int(rng.integers(1, 120))}",
                f"volumefraction_region {rng.uniform(0.01, 0.3)!r}",
                f"mass_in_region {rng.uniform(1e-5, 1e-3)!r}",
            ]
        )
        return (
            f"maxattempt {int(rng.integers(2, 60))} insert_every {every} "
            f"overlapcheck {self._yes()} all_in {self._yes()} {self._motion()} "
            f"region {self._region()} {target} ntry_mc 2000"
        )

    def _rate(self) -> str:
        rng = self.rng
        amount = rng.choice(["nparticles INF", f"nparticles {int(rng.integers(10, 200))}"])
        rate = rng.choice(
            [f"particlerate {rng.uniform(1e4, 1e5)!r}", f"massrate {rng.uniform(0.1, 2.0)!r}"]
        )
        return (
            f"maxattempt {int(rng.integers(2, 60))} {amount} {rate} insert_every 40 "
            f"overlapcheck {self._yes()} all_in {self._yes()} {self._motion()} "
            f"region {self._region()} ntry_mc 2000"
        )

    def _region(self) -> str:
        """Define a region of any kind in the cell and return its name."""
        names = []
        for j in range(int(self.rng.choice([1, 1, 2, 3]))):
            names.append(f"r{self.k}{j}")
            side = "side out" if j and self.rng.uniform() < 0.3 else ""
            self.lines.append(f"region {names[-1]} {self._shape()} units box {side}")
        if len(names) == 1:
            return names[0]
        kind = self.rng.choice(["union", "intersect"])
        if any(line.endswith("side out") for line in self.lines):
            kind = "intersect"
        self.lines.append(f"region r{self.k} {kind} {len(names)} {' '.join(names)}")
        return f"r{self.k}"

    def _shape(self) -> str:
        rng, c = self.rng, self.centre + self.rng.uniform(-0.15, 0.15, 3) * CELL
        size = rng.uniform(0.3, 0.7, 3) * CELL
        style = rng.choice(["block", "sphere", "cylinder"])
        if style == "block":
            return f"block {words(np.stack([c - size, c + size], axis=1).ravel())}"
        if style == "sphere":
            return f"sphere {words(c)} {float(size[0])!r}"
        axis = int(rng.integers(3))
        across = [c[d] for d in range(3) if d != axis]
        ends = (c[axis] - size[1], c[axis] + size[1])
        return f"cylinder {'xyz'[axis]} {words(across)} {float(size[0])!r} {words(ends)}"

    def _face(self) -> tuple[np.ndarray, bool]:
        """Define a face; return its normal and whether it is declared planar."""
        rng, k = self.rng, self.k
        nodes = (plate(rng) if rng.uniform() < 0.5 else fan(rng) * np.array([1.0, 1.0, 0.0])) * 0.8
        turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        turn = np.eye(3) if rng.uniform() < 0.3 else turn
        nodes = nodes @ turn.T + self.centre
        self.files[f"face{k}.stl"] = stl_text(Mesh(tuple(map(tuple, nodes.tolist()))))
        planar = bool(rng.integers(2))
        self.lines.append(
            f"fix face{k} all mesh/surface{'/planar' if planar else ''} file face{k}.stl type 1 "
            "curvature 0.01 curvature_tolerant yes"
        )
        a, b, c = nodes[0]
        normal = np.cross(b - a, c - a)
        return normal / np.linalg.norm(normal), planar

    def _speed(self) -> float:
        """Return the speed of a stream, m/s; below zero against the normal."""
        return float(self.rng.uniform(5.0, 20.0) * self.rng.choice([-1.0, 1.0]))

    def _stream(self) -> str:
        rng, k = self.rng, self.k
        normal, planar = self._face()
        v = normal * self._speed()
        all_in = self._yes() if planar else "no"
        return (
            f"maxattempt {int(rng.integers(2, 60))} nparticles {int(rng.integers(10, 200))} "
            f"particlerate {rng.uniform(1e4, 1e5)!r} overlapcheck {self._yes()} all_in {all_in} "
            f"vel constant {words(v)} insertion_face face{k} "
            f"extrude_length {rng.uniform(3.1, 6.0) * LARGE!r} ntry_mc 2000"
        )


Beside: TypeAlias = Callable[[np.random.Generator, list[Cell]], list[str]]


def nothing(_rng: np.random.Generator, _cells: list[Cell]) -> list[str]:
    """Put nothing beside the insertions."""
    return []


def batch_of(name: str, rng: np.random.Generator, beside: Beside) -> Batch:
    """Return six insertion commands, beside what some lines make."""
    numbers = primes(200)
    cells = [Cell(rng, k, numbers) for k in range(CELLS)]
    boundary = str(rng.choice(["f f f", "p p p", "p f p"]))
    lines = [*header(boundary, HALF, 0.001), *beside(rng, cells)]
    files: dict[str, str] = {}
    for cell in cells:
        lines += cell.make()
        files |= cell.files
    lines += ["fix free all nve/sphere", *dump("out", 20, "id x y z vx vy vz radius mass")]
    lines += [f"run {STEPS}", ""]
    return Batch(name, "\n".join(lines), ("out.dump",), CELLS, files)


def batch(seed: int) -> Batch:
    """Return six insertion commands of a seed."""
    return batch_of(f"insertions-{seed}", np.random.default_rng([43, seed]), nothing)
