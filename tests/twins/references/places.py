"""What the scripts of all families begin with, and points on which branches part."""

from __future__ import annotations

import numpy as np

HALF = 0.1  # m, half the box
GRID = HALF / 16.0  # m, exact in binary and in a script: points and faces coincide at times


def header(boundary: str = "f f f", half: float = HALF, skin: float = 0.002) -> list[str]:
    """Return the lines up to the properties of a material."""
    return [
        "atom_style granular", "atom_modify map array sort 0 0", f"boundary {boundary}",
        "newton off", "communicate single vel yes", "units si",
        f"region box block {-half!r} {half!r} {-half!r} {half!r} {-half!r} {half!r} units box",
        "create_box 1 box", f"neighbor {skin!r} bin", "neigh_modify delay 0",
        "fix y all property/global youngsModulus peratomtype 5e6",
        "fix nu all property/global poissonsRatio peratomtype 0.3",
        "fix e all property/global coefficientRestitution peratomtypepair 1 0.5",
        "fix mu all property/global coefficientFriction peratomtypepair 1 0.4",
        "pair_style gran model hertz tangential history", "pair_coeff * *", "timestep 1e-5",
        "thermo_modify lost ignore norm no",
    ]  # fmt: skip


def place(rng: np.random.Generator, low: float = -1.0, high: float = 1.0) -> float:
    """Return a coordinate between fractions of half the box, on a grid in half of all cases."""
    x = float(rng.uniform(low, high) * HALF)
    return round(x / GRID) * GRID if rng.uniform() < 0.5 else x


def words(values: object) -> str:
    """Return numbers as a script writes them."""
    return " ".join(map(repr, map(float, values)))


def atoms(points: np.ndarray, radii: np.ndarray, speeds: np.ndarray) -> list[str]:
    """Return the lines that make spheres."""
    lines = []
    for k, (x, r, v) in enumerate(zip(points, radii, speeds, strict=True), start=1):
        lines += [
            f"create_atoms 1 single {words(x)} units box",
            f"set atom {k} density 2500 diameter {2.0 * float(r)!r}",
            f"set atom {k} vx {float(v[0])!r} vy {float(v[1])!r} vz {float(v[2])!r}",
        ]
    return lines


def dump(name: str, every: int, columns: str, group: str = "all") -> list[str]:
    """Return the lines of a dump in full precision, the id first."""
    forms = "%d" + " %.17g" * (len(columns.split()) - 1)
    return [
        f"dump {name} {group} custom {every} {name}.dump {columns}",
        f'dump_modify {name} sort id first yes format "{forms}"',
    ]
