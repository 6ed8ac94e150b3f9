"""The cases of `engine_cases`, by name."""

from __future__ import annotations

import math

from tests.minidem.engine.cases import Case, Triangle, pipe, plate

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
GROW = "compute rad all property/atom radius\nvariable d atom 1.002*2.*c_rad\n"
ON_PLATE = (
    ball(1, "0.01 0.012 0.00499", "0.1 0.05 0", "3 2 1")
    + ball(2, "0 -0.01 0.00495", "-0.1 0 0", "0 20 0")
    + ball(3, "-0.03 0.02 0.00499")
    + ball(4, "0.02 -0.03 0.0039", diameter=0.008)
)
SPEEDS = """
variable vx equal 0.03*cos(step*dt*200)
variable vy equal 0.01
variable vz equal -0.02*sin(step*dt*300)
variable om equal 0.5*sin(step*dt*100)+0.2
"""
PLATE = {"m.stl": plate(half=0.08, cells=2)}
MESH = "fix cad all mesh/surface file m.stl type 2\n"
STRESSED = SPEEDS + MESH.replace("surface", "surface/stress").replace(
    "type 2", "type 2 reference_point 0.01 0.02 0.03"
)
GROUPS = "group a id 1 2\ngroup b id 3\n"
WALL = "fix w all wall/gran model hertz tangential history mesh n_meshes 1 meshes cad\n"
BELTS = (
    "surface_vel 0.3 -0.2 0.1", "surface_ang_vel origin 0.01 0.02 0 axis 0.1 0.2 1 omega 13",
    "surface_vel v_vx 0.1 v_vz", "surface_ang_vel origin 0.01 0.02 0 axis 0 0.2 1 omega v_om",
)  # fmt: skip
AXIS = "origin 0.01 0.02 0.003 axis 0.2 -0.3 1"
MOVES = {
    "linear": "linear 0.05 0.02 -0.03",
    "linear/variable": "linear/variable v_vx v_vy v_vz",
    "wiggle": "wiggle amplitude 0.001 0.002 0.0005 period 0.01",
    "rotate": f"rotate {AXIS} period 0.05",
    "rotate/variable": f"rotate/variable {AXIS} omega v_om",
    "riggle": f"riggle {AXIS} period 0.02 amplitude 3",
    "viblin": "viblin axis 0.2 -0.3 1 order 2 amplitude 0.001 0.0004 phase 0.3 1.2 "
    "period 0.02 0.007",
    "vibrot": f"vibrot {AXIS} order 2 amplitude 0.05 0.02 phase 0.3 1.2 period 0.02 0.007",
    "second rotate": "rotate origin 0.02 -0.01 0 axis 1 0.3 0.2 period 0.3",
    "second rotate/variable": "rotate/variable origin 0.02 -0.01 0 axis 1 0.3 0.2 omega v_om",
}
LOAD = "atoms ke " + " ".join(f"f_cad[{k}]" for k in range(1, 7))


def moved(*names: str, runs: str = "") -> Case:
    """Return a case with a plate that makes these motions at once."""
    moves = "".join(
        f"fix mv{k} all move/mesh mesh cad {MOVES[name]}\n" for k, name in enumerate(names)
    )
    # 1e-9: the last digits of sine, cosine and of products of quaternions are not LIGGGHTS'
    return Case(
        WEIGHT + SPEEDS + ON_PLATE + MESH + moves + WALL, meshes=PLATE, runs=runs, rtol=1e-9
    )


def on_mesh(words: str, style: str = "mesh/surface", **more: str) -> Case:
    """Return a case with a plate at rest that has further words."""
    mesh = f"fix cad all {style} file m.stl type 2 {words}\n"
    return Case(WEIGHT + ON_PLATE + SPEEDS + mesh + WALL, meshes=PLATE, **more)


SWIRL = "fix g all gravity 9.81 vector 0.3 0.4 -0.2\n"
IN_PIPE = (
    ball(1, "0.0341 0.012 0.02", "0.3 0.5 0", "3 2 1")
    + ball(2, "0 -0.03 0.02", "-0.1 0 1", "0 20 0")
    + ball(3, "-0.03 0.02 0.06", "0 -1 0.3")
    + ball(4, "0.03 -0.03 0.08", "0 1 -1", diameter=0.008)
)
PACK = """
fix ps all particletemplate/sphere 15485863 atom_type 1 density constant 2500 radius constant 0.003
fix pl all particletemplate/sphere 15485867 atom_type 1 density constant 2500 radius constant 0.005
fix pd all particledistribution/discrete 32452843 2 ps 0.3 pl 0.7
"""
RATE = (
    "region low block -0.1 0.1 -0.1 0.1 0.02 0.03 units box\n"
    "fix ins all insert/rate/region seed 32452867 distributiontemplate pd nparticles 300 "
    "particlerate 150000 insert_every 70 overlapcheck yes all_in no vel constant 5 -4 0.1 "
    "region low\n"
)


