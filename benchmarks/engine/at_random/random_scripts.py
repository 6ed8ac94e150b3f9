"""Random scripts on minidem and LIGGGHTS.

    python benchmarks/engine/at_random/random_scripts.py --count 20 [--further] [--between]

Every seed makes one script: contact models and settings of pairs and walls, a bidisperse filling by
insertion or a lattice, walls of facets or primitives, motions, counters, several runs; with
``--between`` fixes, particles and settings change between the runs. Both engines run it; printed is
the largest difference of positions, velocities and forces as a fraction of the largest value, in
the first frames and in the last. Rounding grows in collisions, so late differences up to about 1e-6
mean little; a jump between two frames means that a rule differs. Frames are not sorted, so that
the order in which particles are held is compared as well.
"""

from __future__ import annotations

import math
import random
import sys
from functools import partial
from itertools import pairwise
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3]))

from benchmarks.engine.at_random.between_runs import between_runs, box_of
from benchmarks.engine.at_random.both import LIGGGHTS, MINIDEM, each_seed, run_both, seeds
from benchmarks.engine.at_random.further_models import further_materials, further_models
from tests.minidem.engine import cases as engine_cases
from tests.minidem.engine.cases import COLUMNS, pipe, plate, stl_text

STEPS = 4000
FRAMES = 20
PAIR_MODELS = 24
"""Models of pairs to choose from; each is compiled once."""
JUMP = 1e4
"""Growth from one frame to the next that rounding alone does not explain."""
SMALL = 1e-9
ABSOLUTE = 1e-15
Texts = dict[str, str]


def models(draw: random.Random) -> tuple[str, str]:
    """Return model words and settings."""
    normal = draw.choice(["hertz", "hooke"])
    words = f"model {normal} tangential {draw.choice(['history', 'history', 'no_history'])}"
    cohesion = draw.choice(["", "", "sjkr", "sjkr2"])
    rolling = draw.choice(["", "cdt", "epsd", "epsd2"])
    words += f" cohesion {cohesion}" if cohesion else ""
    words += f" rolling_friction {rolling}" if rolling else ""
    settings = []
    for key, part in (("tangential_damping", "off"), ("limitForce", "on")):
        if draw.random() < 0.25:
            settings.append(f"{key} {part}")
    if rolling and draw.random() < 0.3:
        settings.append("torsionTorque on")
    if cohesion and draw.random() < 0.4:
        settings.append("tangential_reduce on")
    if normal == "hooke" and draw.random() < 0.4:
        settings.append("ktToKnUser on")
    return words, " ".join(settings)


def material(draw: random.Random) -> list[str]:
    """Return material values of two types, symmetric per pair."""
    lines = [
        "fix m1 all property/global youngsModulus peratomtype "
        f"{draw.uniform(5e6, 2e7):.6g} {draw.uniform(5e6, 2e7):.6g}",
        "fix m2 all property/global poissonsRatio peratomtype "
        f"{draw.uniform(0.1, 0.45):.3f} {draw.uniform(0.1, 0.45):.3f}",
        f"fix m3 all property/global characteristicVelocity scalar {draw.uniform(0.5, 3):.3f}",
    ]
    ranges = {
        "coefficientRestitution": (0.2, 0.9), "coefficientFriction": (0.0, 1.0),
        "coefficientRollingFriction": (0.0, 0.4), "cohesionEnergyDensity": (0.0, 3e4),
        "coefficientRollingViscousDamping": (0.0, 0.6),
    }  # fmt: skip
    for k, (name, (low, high)) in enumerate(ranges.items()):
        a, b, c = (f"{draw.uniform(low, high):.5g}" for _ in range(3))
        lines.append(f"fix p{k} all property/global {name} peratomtypepair 2 {a} {b} {b} {c}")
    return lines


