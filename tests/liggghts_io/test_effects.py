"""Effects: strength 0 is the base model, others change what they name."""

import math
from dataclasses import replace

import pytest

from liggghts_io import CaseError, case_id, execute, run_case, write_case
from liggghts_io.case.spec import build_case, describe, script_of, setup_of
from liggghts_io.effects import EFFECTS
from liggghts_io.effects.from_table import FOLDER, effect_of_table
from liggghts_io.experiments import EXPERIMENTS
from liggghts_io.sizes import mixture
from minidem import ScriptError, run_script
from minidem.contact.extensions import EXTENSIONS
from tests.liggghts_io.conftest import ONE_DIAMETER

ONLY_MINIDEM = sorted(name for name, effect in EFFECTS.items() if effect.extension)


@pytest.mark.parametrize("name", sorted(EFFECTS))
@pytest.mark.parametrize("experiment", sorted(EXPERIMENTS))
def test_strength_zero_is_the_same_text_and_the_same_case(make_spec, name, experiment):
    base, off = make_spec(experiment), make_spec(experiment, effects={name: 0.0})
    assert script_of(off) == script_of(base)
    assert case_id(off) == case_id(base)


@pytest.mark.parametrize("name", sorted(EFFECTS))
@pytest.mark.parametrize("experiment", sorted(EXPERIMENTS))
def test_an_effect_changes_exactly_the_experiments_it_names(make_spec, name, experiment):
    effect = EFFECTS[name]
    grains = replace(ONE_DIAMETER, sizes="one" if effect.fits(ONE_DIAMETER) else "measured")
    more = {"surface": effect.walls[0]} if effect.walls else {}
    base = make_spec(experiment, particle=grains, **more)
    on = replace(base, effects={name: effect.scale})
    if effect.acts_in(experiment):
        before, after = describe(base), describe(on)
        same = before.inputs["script"], before.meshes
        assert (same == (after.inputs["script"], after.meshes)) is not effect.needs_runs
        assert after.identity != before.identity
        return
    for ask in (script_of, case_id):
        with pytest.raises(CaseError, match=f"{name} = .* cannot act in .* {experiment}"):
            ask(on)


def test_an_effect_that_changes_nothing_is_refused(make_spec, monkeypatch):
    idle = replace(EFFECTS["air_drag"], apply=lambda variables, _strength, _setup: dict(variables))
    monkeypatch.setitem(EFFECTS, "air_drag", idle)
    with pytest.raises(CaseError, match="air_drag = 1 changes nothing in the experiment heap"):
        script_of(make_spec("heap", effects={"air_drag": 1.0}))


def test_a_new_experiment_meets_the_effects_that_act_everywhere():
    """Only an effect of an apparatus or instrument names it, not one of the grains."""
    silent = {name for name, effect in EFFECTS.items() if not effect.acts_in("mound")}
    assert {"plate_tilt_deg", "plate_period", "mass_flow_factor", "clock_factor"} <= silent
    assert not silent & {"cohesion_J_m3", "air_drag", "size_distribution", "torsion"}


@pytest.mark.parametrize("name", sorted(EFFECTS))
def test_effects_document_themselves_and_keep_their_sign(make_spec, name):
    effect = EFFECTS[name]
    assert effect.title
    assert effect.meaning
    assert effect.low <= 0.0 < effect.scale <= effect.high
    assert effect.sign == ("positive" if effect.low == 0.0 else "both")
    with pytest.raises(CaseError, match=name):
        script_of(make_spec("conveyor", effects={name: effect.low - 1.0}))


def test_unknown_effect_names_the_nearest(make_spec):
    with pytest.raises(
        CaseError, match=r"unknown effect 'cohesion_J'; did you mean 'cohesion_J_m3'"
    ):
        script_of(make_spec(effects={"cohesion_J": 1.0}))


def test_measured_sizes_keep_the_sauter_diameter(make_spec):
    setup = setup_of(make_spec())
    for strength in (0.3, 1.0):
        classes = mixture(setup.particle, strength)
        # The Sauter diameter of mass fractions w_k is 1 / sum(w_k / d_k).
        sauter = 1.0 / sum(part / diameter for diameter, part in classes)
        assert sauter == pytest.approx(setup.particle.d32_m)
        assert sum(part for _, part in classes) == pytest.approx(1.0)
    ratios = [d / classes[1][0] for d, _ in classes]
    assert ratios == pytest.approx([1344 / 1547, 1.0, 1774 / 1547])


