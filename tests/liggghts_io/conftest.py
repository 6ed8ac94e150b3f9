"""Specs that the tests of the case layer share."""

from dataclasses import replace

import pytest

from liggghts_io import CaseSpec, read_particles
from liggghts_io.case.directory import write_files
from liggghts_io.case.mark import script_digest, with_mark
from liggghts_io.case.spec import Case, describe, identity_of, script_of
from tests.paths import CASES

PARTICLES = read_particles(CASES / "particles.csv")
PARAMETERS = {
    "mu_pp": 0.694, "mu_roll_pp": 0.0856, "mu_pw": 0.307, "mu_roll_pw": 0.274,
    "e_pp": 0.742, "e_pw": 0.439,
}  # fmt: skip
# The apparatus of each experiment cut down to what an engine runs in about a second.
SMALL = {
    "heap": {"pour_grains": 60.0, "pour_tau": 12.0, "settle_tau": 6.0, "pour_stages": 2.0},
    "conveyor": {"width_fraction": 0.09, "duration_flat_s": 1.5, "poured_mass_kg": 0.03},
    "plate_impact": {"mass_fraction": 0.005, "flight_s": 0.28},
    "tilting_plate": {"tilt_rate_deg_s": 60.0, "largest_tilt_deg": 20.0, "raft_side_d": 5.0},
    "drum": {"duration_s": 0.2},
    "drawdown": {
        "box_half_d": 10.0, "width_d": 2.0, "slot_half_d": 2.5, "filling_d": 6.0, "drop_d": 10.0,
        "settle_tau": 6.0, "flow_tau": 20.0,
    },
    "funnel_flow": {
        "half_angle_deg": 45.0, "mass_g": 15.0, "settle_tau": 1.0, "flow_part": 0.05,
        "frames": 10.0,
    },
}  # fmt: skip
# A pour near the end of the plate: a time is reached within a second of computing.
TIMED = {
    "width_fraction": 0.12, "duration_flat_s": 4.0, "poured_mass_kg": 0.2,
    "pour_position_m": 0.32, "target_mass_kg": 0.02,
}  # fmt: skip


@pytest.fixture
def particles():
    """Return the particles of the paper by name."""
    return PARTICLES


ONE_DIAMETER = replace(PARTICLES["Carbo HSP13"], sizes="one")


@pytest.fixture
def make_spec():
    """Make a spec of an experiment; keywords change its fields."""

    def make(experiment="heap", **changes):
        spec = CaseSpec(experiment, PARTICLES["Carbo HSP13"], "steel", "quick", PARAMETERS)
        return replace(spec, **changes)

    return make


@pytest.fixture
def write_changed():
    """Write a case whose script was changed before it was recorded, as another template would."""

    def write(directory, spec, old, new):
        script = script_of(spec).replace(old, new)
        assert script != script_of(spec)
        case = describe(spec)
        inputs = {**case.inputs, "script": script_digest(script)}
        identity = identity_of(inputs)
        write_files(Case(identity, inputs, with_mark(script, identity), case.meshes), directory)
        return directory

    return write


@pytest.fixture
def timed_spec(make_spec):
    """Make a spec of a conveyor that determines its time within a second."""

    def make(**changes):
        return make_spec("conveyor", **({"apparatus": TIMED} | changes))

    return make


@pytest.fixture
def small_spec(make_spec):
    """Make a spec that runs in about a second."""

    def make(experiment="heap", **changes):
        return make_spec(experiment, apparatus=SMALL[experiment], **changes)

    return make
