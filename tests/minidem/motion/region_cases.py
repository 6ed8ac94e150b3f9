"""Regions of every style, and what a script does with them."""

from __future__ import annotations

from tests.minidem.engine.case_list import FLOOR, PACK, WEIGHT
from tests.minidem.engine.cases import Case

GRID = (
    "lattice sc 0.011\nregion all_box block -0.09 0.09 -0.09 0.09 0.001 0.15 units box\n"
    "create_atoms 1 region all_box\nset group all diameter 0.01 density 2500\n"
)
MARKS = """
group in_a region a
set group in_a vx 0.5 vz -0.3
delete_atoms region b
set region a omegax 3
"""
INSERT = "fix ins all insert/pack seed 32452867 distributiontemplate pd insert_every 100 "
REGIONS = {
    "cone": (
        "cone z 0.01 -0.02 0.06 0.02 0.01 0.12 units box",
        "cone y 0.02 0.05 0.0 0.05 -0.08 0.03",
    ),
    "cone along x": ("cone x 0.01 0.06 0.02 0.05 EDGE EDGE", "cone x 0.0 0.1 0.04 0 -0.05 0.05"),
    "prism": (
        "prism -0.06 0.03 -0.05 0.04 0.01 0.12 0.02 -0.01 0.03 units box",
        "prism -0.09 -0.05 -0.09 0.09 0.0 0.05 0.01 0 0",
    ),
    "plane": ("plane 0.01 0.02 0.05 0.3 -0.2 1 side out", "plane 0.05 0 0 1 0 0.2"),
    "wedge": (
        "wedge axis z center 0.01 0.0 radius 0.07 bounds 0.0 0.1 angle0 -30 angle 100",
        "wedge axis y center 0.05 0.02 radius 0.06 bounds -0.05 0.05 angle0 40 angle 60",
    ),
    "wide wedge": (
        "wedge axis x center 0.01 0.07 radius 0.07 bounds -0.05 EDGE angle0 -120 angle 200",
        "wedge axis z center 0 0 radius 0.05 bounds INF 0.03 angle0 10 angle 5 units box",
    ),
    "lattice units": ("block -5 3 -4 4 1 8 units lattice", "sphere 2 1 8 3 units lattice"),
    "unions": (
        "union 2 c1 p1\nregion c1b plane 0 0 0.02 0 0 1",
        "intersect 2 c1 s1",
    ),
}
PARTS = """
region c1 cone z 0.01 -0.02 0.06 0.02 0.01 0.12
region p1 prism -0.06 0.03 -0.05 0.04 0.01 0.12 0.02 -0.01 0.03 side out
region s1 sphere 0.0 0.0 0.08 0.05 side out
"""
CORNERS = [
    (0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (1.0, 1.0, 0.0),
    (0.0, 0.0, 1.0), (1.0, 0.0, 1.0), (0.0, 1.0, 1.0), (1.2, 1.1, 1.3),
]  # fmt: skip
TETS = [(0, 1, 2, 4), (1, 3, 2, 7), (1, 2, 4, 7), (2, 6, 4, 7), (1, 4, 5, 7)]


def vtk() -> str:
    """Return a cube of five tetrahedra, one corner pulled out, as a VTK file."""
    points = "\n".join(" ".join(map(str, point)) for point in CORNERS)
    cells = "\n".join("4 " + " ".join(map(str, cell)) for cell in TETS)
    types = "\n".join(["10"] * len(TETS))
    return (
        "# vtk DataFile Version 2.0\na cube\nASCII\nDATASET UNSTRUCTURED_GRID\n"
        f"POINTS {len(CORNERS)} float\n{points}\n\nCELLS {len(TETS)} {5 * len(TETS)}\n{cells}\n\n"
        f"CELL_TYPES {len(TETS)}\n{types}\n"
    )


MESH = "region a mesh/tet file m.vtk scale 0.07 move -0.5 -0.4 0.3 rotate 10 -20 30 units box\n"
FAST = "vel constant 0.1 0.2 -0.5 "


def used(first: str, second: str) -> Case:
    """Return a case in which one region marks particles and another one deletes them."""
    text = f"{PARTS}region a {first}\nregion b {second}\n{GRID}{MARKS}"
    if "lattice" in first:
        text = GRID + text.replace(GRID, "")
    return Case(text + WEIGHT + FLOOR, steps=200)


def filled(region: str, words: str) -> Case:
    """Return a case in which a region is filled."""
    return Case(PARTS + f"region a {region}\n" + PACK + WEIGHT + INSERT + words, steps=400)


CASES: dict[str, Case] = {
    **{f"{name}: group, set, delete_atoms": used(*two) for name, two in REGIONS.items()},
    **{
        f"insert/pack in {name}": filled(
            two[0], FAST + "all_in yes overlapcheck yes particles_in_region 40 region a"
        )
        for name, two in REGIONS.items()
        if name in ("cone", "prism", "wedge")
    },
    "insert/pack beside grains in a cone": filled(
        "cone z 0.01 -0.02 0.06 0.02 0.01 0.12",
        FAST + "all_in no overlapcheck yes volumefraction_region 0.2 region a",
    ),
    "insert/rate/region in a tilted prism": Case(
        "region a prism -0.06 0.03 -0.05 0.04 0.05 0.12 0.02 -0.01 0.03\n" + PACK + WEIGHT
        + "fix ins all insert/rate/region seed 32452867 distributiontemplate pd nparticles 300 "
        "particlerate 60000 insert_every 70 overlapcheck yes all_in no vel constant 5 -4 0.1 "
        "region a", steps=600,
    ),
    "mesh/tet: create_atoms, group and delete_atoms": Case(
        MESH + "region b mesh/tet file m.vtk scale 0.03 move 1 1 1 rotate 0 0 0 side out\n"
        + GRID + "group in_a region a\nset group in_a vx 0.5\ndelete_atoms region b\n"
        "create_atoms 2 region a\nset type 2 diameter 0.008 density 3000\n" + WEIGHT + FLOOR,
        steps=200, files={"m.vtk": vtk()},
    ),
    "mesh/tet that touches the faces of the box": Case(
        "region a mesh/tet file m.vtk scale 0.1 move 0 0 0 rotate 0 0 0\n" + GRID
        + "delete_atoms region a\n" + WEIGHT + FLOOR,
        steps=200, files={"m.vtk": vtk().replace("1.2 1.1 1.3", "1 1 1")},
    ),
    "mesh/tet: insert/pack": Case(
        MESH + PACK + WEIGHT + INSERT.replace("insert_every 100", "insert_every once")
        + FAST + "all_in no overlapcheck yes volumefraction_region 0.1 region a",
        steps=400, files={"m.vtk": vtk()},
    ),
    "mesh/tet: insert/pack, whole spheres": Case(
        MESH + PACK + WEIGHT + INSERT.replace("insert_every 100", "insert_every once")
        + FAST + "all_in yes overlapcheck yes particles_in_region 60 region a",
        steps=400, files={"m.vtk": vtk()},
    ),
    "regions that move, turn and grow": Case(
        "variable sx equal 0.03*sin(step*dt*100)\nvariable an equal 30*step*dt\n"
        "variable ra equal 0.02+3*step*dt\n"
        "region m1 block -0.02 0.05 -0.03 0.03 0 0.2 move v_sx NULL v_sx\n"
        "region m2 prism -0.06 0.03 -0.05 0.04 0.01 0.12 0.02 -0.01 0.03 "
        "rotate v_an 0.01 0 0.02 1 2 3 move NULL v_sx NULL\n"
        "region m3 sphere 0 0 0.05 v_ra side out\nregion m4 cylinder z 0.01 0 v_ra 0 0.2\n"
        "region m5 union 2 m1 m2\nregion m6 intersect 2 m5 m3 side out\n"
        + GRID + WEIGHT + FLOOR + "fix f1 all addforce 0.01 0 0 region m5\n"
        "fix f2 all addforce 0 0.02 0 region m6\nfix f3 all setforce 0 0 NULL region m4\n",
        steps=400, thermo="atoms ke f_f1[1] f_f2[2] f_f3[3]",
    ),
}  # fmt: skip
"""Cases by name."""