def in_cylinder(axis: str, shear: str) -> Case:
    """Return a case with a primitive cylinder that turns or slides."""
    wall = f"primitive type 2 {axis}cylinder 0.045 0.001 0.002 shear {shear}"
    return Case(
        SWIRL + IN_PIPE + f"fix w all wall/gran model hertz tangential history {wall}", steps=4000
    )


def in_pipe(words: str, sides: int) -> Case:
    """Return a case with a pipe of facets."""
    mesh = f"fix cad all mesh/surface file m.stl type 2 move 0 0 -0.1 {words}\n"
    return Case(
        SWIRL + IN_PIPE + mesh + WALL, steps=4000, meshes={"m.stl": pipe(0.045, 0.25, sides)}
    )


def stream(all_in: str, overlap: str) -> Case:
    """Return a case with a stream through a planar mesh."""
    insert = (
        "fix ins all insert/stream seed 32452867 distributiontemplate pd nparticles 60 "
        f"particlerate 20000 overlapcheck {overlap} all_in {all_in} vel constant 0 0 -2 "
        "insertion_face cad extrude_length 0.03\n"
    )
    mesh = MESH.replace("mesh/surface", "mesh/surface/planar")
    return Case(WEIGHT + PACK + mesh + insert, steps=1200, meshes={"m.stl": plate(0.1, 0.03, 3)})


AT_FACES = (
    ball(1, "0 0.099 0.005", "0.02 1.5 0", "3 2 1")
    + ball(2, "0.099 0.01 0.005", "0.3 0.1 0", "3 2 1")
    + ball(3, "-0.099 0.04 0.005", "-0.1 0 0", "3 2 1")
)


def periodic(triangles: list[Triangle], *moves: str, **more: str) -> Case:
    """Return a case with a mesh in a periodic box."""
    lines = "".join(f"fix mv{k} all move/mesh mesh cad {m}\n" for k, m in enumerate(moves))
    return Case(
        WEIGHT + AT_FACES + MESH + lines + WALL,
        steps=3000,
        boundary="p p f",
        meshes={"m.stl": triangles},
        **more,
    )


