"""An own template whose experiment has one kind of contact only, as two balls that collide."""

from dataclasses import replace

import pytest

from liggghts_io import CaseError, CaseSpec, experiment_of, read_experiment
from liggghts_io.case.spec import script_of
from liggghts_io.effects import effects_in
from tests.liggghts_io.conftest import PARAMETERS, PARTICLES
from tests.liggghts_io.own.folders import make_folder

DEFINITION = """\
name = "pair"
title = "Two balls"
contact = ["mu_pp", "e_pp"]

[parameters.offset_d]
unit = "-"
meaning = "distance of the second ball from the line of flight, in diameters"
default = 0.5

[[observable]]
name = "speed_m_s"
unit = "m/s"
meaning = "speed of the second ball"
extract = "last"
file = "after.txt"
column = "v_m_s"
"""
TEMPLATE = """\
{% set domain = (-0.1, 0.1, -0.1, 0.1, -0.1, 0.1) %}
{% import "common.j2" as common with context %}
{{ common.head("Two balls collide") }}
{{ common.materials() }}
create_atoms 1 single 0 {{ (offset_d * d32_m) | number }} 0 units box
{{ common.run(0.01) }}
"""


@pytest.fixture
def pair(tmp_path):
    """Make a spec of the two balls, with one more line at the end of the template."""

    def make(line="", **changes):
        name = f"pair{len(line)}"
        folder = make_folder(tmp_path / name, DEFINITION, TEMPLATE + line, "script.in.j2")
        contact = {name: PARAMETERS[name] for name in ("mu_pp", "e_pp")}
        spec = CaseSpec(
            "pair", PARTICLES["Carbo HSP13"], "flat", "quick", contact, own=read_experiment(folder)
        )
        return replace(spec, **changes)

    return make


def matrix(script, word):
    """Return the numbers of a property of pairs, of grains with grains, test and other walls."""
    line = next(one for one in script.splitlines() if f" {word} " in one)
    return [float(one) for one in line.split()[-9:]]


def test_contacts_that_do_not_happen_take_the_values_of_the_other_walls(pair):
    script = script_of(pair(apparatus={"e_side": 0.4, "mu_side": 0.2, "mu_roll_side": 0.1}))
    e, mu = PARAMETERS["e_pp"], PARAMETERS["mu_pp"]
    assert matrix(script, "coefficientRestitution") == [e, *[0.4] * 8]
    assert matrix(script, "coefficientFriction") == [mu, *[0.2] * 8]
    assert matrix(script, "coefficientRollingFriction") == [0.1] * 9


def test_every_effect_of_the_grains_can_be_tried(pair):
    """One that cannot be written would end a diagnosis."""
    spec = pair()
    effects = effects_in(experiment_of(spec)).values()
    tried = [one for one in effects if one.needs_runs and one.fits(spec.particle)]
    assert {"static_friction_ratio", "wall_adhesion_J_m3"} <= {one.name for one in tried}
    for one in tried:
        strength = 1.0 if one.switch else min(one.scale, one.high)
        assert script_of(pair(effects={one.name: strength})) != script_of(spec)


@pytest.mark.parametrize("use", ["{{ mu_pw | number }}", "{% set twice = 2 * mu_pw %}"])
def test_a_parameter_that_the_experiment_leaves_out_is_told(pair, use):
    with pytest.raises(CaseError, match=r"pair/script\.in\.j2:7: 'mu_pw' is undefined: 'contact'"):
        script_of(pair(use))


def test_an_unknown_name_comes_with_the_nearest_one(pair):
    with pytest.raises(CaseError, match="'ofset_d' is undefined; did you mean 'offset_d'"):
        script_of(pair("{{ ofset_d | number }}"))
