"""Particles and boxes that go where the script says: move, deform, change_box, replicate."""

from __future__ import annotations

from tests.minidem.engine.case_list import FLOOR, PACK, RATE, WEIGHT, ball
from tests.minidem.engine.cases import Case

FOUR = (
    ball(1, "0 0 0.00499", "0.1 0.05 0", "3 2 1")
    + ball(2, "0.0098 0.001 0.005", "-0.1 0 0", "0 20 0")
    + ball(3, "0.005 0.008 0.0125", "0 0 -0.2")
    + ball(4, "0.02 -0.03 0.0039", diameter=0.008)
)
GROUPS = "group carried id 1 4\ngroup free subtract all carried\n"
FREE = "fix integr free nve/sphere"
WAVES = """
variable sx equal 0.002*sin(step*dt*200)
variable wx equal 0.4*cos(step*dt*200)
variable sy atom 0.0003*id*step*dt
variable wy atom 0.01*id
"""
ROW = "\n".join(
    ball(k + 1, f"{-0.095 + 0.0099 * k} {0.001 * (k % 3)} {0.0005 * k}", f"{0.1 * (k % 4)} 0 0.2")
    for k in range(20)
)


def carried(motion: str, **more: object) -> Case:
    """Return a case in which two of four particles are carried."""
    body = WEIGHT + WAVES + FOUR + FLOOR + GROUPS + f"fix mv carried move {motion}\n"
    return Case(body, integrator=FREE, **more)  # type: ignore[arg-type]


def kicked(motion: str) -> Case:
    """Return a case in which all particles are integrated, also those that are carried."""
    return Case(WEIGHT + WAVES + FOUR + FLOOR + GROUPS + f"fix mv carried move {motion}\n")


def deformed(words: str, boundary: str = "p p p", runs: str = "") -> Case:
    """Return a case in which the box changes."""
    return Case(
        "variable dl equal 0.03*sin(step*dt*100)\nvariable dr equal 3*cos(step*dt*100)\n" + ROW
        + f"fix def all deform {words}\n", boundary=boundary, thermo="atoms ke vol lx ly lz",
        runs=runs, steps=1000,
    )  # fmt: skip


def changed(words: str, boundary: str = "p p f", before: str = "") -> Case:
    """Return a case with a box that is changed between two runs."""
    return Case(
        ROW + before, boundary=boundary, thermo="atoms ke vol xlo xhi ylo yhi zlo zhi",
        runs=f"run 300\nchange_box {words}\nrun 300\n", steps=300,
    )  # fmt: skip


def copied(words: str) -> Case:
    """Return a case in which a bed that has been run is copied, with a value of each particle."""
    own = (
        "fix own all store/state 0 x\nfix mean all ave/atom 10 15 150 z\n"
        "fix back some spring/self 0.01\nfix mv last move linear 0.05 NULL NULL\n"
        "compute sum all reduce sum f_own f_mean\n"
    )
    return Case(
        ROW + "\ngroup some id 3 4\ngroup last id 20\n" + own, boundary="p p f",
        thermo="atoms ke c_sum[1] c_sum[2] xlo xhi ylo yhi zlo zhi",
        runs=f"run 300\n{words}\nvelocity some set 0 0 1\nrun 300\n", steps=300,
    )  # fmt: skip


def joined(fix: str) -> Case:
    """Return a case in which particles come into a group behind what knows where they were."""
    body = (
        WEIGHT
        + FOUR
        + "group some id 1 4\ngroup last id 3\ngroup rest id 2\n"
        + fix
        + "fix integr rest nve/sphere\nfix own some store/state 0 x\n"
        "compute far some displace/atom\ncompute wide some msd com yes\n"
        "compute sum all reduce sum c_far[1] c_far[4] f_own\n"
    )
    return Case(
        body, integrator="", thermo="atoms ke c_sum[1] c_sum[2] c_sum[3] c_wide[1] c_wide[4]",
        runs="run 100\ngroup some id 2\ngroup last id 4\nrun 100\n", steps=100,
    )  # fmt: skip