def waves(half: float, cells: int) -> list[Triangle]:
    """Return a plate with waves of the period of the box."""
    return [
        tuple((x, y, z + 0.004 * math.cos(math.pi * x / half)) for x, y, z in triangle)
        for triangle in plate(0.0, half, cells)
    ]


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
    "gravity from variables": Case(
        "variable m equal 9.81*step*0.001\nvariable x equal 0.3\n"
        "fix g all gravity v_m vector v_x 0 -1\n" + THREE + FLOOR, thermo="atoms ke f_g",
    ),
    "gravity chute": Case("fix g all gravity 9.81 chute 24.0\n" + THREE + FLOOR),
    "gravity spherical": Case("fix g all gravity 9.81 spherical 30.0 135.0\n" + THREE + FLOOR),
    "adapt: diameters that grow": Case(
        WEIGHT + THREE + FLOOR + GROW + "fix a all adapt 10 atom diameter v_d", steps=3000
    ),
    "adapt: one group, equal style, several runs": Case(
        WEIGHT + THREE + FLOOR + "group g2 id 2\nvariable d equal 0.01+step*1e-6\n"
        "fix a g2 adapt 7 atom diameter v_d",
        runs="run 1000\nrun 0\nrun 500\nunfix a\nrun 500",
    ),
    "adapt at the start of runs only": Case(
        WEIGHT + THREE + FLOOR + GROW + "fix a all adapt 0 atom diameter v_d reset yes",
        runs="run 1000\nrun 10\nrun 500",
    ),
    **{f"move {name}": moved(name) for name in MOVES if not name.startswith("second")},
    "moves: rotation carried by a linear motion": moved("linear", "rotate"),
    "moves: rotation carried by a rotation": moved("rotate", "second rotate"),
    "moves: riggle before rotate": moved("riggle", "rotate"),
    "moves: rotate before linear": moved("rotate", "linear"),
    "moves: five at once, three runs": moved(
        "vibrot", "viblin", "second rotate", "linear/variable", "second rotate/variable",
        runs="run 700\nrun 600\nrun 700",
    ),
    "moves: unfix in reverse order between runs": moved(
        "rotate", "vibrot", runs="run 500\nunfix mv1\nrun 500\nunfix mv0\nrun 500"
    ),
    **{f"mesh {words.split()[0]}{words.partition(' v_')[1]}": on_mesh(words) for words in BELTS},
    "mesh placed by scale, move, rotate":
        on_mesh("scale 0.9 move 0.001 0.002 0.0003 rotate axis 0.2 -0.3 1 angle 5"),
    "mesh stress: force and torque": on_mesh("", "mesh/surface/stress", thermo=LOAD),
    **{f"mesh stress about a reference point, {name}": Case(
        WEIGHT + ON_PLATE + STRESSED + f"fix m all move/mesh mesh cad {MOVES[name]}\n" + WALL,
        meshes=PLATE, thermo=f"{LOAD} f_cad[7] f_cad[8] f_cad[9]", rtol=1e-9,
    ) for name in ("viblin", "linear", "rotate", "linear/variable")},
    "servo at rest": on_mesh("com 0 0 0 ctrlPV force vel_max 1", "mesh/surface/stress/servo",
        thermo="atoms f_cad[12]"),
    "group of a wall counts by its number": Case(
        WEIGHT + ON_PLATE + GROUPS + (MESH + WALL).replace(" all ", " b "), meshes=PLATE
    ),
    "freeze on a mesh": on_mesh("\ngroup low id 1\nfix a low freeze"),
    "freeze after a mesh wall": Case(
        WEIGHT + ON_PLATE + MESH + WALL + "group low id 1\nfix a low freeze", meshes=PLATE
    ),
    **{
        f"{axis} cylinder, shear {way}": in_cylinder(axis, f"{way} {speed}")
        for axis in "xyz"
        for way, speed in (("x", 0.3), ("y", -0.4), ("z", 0.5))
    },
    "pipe of 12 facets": in_pipe("", 12),
    "pipe of 40 facets, merged by curvature": in_pipe("curvature 20 curvature_tolerant yes", 40),
    "periodic: plate from face to face": periodic(plate(0.0, 0.1, 4)),
    "periodic: edge of a plate beyond a face": periodic(
        [((-0.1, -0.1, 0), (-0.06, -0.1, 0), (-0.06, 0.1, 0)),
         ((-0.1, -0.1, 0), (-0.06, 0.1, 0), (-0.1, 0.1, 0))]
    ),
    "periodic: plate larger than the box": periodic(plate(0.0, 0.11, 1)),
    "periodic: waves": periodic(waves(0.1, 4)),
    "periodic: belt that leaves the box": periodic(plate(0.0, 0.1, 5), "linear 3.5 0 0"),
    "periodic: two motions, several runs": periodic(
        plate(0.0, 0.1, 2), MOVES["viblin"], "linear 0.3 -0.4 0",
        runs="run 1000\nrun 1000\nunfix mv1\nrun 1000",
    ),
    "new run while contacts slide": Case(
        "fix p1 all property/global coefficientFriction peratomtypepair 2 .05 .05 .05 .05\n"
        + ball(1, "0 0 0.01", "0.5 0.1 0", "30 20 10")
        + ball(2, "0.0101 0.002 0.01", "-0.3 0 -0.1", "0 -20 10", diameter=0.008),
        runs="run 200\nrun 100\nrun 100",
    ),
    "stream: all_in yes on a planar mesh": stream("yes", "yes"),
    "stream: all_in yes without overlap check": stream("yes", "no"),
    "insertion across periodic faces": Case(PACK + RATE, steps=600, boundary="p p f", rtol=1e-9),
    "check/timestep": Case(THREE + "fix a all check/timestep/gran 1 1 1\n", thermo=FORCES),
    "massflow with deletion, then delete_atoms": Case(
        WEIGHT + IN_PIPE.replace("0.02 units", "0.05 units")
        + "fix cad all mesh/surface file m.stl type 1\n"
        "fix f all massflow/mesh mesh cad count once vec_side 0 0 -1 delete_atoms yes",
        meshes={"m.stl": plate(0.03, 0.09, 2)}, thermo="atoms f_f[1] f_f[2] f_f[5] f_f[6]",
        runs="run 2500\ngroup two id 2\ndelete_atoms group two\nrun 4000",
    ),
}  # fmt: skip