def filling(draw: random.Random) -> list[str]:
    """Return lines that fill the box with two sizes."""
    small = draw.uniform(0.002, 0.003)
    large = small * draw.uniform(1.0, 1.6)
    speed = " ".join(f"{draw.uniform(-0.3, 0.3):.3f}" for _ in range(2))
    region = draw.choice(
        ["block -0.02 0.02 -0.02 0.02 0.002 0.05 units box", "cylinder z 0 0 0.02 0.003 0.05",
         "sphere 0 0 0.026 0.022"]
    )  # fmt: skip
    style = draw.choice(["discrete", "discrete/massbased", "discrete/numberbased"])
    lines = [
        f"region fill {region}",
        "fix ps all particletemplate/sphere 15485863 atom_type 1 density constant "
        f"{draw.uniform(1000, 3000):.1f} radius constant {small:.6f}",
        "fix pl all particletemplate/sphere 15485867 atom_type 2 density constant "
        f"{draw.uniform(1000, 3000):.1f} radius constant {large:.6f}",
        f"fix pd all particledistribution/{style} 32452843 2 ps 0.4 pl 0.6",
    ]
    common = (
        f"distributiontemplate pd {{}} overlapcheck yes all_in {draw.choice(['yes', 'no'])} "
        f"vel {draw.choice(['constant', 'uniform'])} {speed} -0.5"
    )
    common += " 0.1 0.1 0.2" if "uniform" in common else ""
    if draw.random() < 0.6:
        goal = draw.choice(["particles_in_region 60", "volumefraction_region 0.12",
                            "mass_in_region 0.003"])  # fmt: skip
        every = draw.choice(["insert_every once", "insert_every 900"])
        lines.append(
            f"fix ins all insert/pack seed 32452867 maxattempt 200 {common.format(every)} "
            f"region fill {goal}"
        )
    else:
        rate = "nparticles 70 particlerate 4000 insert_every 350"
        lines.append(
            f"fix ins all insert/rate/region seed 32452867 {common.format(rate)} region fill"
        )
    return lines


def motion(draw: random.Random) -> str:
    """Return the words of a motion."""
    axis = "axis 0.1 0.2 1"
    return draw.choice(
        [
            "linear 0.03 0.01 0.02", "wiggle amplitude 0.001 0 0.0008 period 0.02",
            f"rotate origin 0 0 0.01 {axis} period 0.4",
            f"riggle origin 0 0 0.01 {axis} period 0.03 amplitude 4",
            f"viblin {axis} order 2 amplitude 0.0006 0.0003 phase 0.1 0.7 period 0.02 0.011",
            f"vibrot origin 0 0 0 {axis} order 1 amplitude 0.03 phase 0.4 period 0.03",
        ]
    )  # fmt: skip


def walls(draw: random.Random, meshes: Texts, *, periodic: bool) -> list[str]:
    """Return floor and sides, of facets or primitive, with motions and a counter.

    Periodic boxes have no sides, and a floor that ends before their faces.
    """
    words, settings = models(draw)
    wall = f"wall/gran {words}"
    lines: list[str] = []
    moves: list[str] = []
    names: list[str] = []
    if draw.random() < 0.7:
        meshes["floor.stl"] = stl_text(
            plate(0.0, 0.02 if periodic else 0.045, draw.choice([1, 2, 5]))
        )
        stress = draw.choice(["", "/stress"])
        belt = draw.choice(["", "", " surface_vel 0.2 0.1 0"])
        lines.append(f"fix floor all mesh/surface{stress} file floor.stl type 2{belt}")
        names.append("floor")
        if not belt and draw.random() < 0.5:
            moves = [f"fix mv{k} all move/mesh mesh floor {motion(draw)}"
                     for k in range(draw.choice([1, 1, 2]))]  # fmt: skip
    else:
        shear = draw.choice(["", " shear x 0.1"])
        lines.append(f"fix wf all {wall} primitive type 2 zplane 0.0{shear} {settings}")
    side = draw.choice(["pipe", "pipe", "cylinder", "planes", "none"])
    side = "none" if periodic else side
    if side == "pipe":
        sides = draw.choice([8, 16, 32])
        meshes["pipe.stl"] = stl_text(pipe(0.03, 0.08, sides))
        curve = draw.choice(["", " curvature 15 curvature_tolerant yes"])
        lines.append(f"fix pipe all mesh/surface file pipe.stl type 1 move 0 0 -0.005{curve}")
        names.append("pipe")
    elif side == "cylinder":
        shear = draw.choice(["", " shear z 0.2", " shear x 5"])
        lines.append(f"fix wc all {wall} primitive type 1 zcylinder 0.03 0 0{shear} {settings}")
    elif side == "planes":
        for k, face in enumerate(
            ("xplane -0.025", "xplane 0.025", "yplane -0.025", "yplane 0.025")
        ):
            lines.append(f"fix wp{k} all {wall} primitive type 1 {face} {settings}")
    after = draw.random() < 0.5
    mesh = [f"fix wm all {wall} mesh n_meshes {len(names)} meshes {' '.join(names)} {settings}"]
    lines += [] if not names else (mesh + moves if after else moves + mesh)
    if draw.random() < 0.5:
        meshes["gate.stl"] = stl_text(plate(0.015, 0.04, 2))
        count = draw.choice(["once", "multiple"])
        lines += [
            "fix gate all mesh/surface file gate.stl type 1",
            f"fix flow all massflow/mesh mesh gate count {count} vec_side 0 0 -1 file flow.txt",
        ]
    return lines