CASES: dict[str, Case] = {
    "move linear": carried("linear 0.05 -0.02 0.03"),
    "move linear with NULL": carried("linear 0.05 NULL NULL"),
    "move wiggle": carried("wiggle 0.001 NULL 0.0005 0.01"),
    "move rotate": carried("rotate 0.01 0.02 0.0 0.2 -0.3 1 0.05"),
    "move variable": carried("variable v_sx v_sy NULL v_wx NULL v_wx"),
    "move variable, velocities only": carried("variable NULL NULL v_sx NULL v_wy NULL"),
    "move in two runs across a periodic face": carried(
        "linear 2.5 NULL 0.0", boundary="p p f", runs="run 3000\nrun 3000\n", steps=3000
    ),
    "move wiggle in lattice units": Case(
        "lattice sc 0.01\n" + WEIGHT + FOUR + FLOOR + GROUPS
        + "fix mv carried move wiggle 0.1 0.2 NULL 0.01 units lattice\n", integrator=FREE,
    ),
    "move, particles that come later": Case(
        PACK + "group carried id 1000\n" + RATE.replace("fix ins all", "fix ins carried")
        + "fix mv carried move linear 0.1 NULL -0.2\n",
        integrator="", steps=600,
    ),
    "move nowhere and nve/sphere": kicked("linear 0 0 0"),
    "move linear with NULL and nve/sphere": kicked("linear 0.05 NULL NULL"),
    "move rotate and nve/sphere": kicked("rotate 0.01 0.02 0.0 0.2 -0.3 1 0.05"),
    "deform vel and erate": deformed("1 x vel -0.5 y erate 0.3"),
    "deform final in two runs, every 3 steps": deformed(
        "3 x final -0.08 0.09 z delta 0.002 -0.003", runs="run 500\nrun 500\n"
    ),
    "deform trate, wiggle and scale": deformed("2 x trate -2.0 y wiggle 0.02 0.01 z scale 0.9"),
    "deform variable and volume": deformed("1 x variable v_dl v_dr y volume z volume"),
    "deform volume from one": deformed("1 x vel 1.0 y volume remap none"),
    "deform volume from two, fixed faces": deformed("1 x vel -1.0 y scale 1.1 z volume", "p f f"),
    "change_box": changed("all x final -0.095 0.12 y scale 1.2 z delta -0.01 0.02 remap"),
    "change_box with volume and other boundaries": changed(
        "all x scale 1.1 y volume z volume boundary p f f remap"
    ),
    "change_box that loses particles": changed("all x final -0.05 0.04 boundary f p f units box"),
    "change_box of a wrapped box": changed(
        "g2 z delta 0 0.01 set x scale 0.95 remap units lattice", "p p s",
        "group g2 id 3 4 5 6 7 8\nlattice sc 0.5\n",
    ),
    "replicate": copied("replicate 2 1 3 offset 0.2 0.2 0.3 shift 0.01 0 -0.02"),
    "replicate, nearer than the box is long": copied("replicate 1 2 1 offset 9 0.03 9 shift 0 0 0"),
    "spring/self of particles that join": joined("fix back some spring/self 0.3\n"),
    "move of particles that join": joined("fix mv last move linear 0.05 0 0.1\n"),
    "move wiggle and reset_timestep": carried(
        "wiggle 0.001 NULL 0.0005 0.01", runs="run 87\nreset_timestep 0\nrun 100\n", steps=100
    ),
    "region that moves by time, and another timestep": Case(
        "variable way equal 8*step*dt\n" + FOUR
        + "region r block -0.02 0.012 INF INF INF INF units box move v_way NULL NULL\n"
        "fix push all addforce 0.02 0 0 region r\n",
        runs="run 100\ntimestep 4e-5\nrun 100\n", steps=100,
    ),
    "time that is set back": Case(
        FOUR, thermo="time", steps=50,
        runs="run 100\ntimestep 2e-5\nrun 50\nreset_timestep 0\nrun 60\ntimestep 5e-6\n"
        "reset_timestep 500\nrun 50\ntimestep 4e-5\nreset_timestep 100\nrun 70\n",
    ),
    "run_time": Case(FOUR + WEIGHT + FLOOR, runs="run_time 0.00301\nrun_time 0.008 upto\n"),
}  # fmt: skip
"""Cases by name."""
