"""Sieves that let particles pass by chance."""

from __future__ import annotations

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


CASES: dict[str, Case] = {
    "sieve": sieved("sieveDamping 0.05"),
    "sieve that moves": sieved(
        "sieveDamping 0.01 sieveMultiSphereCanPass",
        "fix mv all move/mesh mesh cad linear 0.01 0.0 -0.02\n",
    ),
}
"""Cases by name."""
