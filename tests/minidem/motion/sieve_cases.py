"""Sieves that let particles pass by chance, and counters that know the outlet by a point."""

from __future__ import annotations

from math import cos, pi, sin

from tests.minidem.engine.case_list import FLOOR, WEIGHT, ball
from tests.minidem.engine.cases import Case, plate

# one after the other, so that the order of coins is that of time
RAIN = "".join(
    ball(k + 1, f"{-0.04 + 0.008 * k} {0.004 * (k % 5) - 0.01} {0.032 + 0.0061 * k}",
         f"0.02 {0.01 * k} -0.3", diameter=0.004 + 0.0005 * (k % 4))
    for k in range(11)
)  # fmt: skip
CLOTH = "fix cad all mesh/surface/planar file m.stl type 2\n"
SIEVE = (
    "fix s all massflow/mesh/sieve mesh cad count once vec_side 0 0 -1 sieveSize 0.009 "
    "sieveSpacing 0.008 sieveStiffness 300 "
)
COUNTS = "atoms ke f_s[1] f_s[2]"


def sieved(words: str, lines: str = "", body: str = RAIN) -> Case:
    """Return a case with a horizontal sieve."""
    return Case(
        WEIGHT + body + CLOTH + lines + SIEVE + words + "\n" + FLOOR, steps=6000, thermo=COUNTS,
        meshes={"m.stl": plate(z=0.02, half=0.05, cells=2)},
    )  # fmt: skip


TIP, RIM = (0.0, 0.0, -0.015), 0.05
CORNERS = [(RIM * cos(k * pi / 4), RIM * sin(k * pi / 4), 0.022) for k in range(8)]
CONE = tuple((CORNERS[k], CORNERS[(k + 1) % 8], TIP) for k in range(8))
BELOW = "fix c all massflow/mesh mesh cone count once point_at_outlet 0 0 -0.09 "
COUNTED = "atoms ke f_s[1] f_s[2] f_c[1] f_c[2] f_c[6]"


def through(words: str, body: str = RAIN) -> Case:
    """Return a case with a plane and a cone that count; grains leave through the floor."""
    lines = (
        "fix cad all mesh/surface file m.stl type 2\n"
        "fix cone all mesh/surface file cone.stl type 2\n"
        "fix s all massflow/mesh mesh cad count once point_at_outlet 0 0 0.09 inside_out\n"
    )
    return Case(
        WEIGHT + body + lines + words + "\n", steps=6000, thermo=COUNTED,
        meshes={"m.stl": plate(z=0.02, half=0.05, cells=2), "cone.stl": CONE},
    )  # fmt: skip


CASES: dict[str, Case] = {
    "sieve": sieved("sieveDamping 0.05"),
    "sieve that moves": sieved(
        "sieveDamping 0.01 sieveMultiSphereCanPass",
        "fix mv all move/mesh mesh cad linear 0.01 0.0 -0.02\n",
    ),
    "counters with a point at the outlet": through(BELOW),
    "a counter with a point at the outlet takes out": through(BELOW + "delete_atoms yes"),
    "sum of a property": Case(
        "create_atoms 1 single 0 0 0.002\ncreate_atoms 2 single 0.02 0.005 0.004\n"
        "create_atoms 1 single -0.02 0.005 0.006\nset group all diameter 0.01 density 2500 vz -2\n"
        "fix p all property/atom foo scalar no no no 3.5\n"
        "fix cad all mesh/surface file m.stl type 1\n"
        "fix s all massflow/mesh mesh cad count once vec_side 0 0 -1 sum_property foo\n",
        steps=400, meshes={"m.stl": plate()}, thermo="f_s[1] f_s[2] f_s[7]",
        runs="run 1\nset atom 2 property/atom foo 1.25\nrun 249\nrun 150\n",
    ),
}  # fmt: skip
"""Cases by name."""
