"""Commands that change the particles that are there: delete_atoms, set, velocity; streams."""

from __future__ import annotations

from dataclasses import replace

from tests.minidem.engine.case_list import FLOOR, PACK, RATE, WALL, WEIGHT
from tests.minidem.engine.cases import Case, plate
from tests.minidem.motion.region_cases import GRID, PARTS

# two lattices into each other, so that particles are too near
DENSE = (
    "lattice sc 0.011\nregion low block -0.09 0.09 -0.09 0.09 0.001 0.08 units box\n"
    "create_atoms 1 region low\nlattice sc 0.013 origin 0.2 0.3 0.1\n"
    "create_atoms 2 region low\nset group all diameter 0.006 density 2500\n"
    "group one type 1\ngroup two type 2\n"
)
EDGES = DENSE.replace("block -0.09 0.09 -0.09 0.09 0.001 0.08", "block -0.1 0.1 -0.1 0.1 0.01 0.03")

FACE = (((-0.05, -0.05, 0.15), (0.05, -0.05, 0.15), (0.05, 0.05, 0.15)),
        ((-0.05, -0.05, 0.15), (0.05, 0.05, 0.15), (-0.05, 0.05, 0.15)))  # fmt: skip
STREAM = (
    "fix {} all insert/stream seed {} distributiontemplate pd nparticles 200 particlerate 20000 "
    "overlapcheck yes all_in yes vel constant 0 0 -9 insertion_face face extrude_length 0.03\n"
)
STREAMS = (
    "fix face all mesh/surface/planar file f.stl type 2\n"
    + PACK
    + WEIGHT
    + STREAM.format("one", 32452867)
    + STREAM.format("two", 86028157)
)

SIDE = "fix side all wall/gran model hertz tangential history primitive type 2 xplane 0.08\n"


def left(lines: str, boundary: str = "f f f", before: str = DENSE) -> Case:
    """Return a case with particles after some commands."""
    return Case(before + lines + WEIGHT + FLOOR, steps=100, boundary=boundary, skin=0.004)


def parted(lines: str) -> Case:
    """Return a case with contacts of all kinds, and what comes after a first run."""
    dense = DENSE + "delete_atoms overlap 0.0055 all all\nvelocity all set 0.3 -0.1 -0.8\n"
    floor = "fix cad all mesh/surface file m.stl type 1\n" + WALL + SIDE
    return Case(
        dense + WEIGHT + floor, steps=80, meshes={"m.stl": plate(0.0, 0.09)}, skin=0.004,
        runs="run 240\n" + lines,
    )  # fmt: skip


