"""Compile what nearly every script needs, to come with the package.

    python -m minidem.ship [FOLDER]

Scripts of a few steps run, with one thread and with two, in a cache of their own, and the machine
code that they needed is kept with a note of what it was made for. It is made for a class of
processors, so that a package that was built on one machine serves another.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import Final

from minidem.kernels.machine.cache import MADE_FOR, SHIPPED, compiler, sources, system
from minidem.kernels.machine.library import LIBRARY

__all__ = ["note", "ship"]

CLASSES: Final = {
    "x86-64-v3": ("avx", "avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe", "popcnt"),
    "x86-64": (),
}
"""Classes of processors, the best first, and the features that all of a class have."""
ROOT: Final = Path(__file__).resolve().parents[1]
RUN: Final = """
import sys
sys.path.insert(0, sys.argv.pop(1))
from minidem.cli import main
sys.exit(main())
"""
"""Runs minidem from this very folder, wherever Python would look for it."""
THREADS: Final = (1, 2)
CODE: Final = (".bin", LIBRARY)
SURFACE: Final = """solid plate
facet normal 0 0 1
outer loop
vertex -0.05 -0.05 0.01
vertex 0.05 -0.05 0.01
vertex 0.05 0.05 0.01
endloop
endfacet
endsolid plate
"""
SCRIPT: Final = """
atom_style granular
boundary f f f
newton off
communicate single vel yes
units si
region box block -0.05 0.05 -0.05 0.05 0 0.1 units box
create_box 1 box
neighbor 0.002 bin
neigh_modify delay 0
fix a all property/global youngsModulus peratomtype 5e6
fix b all property/global poissonsRatio peratomtype 0.3
fix c all property/global coefficientRestitution peratomtypepair 1 0.5
fix d all property/global coefficientFriction peratomtypepair 1 0.5
fix e all property/global coefficientRollingFriction peratomtypepair 1 0.1
pair_style gran model hertz tangential history rolling_friction epsd2
pair_coeff * *
timestep 1e-5
fix down all gravity 9.81 vector 0 0 -1
fix floor all wall/gran model hertz tangential history rolling_friction epsd2 &
    primitive type 1 zplane 0
fix plate all mesh/surface file plate.stl type 1
fix plates all wall/gran model hertz tangential history rolling_friction epsd2 &
    mesh n_meshes 1 meshes plate
fix shake all move/mesh mesh plate wiggle amplitude 0.001 0 0 period 0.1
fix sort all particletemplate/sphere 15485863 atom_type 1 density constant 2500 &
    radius constant 0.001
fix mix all particledistribution/discrete 15485867 1 sort 1
region lower block -0.04 0.04 -0.04 0.04 0.02 0.03 units box
region upper cylinder z 0 0 0.02 0.06 0.09 units box
fix pack all insert/pack seed 49979687 distributiontemplate mix insert_every once &
    overlapcheck yes all_in yes particles_in_region 300 region lower
fix rain all insert/rate/region seed 32452843 distributiontemplate mix nparticles 20 &
    particlerate 1e5 insert_every 50 overlapcheck yes all_in yes vel constant 0 0 -1 region upper
fix move all nve/sphere
compute turn all erotate/sphere
thermo 50
thermo_style custom step atoms ke c_turn
dump out all custom 50 dump.* id type x y z vx vy vz radius omegax
run 100
"""
"""What most scripts do: particles that are poured, walls, a mesh that moves, a dump."""


def ship(folder: Path = SHIPPED) -> None:
    """Compile and keep machine code.

    Parameters
    ----------
    folder : Path
        Where it is kept; machine code that was there is replaced, unless it is what would be made.

    Raises
    ------
    FileExistsError
        If the folder holds anything else.
    CalledProcessError
        If a script does not run.
    """
    made_for = note()
    with suppress(OSError):
        if (folder / MADE_FOR).read_text(encoding="utf-8") == made_for:
            return
    for one in folder.glob("*"):
        if one.name != MADE_FOR and one.suffix not in CODE:
            msg = f"{folder}: holds {one.name}, which is no machine code; name another folder"
            raise FileExistsError(msg)
    with tempfile.TemporaryDirectory() as scratch:
        place = Path(scratch)
        env = {**os.environ, "XDG_CACHE_HOME": scratch, "NUMBA_CPU_NAME": _class()[0]}
        env["NUMBA_CPU_FEATURES"] = ""
        started = []
        for threads in THREADS:
            room = place / str(threads)
            room.mkdir()
            (room / "plate.stl").write_text(SURFACE, encoding="utf-8")
            (room / "in.script").write_text(SCRIPT, encoding="utf-8")
            words = ["-in", "in.script", "-threads", str(threads), "-screen", "none"]
            command = [sys.executable, "-c", RUN, str(ROOT), *words]
            started.append(subprocess.Popen(command, cwd=room, env=env))
        for process in started:
            if process.wait() != 0:
                raise subprocess.CalledProcessError(process.returncode, process.args)
        made = [file for file in place.glob("bulkcal/kernels-*/*") if file.suffix in CODE]
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        for code in made:
            shutil.copyfile(code, folder / code.name)  # others than who installs may read it
    (folder / MADE_FOR).write_text(made_for, encoding="utf-8")


def note() -> str:
    """Return what is noted beside machine code of this machine: for what it is made."""
    name, features = _class()
    script = hashlib.sha256((SCRIPT + SURFACE).encode()).hexdigest()
    facts = {
        "sources": sources(), "script": script, "compiler": compiler(), "system": system(),
        "processor": name, "features": features,
    }  # fmt: skip
    return json.dumps(facts, indent=1) + "\n"


def _class() -> tuple[str, tuple[str, ...]]:
    """Return the best class of processors that this one belongs to, and its features."""
    import llvmlite.binding as llvm

    here = {name for name, has in llvm.get_host_cpu_features().items() if has}
    if system().endswith(("x86_64", "AMD64")):
        for name, features in CLASSES.items():
            if set(features) <= here:
                return name, features
    return "generic", ()


if __name__ == "__main__":
    words = argparse.ArgumentParser(description="Compile what nearly every script needs.")
    words.add_argument("folder", nargs="?", type=Path, default=SHIPPED, help="default: the package")
    ship(words.parse_args().folder)
