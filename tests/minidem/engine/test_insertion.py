"""Insertion at the positions LIGGGHTS-PUBLIC 3.8.0 chooses, to the last bit.

The data were printed by its Debian build with 17 digits; particles do not move in
``regions.json`` (no integrator), so the last dump holds all places of insertion.
"""

from __future__ import annotations

import hashlib
import json
import shutil
import subprocess

import numpy as np
import pytest

from minidem.errors import DemError
from minidem.insertion.distribution import make_distribution, make_template
from minidem.insertion.factory import Surroundings, make_inserter
from minidem.insertion.particles import Present
from minidem.insertion.region import Site, make_region
from minidem.insertion.settings import Domain
from minidem.kernels.insertion.random import skip
from minidem.world.mesh.stl import numbered_triangles
from tests.paths import DATA

STORED = DATA / "minidem" / "insertion"
CASES = json.loads((STORED / "cases.json").read_text())
REGIONS = json.loads((STORED / "regions.json").read_text())
BOX = np.array([[-0.05, -0.05, -0.01], [0.05, 0.05, 0.1]])
DT = 1e-5


def no_face(name):
    raise KeyError(name)


def inserter_of(lines, face=no_face):
    """Make the insertion command of some script lines."""
    templates, distributions, regions, made = {}, {}, {}, None
    for line in lines:
        words = line.split()
        if words[0] == "region":
            regions[words[1]] = make_region(words[2:], Site(regions, BOX))
        elif words[0] == "fix" and words[3] == "particletemplate/sphere":
            templates[words[1]] = make_template(words[1], words[4:])
        elif words[0] == "fix" and words[3].startswith("particledistribution"):
            distributions[words[1]] = make_distribution(words[3], words[4:], templates)
        elif words[0] == "fix" and words[3].startswith("insert"):
            around = Surroundings(distributions, regions, face, 0, DT)
            made = make_inserter(words[1], words[3], words[4:], around)
    return made


def digest(rows) -> str:
    text = "\n".join(" ".join(f"{x:.17g}" for x in row) for row in rows)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def test_random_numbers_are_those_of_park_and_miller():
    """A number above the modulus by one, the last one, and the check of their paper."""
    most = 2**31 - 1
    for seed in (1, pow(16807, -1, most), most - 1, 127773):
        state = np.array([seed, 0.0, 0.0])
        skip(state, 1)
        assert state[0] == 16807 * seed % most
    state = np.array([1.0, 0.0, 0.0])
    skip(state, 10_000)
    assert state[0] == 1043618065


@pytest.mark.parametrize("name", sorted(CASES))
def test_golden_case_has_the_same_positions(name):
    case = CASES[name]
    inserter = inserter_of(case["lines"], lambda mesh: numbered_triangles(STORED / "face.stl")[0])
    domain = Domain(BOX, ("f", "f", "f"))
    inserter.setup(DT, domain)
    radius = np.zeros(0)
    for step, rows in case["rows"].items():
        reference = np.array(rows, dtype=np.float64)
        there = len(radius)
        assert inserter.next_step == int(step)
        new = inserter.insert(int(step), Present(reference[:there, 1:4], radius), domain)
        np.testing.assert_array_equal(new.position, reference[there:, 1:4])
        np.testing.assert_array_equal(new.type, reference[there:, 0])
        radius = np.concatenate([radius, new.radius])


def run_all(case):
    """Let one command insert for 201 steps while nothing moves."""
    lines = [*case["regions"], *case["templates"], case["distribution"], case["insert"]]
    inserter = inserter_of(lines)
    boundary = tuple(case["boundary"].split())

    def domain(step):
        flat = case["boxes"].get(str(step))
        box = BOX if flat is None else np.array([flat[0::2], flat[1::2]])
        return Domain(box, boundary)

    inserter.setup(DT, domain(0))
    position, velocity = np.zeros((0, 3)), np.zeros((0, 3))
    radius, mass = np.zeros(0), np.zeros(0)
    while inserter.next_step is not None and inserter.next_step <= 201:
        step = inserter.next_step
        new = inserter.insert(step, Present(position, radius, mass), domain(step - 1))
        position = np.concatenate([position, new.position])
        velocity = np.concatenate([velocity, new.velocity])
        radius, mass = np.append(radius, new.radius), np.append(mass, new.mass)
    return inserter, position, velocity


