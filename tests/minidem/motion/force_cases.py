"""Forces besides contacts: springs, drag to a point, regions that repel."""

from __future__ import annotations

from tests.minidem.engine.case_list import FLOOR, PACK, RATE, THREE, WEIGHT, ball
from tests.minidem.engine.cases import Case
from tests.minidem.motion.region_cases import PARTS

SPRING = "atoms ke f_s f_s[1] f_s[2] f_s[3] f_s[4]"
DRAGGED = "atoms ke f_s[1] f_s[2] f_s[3]"
WALL = "atoms ke f_s f_s[1] f_s[2] f_s[3]"
INSIDE = (
    ball(1, "0 0 0.05", "0.5 0.1 0.3", "3 2 1")
    + ball(2, "0.0098 0.01 0.06", "-0.2 0 -1", "0 20 0")
    + ball(3, "0.02 0.02 0.07", "2 1 -3", diameter=0.008)
)
OUTSIDE = INSIDE.replace("0 0 0.05", "0 0 0.15").replace("0.01 0.06", "0.08 0.06")
MORE = (
    "region s2 sphere 0.05 0 0.08 0.05\nregion s3 sphere 0.0 0.04 0.08 0.02 side out\n"
    "region s4 sphere 0 0.01 0.06 0.06\n"
)
SWING = "variable sx equal 0.003*sin(step*dt*100)\nvariable an equal 3*step*dt\n"


def walled(region: str, words: str, balls: str = INSIDE) -> Case:
    """Return a case in which a region repels."""
    lines = PARTS + MORE + SWING + f"region r {region}\n" + balls
    return Case(lines + f"fix s all wall/region r {words}", steps=3000, thermo=WALL)


STRESS = """compute st all stress/atom pair
compute r all reduce sum c_st[1] c_st[3] c_st[5]
compute p all pressure thermo_temp virial
"""
SEEN = "atoms c_r[1] c_r[2] c_r[3] c_p c_p[3]"
LIMITED = "fix integr all nve/limit radius_ratio 0.0002"


def stressed(lines: str, boundary: str = "f f f", integrator: str = Case.integrator) -> Case:
    """Return a case whose contacts move on after their forces, and whose stress is output."""
    contacts = ball(1, "0 0 0.05") + ball(2, "0.0005 0 0.0599", "0.1 0 -0.2", "0 30 0")
    contacts += ball(3, "-0.006 0.007 0.053") + ball(4, "0.004 -0.008 0.052")
    return Case(
        contacts + STRESS + lines, steps=60, thermo=SEEN, boundary=boundary, integrator=integrator,
    )  # fmt: skip


CASES: dict[str, Case] = {
    "spring tether": Case(
        WEIGHT + THREE + FLOOR + "fix s all spring tether 20 0.01 NULL 0.05 0.01\n", thermo=SPRING,
    ),
    "spring tether across a periodic face": Case(
        THREE + "group g2 id 2 3\nfix s g2 spring tether 5 -0.09 0.05 NULL 0.0\n", thermo=SPRING,
        boundary="p p f", steps=4000,
    ),
    "spring couple": Case(
        WEIGHT + THREE + FLOOR + "group g1 id 1\ngroup g2 id 2 3\n"
        "fix s g1 spring couple g2 10 0.01 0.0 NULL 0.02\n", thermo=SPRING,
    ),
    "spring/self": Case(
        WEIGHT + THREE + FLOOR + "fix s all spring/self 3.0 xz\n", thermo="atoms ke f_s",
    ),
    "spring/self of a group in a periodic box, two runs": Case(
        THREE + "group g2 id 2 3\nfix s g2 spring/self 0.5\n", thermo="atoms ke f_s",
        boundary="p p f", steps=2000, runs="run 1000\nrun 1000\n",
    ),
    "drag": Case(
        WEIGHT + THREE + FLOOR + "fix s all drag 0.01 0.02 NULL 0.02 0.015\n", thermo=DRAGGED,
    ),
    "drag in a periodic box": Case(
        THREE + "fix s all drag -0.09 0.095 0.0 0.02 0.0\n", thermo=DRAGGED, boundary="p p f",
    ),
    "stress beside momentum": stressed("fix m all momentum 1 linear 1 1 1 angular\n"),
    "stress beside nve/limit": stressed(
        "set atom 1 vz 0.1\nfix a all addforce 0 0 -5\n", integrator=LIMITED
    ),
    "stress beside deform": stressed("fix d all deform 1 z erate -20\n", "p p p"),
    "spring/self of particles that are inserted": Case(
        PACK + WEIGHT + "fix s all spring/self 3.0\n" + RATE, thermo="atoms ke f_s", steps=600,
    ),
    "store/force between forces": Case(
        WEIGHT + THREE + FLOOR + "group g2 id 1 2\nfix a all addforce 0.001 0 0\n"
        "fix s g2 store/force\nfix b all addforce 0 0.5 0\n"
        "variable q atom f_s[1]*0.3-f_s[3]\nfix c all addforce v_q 0 0\n",
    ),
    "wall/region harmonic in a block": walled(
        "block -0.02 0.04 -0.03 0.03 0.02 0.09", "harmonic 500 1 0.006"
    ),
    "wall/region lj93 in a cone": walled("cone z 0 0 0.02 0.08 0.01 0.12", "lj93 1e-4 0.004 0.01"),
    "wall/region lj126 in a prism": walled(
        "prism -0.03 0.03 -0.05 0.04 0.01 0.12 0.02 -0.01 0.03", "lj126 1e-4 0.004 0.01"
    ),
    "wall/region colloid in a sphere": walled(
        "sphere 0 0.01 0.06 0.05", "colloid 1e-2 0.004 0.02",
        INSIDE.replace("vx 2 vy 1 vz -3", "vx 0.2 vy 0.1 vz -0.3"),
    ),
    "wall/region in a wedge": walled(
        "wedge axis z center -0.03 -0.01 radius 0.08 bounds 0.01 0.1 angle0 -30 angle 120",
        "harmonic 500 1 0.006",
    ),
    "wall/region outside of a block": walled(
        "block -0.02 0.04 -0.03 0.03 0.02 0.09 side out", "harmonic 500 1 0.006",
        OUTSIDE.replace("0.02 0.02 0.07", "0.02 0.06 0.07").replace("vy 1", "vy -2"),
    ),
    "wall/region outside of a cone": walled(
        "cone z 0 0.0 0.06 0.02 0.01 0.12 side out", "harmonic 500 1 0.006",
        OUTSIDE.replace("0.02 0.02 0.07", "0.08 0.02 0.07").replace("vx 2", "vx -3"),
    ),
    "wall/region in a union": walled("union 2 c1 s2", "harmonic 500 1 0.006"),
    "wall/region in an intersection": walled("intersect 2 s4 s3", "harmonic 500 1 0.006"),
    "wall/region plane": walled("plane 0 0 0.04 0.3 0.1 1", "harmonic 500 1 0.006"),
    "wall/region that turns and moves": walled(
        "block -0.02 0.04 -0.03 0.03 0.02 0.09 rotate v_an 0.01 0 0.05 1 2 3 move v_sx NULL v_sx",
        "harmonic 500 1 0.006",
    ),
}  # fmt: skip
"""Cases by name."""
