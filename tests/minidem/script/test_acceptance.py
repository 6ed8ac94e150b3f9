"""Scripts that LIGGGHTS 3.8.0 refuses are refused, and its scripts are not."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from minidem import DemError, run_script
from tests.minidem.interpreted import run_interpreted

PAIR = "pair_style gran model hertz tangential history"
WALL = "fix w all wall/gran model hertz tangential history primitive type 1 zplane 0.045"
SCRIPT = f"""atom_style granular
atom_modify map array sort 0 0
boundary f f f
newton off
communicate single vel yes
units si
region reg block 0 0.1 0 0.1 0 0.1 units box
create_box 1 reg
neighbor 0.002 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype 5e6
fix m2 all property/global poissonsRatio peratomtype 0.3
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.5
fix m4 all property/global coefficientFriction peratomtypepair 1 0.5
fix m5 all property/global coefficientRollingFriction peratomtypepair 1 0.1
fix m6 all property/global cohesionEnergyDensity peratomtypepair 1 1000
{PAIR}
pair_coeff * *
timestep 1e-4
create_atoms 1 single 0.05 0.05 0.05
create_atoms 1 single 0.05 0.0539 0.05
set group all diameter 0.004 density 2500
fix i all nve/sphere
{WALL}
run 3
"""
POUR = """fix p all particletemplate/sphere 15485863 atom_type 1 density constant 2500 &
  radius constant 0.001
fix d all particledistribution/discrete 15485867 1 p 1.0
region bc block 0.01 0.09 0.01 0.09 0.06 0.09 units box
fix ins all insert/pack seed {seed} distributiontemplate d insert_every once overlapcheck yes &
  all_in yes vel constant 0 0 -1 {target} region bc