@pytest.mark.parametrize("number", range(len(REGIONS)))
def test_region_is_filled_as_by_liggghts(number):
    """Pack and rate, all regions, several events, fixed and shrink-wrapped boxes, log lines."""
    case = REGIONS[number]
    inserter, position, velocity = run_all(case)
    assert len(position) == case["count"]
    assert [f"{x:.17g}" for x in position[-1]] == case["last"][1:4]
    assert digest(position) == case["positions"]
    assert digest(velocity) == case["velocities"]
    assert inserter.take_messages() == case["log"]


def test_restored_command_goes_on_as_the_first():
    case = next(c for c in REGIONS if "rate" in c["insert"] and not c["boxes"])
    lines = [*case["regions"], *case["templates"], case["distribution"], case["insert"]]
    first, second = inserter_of(lines), inserter_of(lines)
    domain = Domain(BOX, ("f", "f", "f"))
    first.setup(DT, domain)
    nothing = Present(np.zeros((0, 3)), np.zeros(0))
    first.insert(first.next_step, nothing, domain)
    second.restore(first.state())
    second.setup(DT, domain)
    assert second.next_step == first.next_step
    assert second.inserted == first.inserted
    a = first.insert(first.next_step, nothing, domain)
    b = second.insert(second.next_step, nothing, domain)
    np.testing.assert_array_equal(a.position, b.position)


BASE = (
    "region r block 0 0.02 0 0.02 0 0.02",
    "fix p all particletemplate/sphere 15485863 atom_type 1 density constant 2500 "
    "radius constant 0.001",
    "fix d all particledistribution/discrete 15485867 1 p 1",
)
GOOD = (
    "fix i all insert/rate/region seed 32452843 distributiontemplate d nparticles 10 "
    "particlerate 1e4 insert_every 100 region r"
)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("region r block", "region r blok", "did you mean 'block'?"),
        ("0 0.02 0 0.02", "0.02 0 0 0.02", "x bounds 0.02 0.0 are reversed"),
        ("block 0 0.02", "block 0 x", "expected a number, found 'x'"),
        ("15485863", "15485864", "must be a prime number above 10000"),
        ("radius constant", "radius uniform", "radius 'uniform' is a word of other editions"),
        ("radius constant 0.001", "", "'radius constant VALUE' is missing"),
        ("radius constant 0.001", "radius constant 1e-5", "volume_limit"),
        ("1 p 1", "2 p 1", "2 templates announced, 1 given"),
        ("1 p 1", "1 q 1", "unknown template 'q'"),
        ("distributiontemplate d", "distributiontemplate e", "unknown particle distribution"),
        ("distributiontemplate d ", "", "'distributiontemplate' is missing"),
        ("seed 32452843", "seed 15485867", "use different primes"),
        ("region r", "region s", "unknown region 's'"),
        (" region r", "", "keyword 'region' is missing"),
        ("insert_every", "insert_evry", "keyword 'insert_evry'"),
        ("nparticles 10", "nparticles 10 mass 3", "not both"),
    ],
)
def test_mistake_is_named(old, new, message):
    lines = [*BASE, GOOD]
    at = next(i for i in reversed(range(4)) if old in lines[i])
    lines[at] = lines[at].replace(old, new)
    with pytest.raises(ValueError) as error:  # noqa: PT011 - the message is compared below
        inserter_of(lines)
    assert message in str(error.value)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("insert_every 100 ", "", "'insert_every' is missing"),
        ("particlerate 1e4 ", "", "give either 'massrate' or 'particlerate'"),
        ("nparticles 10 ", "", "give either 'nparticles' or 'mass'"),
        ("0 0.02 0 0.02 0 0.02", "0 0.02 0 0.02 0.2 0.3", "no volume found"),
    ],
)
def test_missing_keyword_is_named_before_the_first_step(old, new, message):
    lines = [line.replace(old, new) for line in [*BASE, GOOD]]
    with pytest.raises(ValueError, match=message):
        inserter_of(lines).setup(DT, Domain(BOX, ("f", "f", "f")))


def test_region_over_a_fixed_face_is_refused():
    lines = [*BASE, GOOD]
    lines[0] = "region r block 0 0.02 0 0.02 0 0.2"
    inserter = inserter_of(lines)
    domain = Domain(BOX, ("f", "f", "f"))
    inserter.setup(DT, domain)
    with pytest.raises(DemError, match="extends outside the simulation box"):
        inserter.insert(1, Present(np.zeros((0, 3)), np.zeros(0)), domain)


FIXED = Domain(BOX, ("f", "f", "f"))


