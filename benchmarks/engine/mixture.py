"""Settled heaps for ``engine_speed.py``: what all have in common, and grains of several sizes."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from minidem import run_script

__all__ = ["COUNT", "head", "mixture_script"]

COUNT = 8000
SMALLEST, LARGEST = 0.0004, 0.0012  # radii, m
DENSITY = 3500.0  # kg/m3
TIMESTEP = 1e-5  # s
MODEL = "model hertz tangential history rolling_friction epsd2"
PRIMES = (
    15485863, 15485867, 15485917, 15485927, 15485933, 15485941, 15485959, 15485989,
    15485993, 15486013, 15486041, 15486047, 15486059, 15486071, 15486101, 15486139,
)  # fmt: skip


def head(classes: int, timestep: float) -> str:
    """Return the script up to the grains; a class is an atom type, the walls are the last."""
    types = classes + 1
    each = " ".join(["5e6"] * types)
    ratio = " ".join(["0.3"] * types)
    values = {"Restitution": 0.5, "Friction": 0.6, "RollingFriction": 0.1}
    pairs = "".join(
        f"fix m{name} all property/global coefficient{name} peratomtypepair {types}"
        f" {' '.join([str(value)] * types**2)}\n"
        for name, value in values.items()
    )
    return f"""atom_style granular
atom_modify map array sort 0 0
boundary f f f
newton off
communicate single vel yes
units si
processors * 1 1
region domain block -0.03 0.03 -0.03 0.03 -0.002 0.08 units box
create_box {types} domain
neighbor 0.00016 bin
neigh_modify delay 0 contact_distance_factor 1.01
fix my all property/global youngsModulus peratomtype {each}
fix mp all property/global poissonsRatio peratomtype {ratio}
{pairs}pair_style gran {MODEL}
pair_coeff * *
timestep {timestep:g}
fix g all gravity 9.81 vector 0 0 -1
fix floor all wall/gran {MODEL} primitive type {types} zplane 0.0
fix cyl all wall/gran {MODEL} primitive type {types} zcylinder 0.022 0 0
fix integr all nve/sphere
thermo_style custom step atoms ke
thermo_modify lost ignore norm no
"""


def mixture_script(folder: Path, classes: int, steps: int) -> None:
    """Let minidem settle a mixture, and write a script that starts from it.

    Parameters
    ----------
    folder : Path
        Where ``in.script`` is written.
    classes : int
        Number of sizes, as many grains of each.
    steps : int
        Of the second run, which is the one to time.
    """
    radii = np.linspace(SMALLEST, LARGEST, classes)
    templates = "".join(
        f"fix p{k} all particletemplate/sphere {PRIMES[k - 1]} atom_type {k}"
        f" density constant {DENSITY} radius constant {radius:.17g}\n"
        for k, radius in enumerate(radii, 1)
    )
    weights = " ".join(f"p{k} {1 / classes}" for k in range(1, classes + 1))
    fill = f"""{templates}fix pdd all particledistribution/discrete/numberbased 67867967 {classes} {weights}
region fill cylinder z 0 0 0.021 0.001 0.078 units box
fix ins all insert/pack seed 86028121 distributiontemplate pdd maxattempt 100 insert_every once &
 overlapcheck yes all_in yes vel constant 0 0 -0.4 region fill particles_in_region {COUNT}
dump d all custom 12000 settled.dump id type x y z
dump_modify d sort id format "%d %d %.17g %.17g %.17g"
run 12000
"""  # noqa: E501 - a line of the script
    (folder / "in.fill").write_text(head(classes, TIMESTEP) + "thermo 12000\n" + fill)
    run_script(folder / "in.fill", root=folder)
    rows = (folder / "settled.dump").read_text().rpartition("ITEM: ATOMS")[2].splitlines()[1:]
    lines = [
        f"create_atoms {kind} single {x} {y} {z} units box"
        for _, kind, x, y, z in (row.split() for row in rows)
    ]
    lines += [
        f"set type {k} density {DENSITY} diameter {2 * radius:.17g}"
        for k, radius in enumerate(radii, 1)
    ]
    text = (
        head(classes, TIMESTEP) + "thermo 100000\n" + "\n".join(lines) + f"\nrun 300\nrun {steps}\n"
    )
    (folder / "in.script").write_text(text)