CASES: dict[str, Case] = {
    "delete_atoms overlap": left("delete_atoms overlap 0.006 all all\n"),
    "delete_atoms overlap of two groups": left("delete_atoms overlap 0.007 two one compress no\n"),
    "delete_atoms overlap in a periodic box": left(
        "delete_atoms overlap 0.006 all all\n", "p p f", EDGES
    ),
    "delete_atoms overlap of groups in a periodic box": left(
        "delete_atoms overlap 0.006 one two\n", "p p f", EDGES
    ),
    "delete_atoms porosity": left(
        PARTS + "delete_atoms porosity c1 0.3 12345787\n", before=GRID
    ),
    "set type/fraction": left(
        "set group all type/fraction 2 0.3 123457\nset type 2 diameter 0.01\n", before=GRID
    ),
    "set image": left(
        "delete_atoms overlap 0.006 all all\nset type 1 image 1 NULL 0\n"
        "fix s all spring tether 5 0.0 0.0 NULL 0.0\n", "p p f", EDGES,
    ),
    "velocity ramp": left(
        "velocity all ramp vx -0.5 0.5 z 0.01 0.1\n"
        "velocity all ramp vx 0.1 0.2 y -0.05 0.02 sum yes\n"
        "velocity all ramp vz 1 2 x -3 3 units lattice\n", before=GRID,
    ),
    "velocity set, sum and lattice": left(
        "variable w atom 0.01*id/(id+3)\nvelocity all set 1 NULL -0.5 units lattice\n"
        "velocity all set 0.1 v_w v_w sum yes\n", before=GRID,
    ),
    "set_property of particles that are inserted": Case(
        "fix tag all property/atom tag scalar yes no no 1.5\n" + PACK + WEIGHT
        + RATE.replace("all_in no", "all_in no set_property tag 2.25")
        + "variable q atom 0.001*f_tag\nfix a all addforce v_q 0 0\n", steps=600,
    ),
    "insert_every_time and compress_tags": Case(
        PACK + WEIGHT + RATE.replace("insert_every 70", "insert_every_time 0.00071").replace(
            "all_in no", "all_in no compress_tags no"
        ), steps=600,
    ),
    "two streams through one face": Case(STREAMS, steps=900, meshes={"f.stl": FACE}),
    # the other way round LIGGGHTS takes another fix away and stops
    "the last stream goes, another insertion stays": Case(
        STREAMS + RATE, steps=600, meshes={"f.stl": FACE},
        runs="run 150\nunfix two\nrun 120\nunfix one\nrun 330\n",
    ),
    # id is there so that particles without a stream are pushed, too
    "what is known of flights": Case(
        STREAMS + RATE + "variable q atom 1e-6*id+1e-6*f_release_fix_insert_stream[5]"
        "-2e-7*f_release_fix_insert_stream[4]\n"
        "variable r atom 1e-3*f_release_fix_insert_stream[3]+1e-5*f_release_fix_insert_stream[10]\n"
        "fix a all addforce v_q v_r 0\n", steps=900, meshes={"f.stl": FACE},
    ),
    "insert/pack below an upper face that moves": Case(
        WEIGHT + PACK + FLOOR
        + "region pool block -0.05 0.05 -0.05 0.05 0.005 0.05 units box\n"
        "fix ins all insert/pack seed 32452867 distributiontemplate pd insert_every once "
        "overlapcheck yes all_in yes vel constant 0 0 -0.5 particles_in_region 40 region pool\n",
        boundary="f f fm", steps=600,
    ),
    "contacts begin anew with a compute that has lists of its own": parted(
        "compute c all contact/atom\nrun 80\nuncompute c\ncompute d all coord/atom 0.005\nrun 80\n"
    ),
    "contacts begin anew with a pair_style": parted(
        "pair_style gran model hertz tangential history tangential_damping off\npair_coeff * *\n"
        "run 80\n"
    ),
    "contacts begin anew with other memory, with meshes, too": parted(
        "neigh_modify page 200000\nrun 80\n"
    ),
    "contacts begin anew in every run behind other memory": replace(
        parted("run 40\nrun 40\n"),
        body="neigh_modify one 2500 page 150000\n" + parted("").body,
    ),
    "contacts go on behind other memory that is given twice": replace(
        parted("run 40\nrun 40\n"),
        body=2 * "neigh_modify one 2500 page 150000\n" + parted("").body,
    ),
    "contacts go on with what has no lists": parted(
        "compute c all stress/atom\ncompute d all displace/atom\nneighbor 0.003 bin\n"
        "neigh_modify one 2000 page 100000\nrun 80\n"
    ),
    "pressure of a run that begins without particles": Case(
        PACK + RATE + "compute p all pressure thermo_temp\n", steps=300,
        thermo="atoms ke c_thermo_temp c_p c_p[3]", runs="run 300\nrun 300\n",
    ),
    "sums per particle": Case(
        DENSE + "delete_atoms overlap 0.0055 all all\nvelocity all set 0.3 -0.1 -0.8\n"
        "fix cad all mesh/surface/stress file m.stl type 1\n" + WALL
        + "compute k all ke\ncompute p all pressure thermo_temp\nfix a all ave/time 1 1 10 c_k\n"
        "fix b all ave/time 1 1 10 c_k c_thermo_temp f_cad[3] c_thermo_temp[1]\n"
        "fix v all ave/time 1 1 10 c_thermo_temp c_thermo_temp mode vector\n"
        "fix t all ave/time 1 1 10 c_thermo_temp mode vector\n"
        "compute s all slice 1 4 1 c_thermo_temp\n",
        steps=80, meshes={"m.stl": plate(0.0075, 0.09)}, skin=0.004,
        thermo="ke c_k f_cad[3] f_cad[5] f_cad[7] f_a f_b[1] f_b[2] f_b[3] f_b[4] f_t[1] c_s[2] "
        "f_v[1][2]",
        runs="run 60\nthermo_modify norm yes\nrun 80\n",
    ),
    "compress_tags": Case(
        "atom_modify sort 10 0.012\nlattice bcc 0.0067\nregion low block -0.012 0.012 -0.012 0.012 "
        "0.06 0.072 units box\ncreate_atoms 1 region low basis 2 2\nset group all diameter 0.006 "
        "density 2500\nset type 2 vx 0.3\n"
        "region up block -0.05 0.05 -0.05 0.05 0.01 0.05 units box\n"
        + PACK + WEIGHT + FLOOR
        + "fix ins all insert/rate/region seed 32452867 distributiontemplate pd nparticles INF "
        "particlerate 10000 insert_every 20 compress_tags yes vel constant 0 0 -1 region up\n",
        steps=180,
    ),
    "pre no goes on with the last forces": parted(
        "velocity all set 0 0 -0.2 sum yes\nrun 40 pre no\nrun 60 pre no every 20 NULL\n"
    ),
}  # fmt: skip
"""Cases by name."""