def packing(region: str, fraction: float):
    """Return the command that packs spheres into a region, ready to insert."""
    command = (
        "fix i all insert/pack seed 32452843 distributiontemplate d maxattempt 100 insert_every "
        f"once overlapcheck yes all_in yes region r volumefraction_region {fraction}"
    )
    inserter = inserter_of([f"region r {region}", *BASE[1:], command])
    inserter.setup(DT, FIXED)
    return inserter


def test_spheres_neither_overlap_nor_stick_out(rng):
    """Thousands of spheres in a dense region, with strangers in the way."""
    inserter = packing("cylinder z 0 0 0.02 0 0.04", 0.25)
    # Not larger than the template: LIGGGHTS overlooks larger ones outside the region.
    # Some stand just outside, where the box about the region ends.
    outside = [(x, y, z) for x, y in ((0.0205, 0.0), (0.0, -0.0205)) for z in (0.01, 0.02, 0.03)]
    there = Present(np.array([*rng.uniform(-0.01, 0.02, (5, 3)), *outside]), np.full(11, 0.001))
    new = inserter.insert(1, there, FIXED)
    assert len(new.position) > 2000
    centre = np.concatenate([there.position, new.position])
    radius = np.concatenate([there.radius, new.radius])
    distance = np.linalg.norm(centre[:, None] - new.position[None], axis=2)
    distance[np.arange(len(new.position)) + 11, np.arange(len(new.position))] = np.inf
    assert (distance > radius[:, None] + new.radius[None]).all()
    assert (np.hypot(*new.position[:, :2].T) <= 0.02 - new.radius).all()


@pytest.mark.parametrize(("times", "warned"), [(3.0, False), (9.0, True)])
def test_grains_in_much_larger_ones_are_told(times, warned):
    """LIGGGHTS looks four radii far, and so do we; where it puts them: family `boulders`."""
    inserter = packing("block -0.02 0.02 -0.02 0.02 0 0.04", 0.1)
    inserter.take_messages()
    radius = times * inserter.settings.distribution.max_radius
    there = Present(np.array([[0.0, 0.0, 0.02]]), np.array([radius]))
    new = inserter.insert(1, there, FIXED)
    apart = np.linalg.norm(new.position - there.position, axis=1)
    inside = int(np.sum(apart <= radius + new.radius))
    told = [text for text in inserter.take_messages() if "larg" in text]
    assert bool(inside) == warned
    assert [f"fix i: {inside} of {len(new.radius)} new" in text for text in told] == [True] * warned


@pytest.mark.liggghts
def test_live_run_of_liggghts_agrees(tmp_path):
    """The installed program itself, with seeds of today's choice."""
    inserted = (
        "fix i all insert/rate/region seed 67867967 distributiontemplate d nparticles 300 "
        "particlerate 2e5 insert_every 50 overlapcheck yes all_in yes vel uniform 0 0 -1 .1 .1 .2 "
        "region r"
    )
    lines = ["region r cylinder z 0 0.001 0.01 0.01 0.05", *BASE[1:], inserted]
    head = "atom_style sphere|atom_modify map array sort 0 0|boundary f f f|newton off"
    head += "|communicate single vel yes|units si|region b block -.05 .05 -.05 .05 -.01 .1"
    head += "|create_box 1 b|neighbor 0.002 bin|neigh_modify delay 0"
    head += "|fix m1 all property/global youngsModulus peratomtype 5e6"
    head += "|fix m2 all property/global poissonsRatio peratomtype .3"
    head += "|fix m3 all property/global coefficientRestitution peratomtypepair 1 .6"
    head += "|fix m4 all property/global coefficientFriction peratomtypepair 1 .5"
    head += "|pair_style gran model hertz tangential history|pair_coeff * *|timestep 1e-5"
    tail = "dump d all custom 200 t_*.dump id x y z vx vy vz"
    tail += '|dump_modify d sort id format "%d %.17g %.17g %.17g %.17g %.17g %.17g"|run 200'
    script = [*head.split("|"), *lines, *tail.split("|")]
    (tmp_path / "in.s").write_text("\n".join(script) + "\n")
    program = shutil.which("liggghts")
    assert program
    subprocess.run([program, "-in", "in.s"], cwd=tmp_path, check=True, capture_output=True)
    reference = np.loadtxt(tmp_path / "t_200.dump", skiprows=9)
    case = {"regions": [lines[0]], "templates": [lines[1]], "distribution": lines[2]}
    case |= {"insert": inserted, "boundary": "f f f", "boxes": {}}
    _, position, velocity = run_all(case)
    np.testing.assert_array_equal(position, reference[:, 1:4])
    np.testing.assert_array_equal(velocity, reference[:, 4:])