def script(seed: int, *, further: bool = False, between: bool = False) -> tuple[str, Texts]:
    """Return the script of a seed and the texts of its meshes by file name.

    With `further` contact models are rare ones, with `between` things change between the runs.
    """
    draw = random.Random(seed)
    boundary, half = box_of(seed) if between else ("f f f", 0.08)
    chosen = random.Random(seed) if further else random.Random(seed % PAIR_MODELS)
    words, settings = (further_models if further else models)(chosen)
    meshes: Texts = {}
    runs = draw.choice([[STEPS], [STEPS // 2, STEPS // 2], [1, 1500, STEPS - 1501]])
    every = STEPS // FRAMES
    factor = draw.choice(["", " contact_distance_factor 1.01"])
    lines = [
        "atom_style granular", "atom_modify map array", f"boundary {boundary}",
        "newton off", "communicate single vel yes", "units si",
        f"region reg block -{half} {half} -{half} {half} -0.03 0.12 units box", "create_box 2 reg",
        f"neighbor {draw.choice([0.0005, 0.001, 0.003])} bin", f"neigh_modify delay 0{factor}",
        *material(draw), *(further_materials(seed) if further else ()),
        f"pair_style gran {words} {settings}", "pair_coeff * *",
        f"timestep {draw.choice([5e-6, 1e-5])}", "fix g all gravity 9.81 vector 0 0 -1",
        *filling(draw), *walls(draw, meshes, periodic=half < 0.05), "fix integr all nve/sphere",
        "thermo_style custom step atoms ke", f"thermo {every}",
        "thermo_modify lost ignore norm no format float %.15g",
        f"dump traj all custom {every} traj.dump {COLUMNS}",
        'dump_modify traj format "%d %d ' + " ".join(["%.17g"] * 17) + '"',
    ]  # fmt: skip
    if between:
        lines += between_runs(random.Random(f"between {seed}"), lines, STEPS, every)
    else:
        lines += [f"run {n}" for n in runs]
    return "\n".join([*lines, ""]), meshes


def differences(mine: Path, theirs: Path) -> list[float]:
    """Return the largest difference of every frame; infinite if the particles are not the same."""
    a, b = engine_cases.read(mine).frames, engine_cases.read(theirs).frames
    found = []
    for step, wanted in b.items():
        rows = a.get(step)
        if rows is None or rows.shape != wanted.shape or (rows[:, :2] != wanted[:, :2]).any():
            found.append(math.inf)
            continue
        worst = 0.0
        for columns in (slice(2, 5), slice(5, 8), slice(8, 11), slice(11, 14)):
            size = np.abs(wanted[:, columns]).max(initial=0.0) + 1e-300
            error = np.abs(rows[:, columns] - wanted[:, columns]).max(initial=0.0)
            worst = max(worst, (error - ABSOLUTE) / size)
        found.append(worst)
    return found


def compare(seed: int, folder: Path, *, further: bool = False, between: bool = False) -> str:
    """Run the script of a seed on both engines; return a line with the verdict."""
    text, meshes = script(seed, further=further, between=between)
    if refused := run_both(folder, text, meshes):
        return refused
    found = differences(folder / MINIDEM, folder / LIGGGHTS)
    pairs = pairwise(found)
    jump = any(
        new > SMALL and (new > JUMP * max(old, 1e-16) or math.isinf(new)) for old, new in pairs
    )
    flow = [folder / engine / "flow.txt" for engine in (MINIDEM, LIGGGHTS)]
    rows = [sorted(path.read_text().splitlines()) if path.exists() else [] for path in flow]
    verdict = "same" if max(found, default=0.0) < SMALL else "JUMP" if jump else "grows"
    if verdict == "same" and rows[0] != rows[1]:
        verdict = "FLOW DIFFERS"
    shown = " ".join(f"{value:.0e}" for value in found[1::4])
    return f"{verdict}: {shown}"


def main() -> None:
    """Compare a range of seeds."""
    parser = seeds(__doc__)
    parser.add_argument("--further", action="store_true", help="contact models that are rare")
    parser.add_argument("--between", action="store_true", help="changes between the runs")
    args = parser.parse_args()
    each_seed(args, partial(compare, further=args.further, between=args.between))


if __name__ == "__main__":
    main()
