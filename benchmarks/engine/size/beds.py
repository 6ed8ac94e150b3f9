"""A settled bed of grains, and restart files that hold it many times side by side."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from minidem import run_script
from minidem.run.restarts.own_file import MAGIC

COUNT = 1000
RADIUS = 0.0008  # m
SIDE = 14 * RADIUS  # seven grains
MODEL = "model hertz tangential history rolling_friction epsd2"

HEAD = """atom_style granular
atom_modify map array sort 0 0
boundary p p f
newton off
communicate single vel yes
units si
"""

BOX = f"""region domain block 0 {SIDE} 0 {SIDE} -0.001 0.12 units box
create_box 1 domain
"""

PHYSICS = f"""neighbor 0.00024 bin
neigh_modify delay 0 contact_distance_factor 1.01 LISTS
fix m1 all property/global youngsModulus peratomtype 5e6
fix m2 all property/global poissonsRatio peratomtype 0.3
fix m3 all property/global coefficientRestitution peratomtypepair 1 .5
fix m4 all property/global coefficientFriction peratomtypepair 1 .6
fix m5 all property/global coefficientRollingFriction peratomtypepair 1 .1
pair_style gran {MODEL}
pair_coeff * *
timestep 2e-5
fix g all gravity 9.81 vector 0 0 -1
fix floor all wall/gran {MODEL} primitive type 1 zplane 0.0
fix integr all nve/sphere
thermo_style custom step atoms ke
thermo_modify lost error norm no
thermo 1000000
"""

FILL = f"""fix pts all particletemplate/sphere 15485863 atom_type 1 density constant 3500 &
 radius constant {RADIUS}
fix pdd all particledistribution/discrete 32452843 1 pts 1.0
region fill block 0 {SIDE} 0 {SIDE} 0.001 0.11 units box
fix ins all insert/pack seed 86028121 distributiontemplate pdd maxattempt 100 insert_every once &
 overlapcheck yes all_in no vel constant 0 0 -0.4 region fill particles_in_region {COUNT}
run 12000
unfix ins
write_restart bed.npz
"""

DIGEST = hashlib.sha256().digest_size


def settle(folder: Path) -> Path:
    """Make the bed that is repeated; return its restart file."""
    text = HEAD + BOX + PHYSICS.replace("LISTS", "") + FILL
    (folder / "in.fill").write_text(text)
    run_script(folder / "in.fill", root=folder)
    return folder / "bed.npz"


def arrays_of(path: Path) -> dict[str, NDArray[Any]]:
    """Return the arrays of a restart file."""
    with path.open("rb") as file:
        file.seek(len(MAGIC) + DIGEST)
        with np.load(file) as archive:
            return {name: archive[name] for name in archive.files}


def repeat(bed: Path, target: Path, size: int) -> int:
    """Write a restart file with the bed repeated side by side; return the number of particles."""
    copies = max(1, round(size / COUNT))
    wide = max(k for k in range(1, int(np.sqrt(copies)) + 1) if copies % k == 0)
    counts = (wide, copies // wide)
    arrays = arrays_of(bed)
    meta = json.loads(arrays["meta"].tobytes())
    n = meta["particles"]
    for name, table in arrays.items():
        if name.startswith("state_") and name != "state_marker":
            arrays[name] = np.concatenate([table] * copies)
        elif name.startswith(("pairs_", "walls_")):
            arrays[name] = table[:0] if not name.endswith("start") else np.zeros(1, np.int64)
    shift = np.array([(i, j) for i in range(counts[0]) for j in range(counts[1])]) * SIDE
    arrays["state_row"][:, :2] += np.repeat(shift, n, axis=0)
    arrays["state_ids"] = 1 + np.arange(n * copies)
    arrays["state_rank"] = np.arange(n * copies)
    arrays["state_marker"] = np.zeros((0, n * copies), np.int8)
    arrays["box"][1::2, :2] = np.array(counts) * SIDE
    meta.update(particles=n * copies, top_id=n * copies, before=0)
    arrays["meta"] = np.frombuffer(json.dumps(meta).encode(), np.uint8)
    with target.open("w+b") as file:
        file.write(MAGIC + bytes(DIGEST))
        np.savez(file, **arrays)  # type: ignore[arg-type]  # numpy's names for keywords
        file.seek(len(MAGIC) + DIGEST)
        digest = hashlib.file_digest(file, "sha256").digest()
        file.seek(len(MAGIC))
        file.write(digest)
    return n * copies
