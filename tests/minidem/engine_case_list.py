"""The cases of `engine_cases`, by name."""

from __future__ import annotations

from engine_cases import Case

WEIGHT = "fix g all gravity 9.81 vector 0 0 -1\n"
FLOOR = "fix floor all wall/gran model hertz tangential history primitive type 2 zplane 0.0\n"
DRAG = """
variable c equal 0.002
variable fx atom -v_c*vx*sqrt(vx^2+vy^2+vz^2)
variable fy atom -v_c*vy*sqrt(vx^2+vy^2+vz^2)
variable fz atom -v_c*vz*sqrt(vx^2+vy^2+vz^2)
"""


def ball(number: int, x: str, v: str = "0 0 0", w: str = "0 0 0", diameter: float = 0.01) -> str:
    """Return the lines that make one particle."""
    vx, vy, vz = v.split()
    wx, wy, wz = w.split()
    return (
        f"create_atoms 1 single {x} units box\n"
        f"set atom {number} density 2500 diameter {diameter}\n"
        f"set atom {number} vx {vx} vy {vy} vz {vz} omegax {wx} omegay {wy} omegaz {wz}\n"
    )


THREE = (
    ball(1, "0 0 0.01", "0.5 0.1 0.3", "3 2 1")
    + ball(2, "0.0098 0 0.01", "-0.2 0 -1", "0 20 0")
    + ball(3, "0.03 0.03 0.1", "2 1 -3", diameter=0.008)
)
PILE_OF_TWO = ball(1, "0 0 0.00499") + ball(2, "0.0001 0 0.0148", "-0.2 0 -1", "0 20 0")
UP = "region up block -1 1 -1 1 0.02 1 units box\n"
FORCES = "atoms ke f_a[1] f_a[2] f_a[3]"

CASES: dict[str, Case] = {
    "addforce atom-style: quadratic drag": Case(
        WEIGHT + THREE + DRAG + FLOOR + "fix a all addforce v_fx v_fy v_fz",
        thermo="atoms ke f_a f_a[1] f_a[2] f_a[3]",
    ),
    "addforce on a group, mixed styles": Case(
        WEIGHT + THREE + DRAG + FLOOR + "group g2 id 2 3\nfix a g2 addforce v_fx 0.001 v_fz",
        thermo=FORCES,
    ),
    "addforce in a region": Case(
        WEIGHT + THREE + DRAG + FLOOR + UP + "fix a all addforce v_fx 0.01 v_fz region up",
        thermo="atoms ke f_a[2]",
    ),
    "addforce constant, energy in a periodic box": Case(
        WEIGHT + THREE + FLOOR + "fix a all addforce 0.01 0 0.002", boundary="p p f",
        thermo="atoms ke f_a f_g",
    ),
    "addforce with an energy variable": Case(
        WEIGHT + THREE + FLOOR + "variable t equal 0.01*sin(step*dt*300)\n"
        "variable q atom 0.001*id*v_t\nfix a all addforce v_t v_q 0 energy v_q",
        thermo="atoms ke f_a f_a[1] f_a[2] f_a[3]",
    ),
    "variables see the forces of earlier fixes": Case(
        THREE + "variable q atom 0.5*fx-0.01*fz\nfix a all addforce v_q 0.0 v_q\n" + WEIGHT
        + "fix b all addforce v_q 0.0 v_q", steps=1000,
    ),
    "setforce atom-style with NULL": Case(
        WEIGHT + THREE + DRAG + FLOOR + "fix a all setforce v_fx NULL v_fz", thermo=FORCES
    ),
    "setforce in a region": Case(
        WEIGHT + THREE + FLOOR + UP + "fix a all setforce 0.001 NULL 0.0 region up", thermo=FORCES
    ),
    "setforce before a wall spares the wall force": Case(
        WEIGHT + THREE + "fix a all setforce 0.0 NULL -0.01\n" + FLOOR, thermo=FORCES
    ),
    "setforce with variables before and after a wall": Case(
        WEIGHT + THREE + DRAG + "fix a all setforce 0.0 NULL v_fz\n" + FLOOR
        + "fix b all setforce NULL v_fy NULL", thermo=FORCES,
    ),
    "freeze: forces on the frozen": Case(
        WEIGHT + PILE_OF_TWO + "group low id 1\nfix a low freeze", thermo=FORCES
    ),
    "freeze before a wall": Case(PILE_OF_TWO + "group low id 1\nfix a low freeze\n" + FLOOR),
    "viscous with a ratio per type": Case(
        WEIGHT + THREE + "set atom 2 type 2\n" + FLOOR + "fix a all viscous 0.02 scale 2 3.0"
    ),
}  # fmt: skip
