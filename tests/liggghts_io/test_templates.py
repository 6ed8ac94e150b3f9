"""Rendered scripts: stored ones, acceptance by LIGGGHTS, errors of templates."""

import re
import shutil
import subprocess

import jinja2
import pytest

from liggghts_io import CaseError, CaseSpec, Particle, write_case
from liggghts_io.case.spec import describe, script_of
from liggghts_io.experiments import EXPERIMENTS, SCALES
from liggghts_io.scripts.templating import environment, render
from tests.liggghts_io.conftest import PARTICLES
from tests.paths import DATA

GOLDEN = DATA / "liggghts_io"
EFFECTS = {"size_distribution": 1.0, "cohesion_J_m3": 2000.0}
EXTENSIONS = {
    "air_drag": 1.0, "restitution_scatter": 0.1, "restitution_slope": 0.25,
    "static_friction_ratio": 0.2, "tangential_stiffness": -0.25,
}  # fmt: skip
NAMES = {(): "", tuple(EFFECTS): "_effects", tuple(EXTENSIONS): "_extensions"}


@pytest.mark.parametrize(
    ("experiment", "surface", "effects"),
    [
        ("heap", "steel", {}),
        ("heap", "glued", {}),
        ("conveyor", "steel", {}),
        ("plate_impact", "steel", {}),
        ("conveyor", "glued", EFFECTS),
        ("heap", "steel", EXTENSIONS),
    ],
)
def test_script_equals_the_stored_one(make_spec, experiment, surface, effects):
    """A deliberate change: python benchmarks/engine/golden_scripts.py, then read the difference."""
    name = f"{experiment}_{surface}_quick{NAMES[tuple(effects)]}.in"
    text = script_of(make_spec(experiment, surface=surface, effects=effects))
    assert text == (GOLDEN / name).read_text(encoding="utf-8")


TAKEN = [
    (experiment, surface)
    for experiment in sorted(EXPERIMENTS)
    for surface in ("steel", "alumina", "glued")
    if (experiment, surface) != ("tilting_plate", "glued")
]


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("particle", list(PARTICLES))
@pytest.mark.parametrize(("experiment", "surface"), TAKEN)
def test_every_case_is_written_with_the_rules_of_the_paper(
    make_spec, experiment, surface, particle, scale
):
    grain = PARTICLES[particle]
    case = describe(make_spec(experiment, scale=scale, particle=grain, surface=surface))
    text = case.script
    assert all(case.meshes[name] for name in re.findall(r"meshes/(\S+)", text))
    assert "model hertz tangential history rolling_friction epsd2" in text
    assert "neigh_modify delay 0 contact_distance_factor 1.01" in text
    step = float(re.search(r"^timestep (\S+)", text, re.M)[1])
    shear = grain.youngs_modulus / 2.6
    smallest = min(map(float, re.findall(r"radius constant (\S+)", text)))
    rayleigh = 3.141592653589793 * smallest * (grain.density / shear) ** 0.5 / 0.92553
    assert 0.19 * rayleigh < step <= 0.2 * rayleigh
    seeds = re.findall(r"(?:seed|sphere|discrete) (\d{5,})", text)
    assert len(seeds) == len(set(seeds))


@pytest.mark.parametrize("scale", SCALES)
def test_nothing_slides_on_glued_grains_and_the_tilting_plate_says_so(make_spec, scale):
    with pytest.raises(CaseError, match="nothing slides on glued grains; take a flat surface"):
        script_of(make_spec("tilting_plate", scale=scale, surface="glued"))


def test_glued_wall_has_friction_1000_and_the_restitution_of_grains(make_spec):
    text = script_of(make_spec("heap", surface="glued"))
    assert "coefficientFriction peratomtypepair 3 0.694 1000 " in text
    assert "coefficientRollingFriction peratomtypepair 3 0.0856 1000 " in text
    assert "coefficientRestitution peratomtypepair 3 0.742 0.742 " in text


@pytest.mark.liggghts
@pytest.mark.parametrize(("experiment", "surface"), [one for one in TAKEN if "alumina" not in one])
@pytest.mark.parametrize("effects", [{}, EFFECTS | {"wall_adhesion_J_m3": 100.0}])
def test_liggghts_accepts_the_script(make_spec, tmp_path, experiment, surface, effects):
    write_case(make_spec(experiment, surface=surface, effects=effects), tmp_path)
    script = tmp_path / "in.script"
    # Only the number of steps is cut, so that acceptance costs a second instead of many.
    short = re.sub(r"^run \d+", "run 400", script.read_text(), flags=re.M)
    (tmp_path / "in.short").write_text(short)
    program = shutil.which("liggghts")
    assert program, "LIGGGHTS is required here (BULKCAL_REQUIRE_LIGGGHTS=1) but not installed"
    done = subprocess.run(
        ["stdbuf", "-oL", program, "-in", "in.short"],
        cwd=tmp_path, capture_output=True, text=True, timeout=60, stdin=subprocess.DEVNULL,
    )  # fmt: skip
    assert "ERROR" not in done.stdout, done.stdout[-2000:]
    assert done.returncode == 0
    assert "Loop time" in done.stdout


def test_an_undefined_name_is_an_error():
    with pytest.raises(CaseError, match=r"heap.in.j2: '.*' is undefined"):
        render("heap.in.j2", {})


def test_the_raise_tag_stops_with_its_message_and_line():
    template = environment().from_string("one\n{% if x %}{% raise 'no such ' ~ x %}{% endif %}")
    assert template.render(x="") == "one\n"
    with pytest.raises(CaseError, match=r"no such heap \(template line 2\)"):
        template.render(x="heap")


def test_the_raise_tag_needs_a_message():
    with pytest.raises(jinja2.TemplateSyntaxError):
        environment().from_string("{% raise %}")


@pytest.mark.parametrize(
    ("experiment", "override", "message"),
    [
        ("heap", {"plate_half_length_d": 2.0, "pour_half_width_d": 3.0}, "plate must be longer"),
        ("conveyor", {"pour_position_m": 0.5}, "pour must lie on the plate"),
        ("plate_impact", {"pipe_gap_m": -0.01}, "pipe_gap_m = -0.01 m: give a number from 0.001"),
    ],
)
def test_impossible_apparatus_is_refused(make_spec, experiment, override, message):
    with pytest.raises(CaseError, match=message):
        script_of(make_spec(experiment, apparatus=override))


def test_default_spec_needs_only_its_required_fields():
    glass = Particle("glass", 1e-3, 2500.0)
    spec = CaseSpec("heap", glass, "glued", "quick", {"mu_pp": 0.5, "mu_roll_pp": 0.1, "e_pp": 0.6})
    assert "run " in script_of(spec)