"""


def after(lines: str) -> str:
    """Return the script with lines before the run."""
    return SCRIPT.replace("run 3\n", lines + "\nrun 3\n")


def instead(old: str, new: str) -> str:
    """Return the script with a line changed."""
    assert old in SCRIPT
    return SCRIPT.replace(old, new)


def two_types(used: int) -> str:
    """Return the script with two types, of which particles and walls have one only."""
    words = SCRIPT
    for name in ("5e6", "0.3"):
        words = words.replace(f"peratomtype {name}", f"peratomtype {name} {name}")
    for value in ("0.5", "0.1", "1000"):
        words = words.replace(f"pair 1 {value}", f"pair 2 {value} {value} {value} {value}")
    words = words.replace("create_box 1", "create_box 2").replace(
        "type 1 zplane", f"type {used} zplane"
    )
    return words.replace("create_atoms 1", f"create_atoms {used}")


def to_come(lines: str) -> str:
    """Return the script with lines behind a run that inserts its only particles."""
    pour = POUR.format(seed=86028157, target="particles_in_region 5")
    return instead("run 3\n", f"delete_atoms group all\n{pour}run 2\n{lines}\nrun 1\n")


def walls_with(setting: str, model: str = "") -> str:
    return instead(
        WALL, WALL.replace("history primitive", f"history{model} primitive") + " " + setting
    )


HOOKE = instead(
    PAIR,
    "fix v all property/global characteristicVelocity scalar 1\n" + PAIR.replace("hertz", "hooke"),
)
HYBRID = instead(PAIR, PAIR.replace("gran", "hybrid/overlay gran")).replace("* *", "* * gran")
ACCEPTED = {
    "as it is": SCRIPT,
    "vector and matrix": SCRIPT.replace("peratomtypepair", "matrix").replace(
        "peratomtype", "vector"
    ),
    "mol yes": after("group one id 1\ndelete_atoms group one mol yes"),
    "hertz limitForce": instead(PAIR, PAIR + " limitForce on"),
    "cohesion tangential_reduce": instead(PAIR, PAIR + " cohesion sjkr tangential_reduce on"),
    "delay 4 every 2": after("neigh_modify delay 4 every 2"),
    "delay 0 every 3": after("neigh_modify delay 0 every 3"),
    "type 2 unused": two_types(1),
    "create_atoms units box": instead("0.05 0.05 0.05", "0.05 0.05 0.05 units box"),
    "velocity units box": after("velocity all set 0 0 0 units box"),
    "fix_modify energy": after("fix_modify w energy yes"),
    "restart without star": after("restart 2 a"),
    "check/timestep warns": after("fix c all check/timestep/gran 1 0.1 0.1"),
    "group initialize": after("group g initialize"),
    "run 0": after("run 0"),
    "names of properties without per": SCRIPT.replace("peratomtype", "atomtype"),
    "velocity zero of particles to come": to_come(
        "velocity all zero linear\nvelocity all zero angular"
    ),
    "one law in pair_style hybrid": HYBRID,
    "atom_style hybrid": instead("atom_style granular", "atom_style hybrid granular atomic"),
    "momentum of particles to come": to_come("fix q all momentum 1 linear 1 1 1"),
}
RARE = ("hertz limitForce", "cohesion tangential_reduce")
"""Models that are not worth half a minute of compiling for three steps."""
REFUSED = {
    "hertz ktToKnUser": (
        instead(PAIR, PAIR + " ktToKnUser on"),
        "'ktToKnUser' is a setting of 'model hooke or hooke/hysteresis'",
    ),
    "hertz ktToKnUser off": (instead(PAIR, PAIR + " ktToKnUser off"), "'ktToKnUser' is a setting"),
    "torsionTorque without rolling": (
        instead(PAIR, PAIR + " torsionTorque on"),
        "'rolling_friction cdt or",
    ),
    "reduce without cohesion": (
        instead(PAIR, PAIR + " tangential_reduce on"),
        "'cohesion sjkr or sjkr2 or easo",
    ),
    "wall ktToKnUser": (walls_with("ktToKnUser on"), "setting of 'model hooke or hooke/hyst"),
    "wall torsionTorque": (walls_with("torsionTorque on", " cohesion sjkr"), "rolling_friction"),
    "wall tangential_reduce": (
        walls_with("tangential_reduce on", " rolling_friction cdt"),
        "cohesion",
    ),
    "hooke torsionTorque": (
        HOOKE.replace("hooke tangential history", "hooke tangential history torsionTorque on"),
        "rolling_friction",
    ),
    "delay no multiple": (
        after("neigh_modify delay 5 every 2"),
        "Neighbor delay must be 0 or multiple",
    ),
    "velocity zero of no particles": (
        after("delete_atoms group all\nvelocity all zero linear"),
        "Cannot zero momentum of no atoms",
    ),
    "every 0": (after("neigh_modify every 0"), "interval 0 is not positive"),
    "delay -1": (after("neigh_modify delay -1"), "interval -1 is negative"),
    "page": (after("neigh_modify page 10"), "Neighbor page size must be >= 10x"),
    "cluster": (after("neigh_modify cluster yes"), "deprecated"),
    "no type 1": (two_types(2), "Atom types must start from 1"),
    "nothing at all": (
        "\n".join(
            line
            for line in SCRIPT.splitlines()
            if not line.startswith(("create_atoms", "set", "fix w"))
        )
        + "\n",
        "Atom types must start from 1",
    ),
    "two freezes": (after("fix f all freeze\nfix f2 all freeze"), "More than one fix freeze"),
    "freeze 1": (after("fix f all freeze 1"), "fix freeze: unexpected word '1'"),
    "nve/sphere 3": (after("fix n all nve/sphere 3"), "fix nve/sphere: unexpected word '3'"),
    "timestep of two words": (after("timestep 1e-4 2"), "timestep: unexpected word '2'"),
    "atom_style granular 3": (
        instead("atom_style granular", "atom_style granular 3"),
        "unexpected word",
    ),
    "thermo -5": (after("thermo -5"), "interval -5 is negative"),
    "thermo_modify alone": (after("thermo_modify"), "too few words"),
    "thermo_modify every": (
        after("thermo_modify every 2"),
        "unknown thermo_modify keyword 'every'",
    ),
    "check/timestep error": (
        after("fix c all check/timestep/gran 1 0.1 0.1 error yes"),
        "% of rayleigh time",
    ),
    "run -1": (after("run -1"), "run: -1 steps"),
    "run 2**31": (after("run 2147483648"), "expected 0 to 2147483647"),
    "run every 0": (after("run 4 every 0 NULL"), "interval 0 is not positive"),
    "region again": (after("region reg block 0 1 0 1 0 1 units box"), "Reuse of region ID 'reg'"),
    "group clear": (after("group g type 1\ngroup g clear"), "write 'group ID delete'"),
    "group subtract one": (after("group g subtract all"), "at least 2 groups"),
    "mass below zero": (after("set atom 1 mass -1"), "Invalid mass"),
    "diameter 0": (after("set group all diameter 0"), "Atom radius must be bigger than zero"),
    "reset_timestep -1": (after("reset_timestep -1"), "is negative"),
    "property/atom bogus": (
        after("compute c all property/atom bogus"),
        "unknown particle property 'bogus'",
    ),
    "fix_modify bogus": (after("fix_modify w bogus 1"), "unknown fix_modify keyword 'bogus'"),
    "pair_coeff 1": (after("pair_coeff * * 1"), "pair_coeff"),
    "modulus of pairs": (instead("peratomtype 5e6", "atomtypepair 1 5e6"), "peratomtype style req"),
    "restitution of types": (
        instead("peratomtypepair 1 0.5\nfix m4", "peratomtype 0.5\nfix m4"),
        "peratomtypepair style required for fix property/global variable coefficientRestitution",
    ),
    "velocity of types": (HOOKE.replace("scalar 1", "vector 1"), "scalar style required"),
    "hybrid pair_coeff": (HYBRID.replace("* * gran", "* *"), "pair_coeff * * gran"),
    "hybrid none": (HYBRID.replace("* * gran", "* * none"), "unknown pair_coeff style 'none'"),
    "hybrid twice": (
        instead("atom_style granular", "atom_style hybrid sphere sphere"),
        "cannot use same atom style twice",
    ),
    "hybrid of points": (instead("style granular", "style hybrid atomic"), "neither sphere nor"),
    "units behind the box": (after("units si"), "units command after simulation box"),
    "boundary behind the box": (after("boundary f f f"), "boundary command after simulation box"),
    "seeds of template and mixture": (
        after(
            POUR.replace("15485867", "15485863").format(
                seed=32452843, target="particles_in_region 5"
            )
        ),
        "must differ",
    ),
    "seeds of insertion and template": (
        after(POUR.format(seed=15485863, target="particles_in_region 5")),
        "must differ",
    ),
    "volume fraction 2": (
        after(POUR.format(seed=32452843, target="volumefraction_region 2")),
        "above one",
    ),
}
ONLY_HERE = {
    "no model": (instead(PAIR, "pair_style gran tangential history"), "pass through each other"),
    "two laws": (
        instead(PAIR, "pair_style hybrid/overlay gran model hertz gran model hertz").replace(
            "pair_coeff * *", "pair_coeff * * gran 1\npair_coeff * * gran 2"
        ),
        "a second contact law of the same particles",
    ),
    "molecules": (instead("style granular", "style hybrid granular molecular"), "'molecular' is"),
    "freeze between walls": (
        after("fix f all freeze\n" + WALL.replace("fix w ", "fix w2 ")),
        "stands between two fix wall/gran",
    ),
    "setforce between walls": (
        after("fix f all setforce 0 0 NULL\n" + WALL.replace("fix w ", "fix w2 ")),
        "stands between two fix wall/gran",
    ),
    "timestep 0": (instead("timestep 1e-4", "timestep 0"), "above zero"),
    "timestep below zero": (instead("timestep 1e-4", "timestep -1e-4"), "above zero"),
    "run x": (after("run x"), "expected a whole number"),
    "run 1e1": (after("run 1e1"), "expected a whole number"),
}
"""What LIGGGHTS takes and minidem refuses: nobody means it, or minidem cannot do it."""


def run(folder: Path, script: str) -> None:
    (folder / "in.s").write_text(script)
    run_script(folder / "in.s", root=folder)


@pytest.mark.parametrize("name", ACCEPTED)
def test_what_liggghts_takes_runs(tmp_path, name):
    if name in RARE:
        (tmp_path / "in.s").write_text(ACCEPTED[name])
        run_interpreted(tmp_path / "in.s")
    else:
        run(tmp_path, ACCEPTED[name])


@pytest.mark.parametrize("name", [*REFUSED, *ONLY_HERE])
def test_what_liggghts_refuses_is_refused_with_the_reason(tmp_path, name):
    script, reason = (REFUSED | ONLY_HERE)[name]
    with pytest.raises(DemError) as caught:
        run(tmp_path, script)
    assert reason in str(caught.value)


@pytest.mark.liggghts
@pytest.mark.parametrize("name", [*ACCEPTED, *REFUSED, *ONLY_HERE])
def test_liggghts_says_the_same(tmp_path, name):
    script = ACCEPTED[name] if name in ACCEPTED else (REFUSED | ONLY_HERE)[name][0]
    (tmp_path / "in.s").write_text(script)
    program = shutil.which("liggghts")
    assert program
    done = subprocess.run(
        [program, "-in", "in.s"], cwd=tmp_path, capture_output=True, text=True,
        errors="replace", check=False,
    )  # fmt: skip
    assert (done.returncode == 0) == (name not in REFUSED), done.stdout[-500:]