def test_size_distribution_keeps_the_mass_flow(make_spec):
    base = build_case(make_spec("conveyor", particle=ONE_DIAMETER)).variables
    on = build_case(make_spec("conveyor", effects={"size_distribution": 1.0})).variables
    cubes = [part / diameter**3 for diameter, part in on["sizes"]]
    per_grain = 1.0 / sum(cubes) / base["sizes"][0][0] ** 3
    assert on["grain_rate"] * per_grain == pytest.approx(base["grain_rate"])


def test_tilt_leans_gravity_to_the_discharge(make_spec):
    gravity = build_case(make_spec("conveyor", effects={"plate_tilt_deg": 2.0})).variables[
        "gravity"
    ]
    assert gravity == pytest.approx((0.0348995, 0.0, -0.9993908), abs=1e-7)


def test_a_slow_plate_stretches_every_harmonic_alike(make_spec):
    base = build_case(make_spec("conveyor")).variables
    late = build_case(make_spec("conveyor", effects={"plate_period": 0.08})).variables
    assert late["periods"] == pytest.approx([1.08 * one for one in base["periods"]])
    assert late["amplitudes"] == base["amplitudes"]


def test_effects_that_only_minidem_has_name_its_words():
    assert {EFFECTS[name].extension for name in ONLY_MINIDEM} == set(EXTENSIONS)


@pytest.mark.parametrize("name", ONLY_MINIDEM)
def test_a_case_for_liggghts_refuses_what_only_minidem_has(make_spec, tmp_path, name):
    spec = make_spec(effects={name: 0.5}, engine="liggghts")
    word = EFFECTS[name].extension
    with pytest.raises(CaseError) as error:
        case_id(spec)
    assert f"engine = 'liggghts': effect {name} = 0.5 needs '{word}'" in str(error.value)
    assert "run it with minidem, or set the strength to 0" in str(error.value)
    write_case(make_spec(effects={name: 0.5}), tmp_path)
    with pytest.raises(CaseError, match=rf"effect {name} = 0.5 needs '{word}'"):
        run_case(tmp_path, "liggghts")


@pytest.mark.parametrize("name", ONLY_MINIDEM)
@pytest.mark.parametrize("experiment", sorted(EXPERIMENTS))
def test_the_script_says_that_it_runs_on_minidem_only(make_spec, tmp_path, experiment, name):
    write_case(make_spec(experiment, effects={name: 0.1}), tmp_path)
    word = EFFECTS[name].extension
    head = (tmp_path / "in.script").read_text().splitlines()[1]
    assert head.endswith(f"runs on minidem only. LIGGGHTS-PUBLIC 3.8.0 does not have {word}.")
    with pytest.raises(ScriptError, match=f"'{word}' is an extension of minidem"):
        run_script(tmp_path / "in.script", root=tmp_path, strict=True)


@pytest.mark.parametrize("name", ONLY_MINIDEM)
def test_an_extended_case_runs_and_differs_from_the_base_case(small_spec, tmp_path, name):
    # boxes always have masses; a heap of few grains may have no flank that can be measured
    base, on = (
        execute(small_spec("plate_impact", effects=effects), tmp_path)
        for effects in ({}, {name: 0.5})
    )
    assert base.status == on.status == "ok", on.reason
    assert all(math.isfinite(mass) for mass in on.observables.values())
    assert base.observables != on.observables


@pytest.mark.parametrize("name", sorted(EFFECTS))
def test_what_settles_an_effect_does_so_within_a_working_day(name):
    """A measurement that is no sharper than half an ordinary strength settles nothing."""
    effect = EFFECTS[name]
    assert 0.0 < effect.settled_se <= 0.5 * effect.scale
    assert 0.0 < effect.settled_hours <= 8.0


def test_a_table_says_how_good_the_measurement_is(tmp_path):
    text = (FOLDER / "plate_amplitude.toml").read_text()
    path = tmp_path / "stroke.toml"
    path.write_text(text.replace("settled_hours = 0.3", "settled_hours = 2"))
    effect = effect_of_table(path)
    assert (effect.settled_se, effect.settled_hours) == (0.01, 2.0)
    path.write_text(text.replace("settled_se = 0.01", "settled_se = '1 %'"))
    with pytest.raises(CaseError, match=r"stroke.toml: settled_se = '1 %'"):
        effect_of_table(path)
