"""Piles of two-dimensional "disks": spheres whose centres stay in the plane y = 0.

Material of Ai, Chen, Rotter and Ooi, Powder Technology 206 (2011) 269, as the open example
2d-sandpile-formation of Lethe gives it; e = 0.7 is assumed there. That example also has the hopper:
its walls fall at 50.5 degrees to an outlet of 70 mm, 0.57 m above the floor.
"""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path

import numpy as np

SMALL, LARGE = 0.0069, 0.0089
"""Diameters, m; five of six disks are small."""
DT = 5e-5
FLOOR = -0.57

_HEAD = """atom_style granular
atom_modify map array sort 0 0
boundary f f f
newton off
communicate single vel yes
units si
soft_particles yes
region box block -1.1 1.1 -0.05 0.05 -0.6 2.0 units box
create_box 1 box
neighbor 0.002 bin
neigh_modify delay 0 contact_distance_factor 1.01
fix m1 all property/global youngsModulus peratomtype 4e6
fix m2 all property/global poissonsRatio peratomtype 0.49
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.7
fix m4 all property/global coefficientFriction peratomtypepair 1 0.8
fix m5 all property/global coefficientRollingFriction peratomtypepair 1 0.3
pair_style gran model {model}
pair_coeff * *
timestep {dt}
fix weight all gravity 9.81 vector 0 0 -1
fix floor all wall/gran model {model} primitive type 1 zplane {floor}
"""
_TAIL = """fix plane all setforce NULL 0 NULL
fix motion all nve/sphere
variable top equal bound(all,zmax)-({floor})
variable mean equal xcm(all,z)-({floor})
thermo_style custom step atoms ke v_top v_mean
thermo_modify lost error norm no
"""


def disks(count: int, width: float, low: float, rng: np.random.Generator) -> list[str]:
    """Return commands that place disks on a jittered lattice above a height."""
    gap = 1.18 * LARGE
    across = int(width / gap)
    lines = []
    for k in range(count):
        x = (k % across + 0.5) * gap - 0.5 * across * gap + rng.uniform(-5e-4, 5e-4)
        z = low + (k // across + 0.5) * gap + rng.uniform(-5e-4, 5e-4)
        size = LARGE if rng.random() < 1.0 / 6.0 else SMALL
        lines += [
            f"create_atoms 1 single {x:.9g} 0 {z:.9g} units box",
            f"set atom {k + 1} density 1056 diameter {size}",
        ]
    return lines


def column(
    model: str, rng: np.random.Generator, count: int, times: tuple[float, float, int]
) -> str:
    """Return a script: a column of disks settles between two walls, which then vanish.

    Parameters
    ----------
    model : str
        Words of the contact model.
    rng : numpy.random.Generator
        For the places of the disks.
    count : int
        Number of disks.
    times : tuple
        Time to settle and time of the pile, s, and number of heights printed of the latter.
    """
    settle, stay, frames = times
    every = round(stay / DT / frames)
    lines = [
        _HEAD.format(model=model, dt=DT, floor=FLOOR),
        *disks(count, 0.12, FLOOR, rng),
        f"fix left all wall/gran model {model} primitive type 1 xplane -0.065",
        f"fix right all wall/gran model {model} primitive type 1 xplane 0.065",
        _TAIL.format(floor=FLOOR),
        "thermo 0",
        f"run {round(settle / DT)}",
        "unfix left",
        "unfix right",
        f"thermo {every}",
        f"run {every * frames}",
        "",
    ]
    return "\n".join(lines)


def hopper(model: str, rng: np.random.Generator, folder: Path, end: float) -> str:
    """Return the script of the whole example with 3000 disks, and write its walls.

    The gate is a plane at height 0 that vanishes after 4.5 s.
    """
    corners = [(0.505, 1.3), (0.505, 0.57), (0.035, 0.0), (0.035, -0.22)]
    facets = []
    for side in (-1.0, 1.0):
        for (xa, za), (xb, zb) in pairwise(corners):
            quad = [(side * xa, -0.03, za), (side * xb, -0.03, zb), (side * xb, 0.03, zb)]
            facets += [quad, [quad[0], quad[2], (side * xa, 0.03, za)]]
    text = ["solid hopper"]
    for facet in facets:
        text += ["facet normal 0 0 0", "outer loop"]
        text += [f"vertex {x:.9g} {y:.9g} {z:.9g}" for x, y, z in facet]
        text += ["endloop", "endfacet"]
    (folder / "hopper.stl").write_text("\n".join([*text, "endsolid hopper", ""]))
    every = round(0.25 / DT)
    lines = [
        _HEAD.format(model=model, dt=DT, floor=FLOOR),
        *disks(3000, 0.68, 0.35, rng),
        "fix hopper all mesh/surface file hopper.stl type 1",
        f"fix sides all wall/gran model {model} mesh n_meshes 1 meshes hopper",
        f"fix left all wall/gran model {model} primitive type 1 xplane -1",
        f"fix right all wall/gran model {model} primitive type 1 xplane 1",
        f"fix gate all wall/gran model {model} primitive type 1 zplane 0",
        _TAIL.format(floor=FLOOR),
        f"thermo {every}",
        f"run {round(4.5 / DT)}",
        "unfix gate",
        f"run {round((end - 4.5) / DT)}",
        "",
    ]
    return "\n".join(lines)


def heights(log: Path) -> np.ndarray:
    """Return step, disks, kinetic energy, J, highest and mean height of the centres, m."""
    row = re.compile(r"\s+\d+\s+\d+(\s+[-+.\de]+){3}\s*")
    lines = [line for line in log.read_text().splitlines() if row.fullmatch(line)]
    return np.array([[float(word) for word in line.split()] for line in lines])
