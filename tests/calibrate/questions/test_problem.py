"""From a study to unknowns, places, readings and cases."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibrate.cli.joint.first import check_design
from calibrate.errors import CalibrationError
from calibrate.inference.priors import Prior
from calibrate.inference.problem import together_as_runs
from calibrate.questions.core.design import (
    START_SHARE,
    case_at,
    first_cases,
    refuse_few_points,
    stands_of,
)
from calibrate.questions.core.emulate import emulators_of
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.problem import problem_of, readings_left_out, space_of
from calibrate.questions.core.runs import make_runs, with_curves
from calibrate.questions.joint.calibration import calibrate_jointly
from tests.calibrate.questions import planted
from tests.calibrate.questions.planted import TRUTH, Measurement, bench, planted_study

LEVELS = (25.0, 50.0, 100.0)


def problem_for(data, read=None):
    forms = forms_of(data)
    specs = first_cases(data.study, forms, np.random.default_rng(0))
    runs = with_curves(specs, planted.run(specs, ""), forms, *([read] if read else []))
    trained = emulators_of(forms, runs).trained
    return problem_of(data, forms, {key: one.emulator for key, one in trained.items()})


def test_inputs_are_what_is_unknown_or_differs(tmp_path, rng) -> None:
    measured = [*bench("A", "glued"), *bench("A", "steel"), *bench("B", "steel")]
    data = planted_study(tmp_path, measured, rng, free=("mu_pp", "mu_pw", "e_pw"))
    axes = {key: [axis.name for axis in form.axes] for key, form in forms_of(data).items()}
    assert axes["heap", "glued"] == ["mu_pp"]
    # Two materials differ in one number: their diameter stands for all.
    assert axes["heap", "flat"] == ["mu_pp", "mu_pw", "e_pw", "d32_um"]


def test_fixed_values_that_differ_are_inputs(tmp_path, rng) -> None:
    measured = [*bench("A", "steel"), *bench("A", "alumina")]
    data = planted_study(tmp_path, measured, rng)
    text = data.path.read_text().replace(
        f"[parameter.e_pw]\nvalue = {TRUTH['e_pw']}",
        '[parameter.e_pw]\nvalue = { "A/steel" = 0.4, "A/alumina" = 0.6 }',
    )
    data.path.write_text(text)
    data = planted.load_data(data.path)
    (axis,) = [a for a in forms_of(data)["plate_impact", "flat"].axes if a.name == "e_pw"]
    assert (axis.low, axis.high) == (0.4, 0.6)
    places = {place.name: place for place in problem_for(data).places}
    values = np.full((1, 2), 0.3)
    ends = [
        places[f"plate_impact of A on {wall}"].u[-1].of(values)[0] for wall in ("steel", "alumina")
    ]
    assert ends == pytest.approx([0.0, 1.0])


def test_places_give_back_planted_means(tmp_path, rng) -> None:
    data = planted_study(tmp_path, bench("A", "steel"), rng, free=tuple(TRUTH), design="start = 60")
    problem = problem_for(data)
    values = np.array([[TRUTH[name] for name in problem.space.names]])
    expected = planted.stand_in.means(planted.spec_at(Measurement("A", "steel", "heap", "")))
    (heap,) = [place for place in problem.places if place.name.startswith("heap")]
    found = heap.predict(values)
    off = found.mean[0, 0] - expected["angle_deg"]
    assert abs(off) < 4.0 * np.sqrt(found.total[0, 0])


def test_cases_lie_where_they_were_asked_for(tmp_path, rng) -> None:
    more = "[parameter.plate_tilt_deg]\nrange = [-2.0, 2.0]\n"
    data = planted_study(tmp_path, bench("A", "steel"), rng, free=("mu_pp", "e_pw"), more=more)
    forms = forms_of(data)
    (stand,) = [s for s in stands_of(data.study, forms) if s.form.experiment == "conveyor"]
    u, strengths = np.array([0.25, 0.75]), np.array([1.5])
    spec = case_at(data.study, stand, u, strengths, 3)
    assert spec.effects == {"plate_tilt_deg": 1.5}
    back = stand.form.place_in(spec)
    assert back[0] == pytest.approx(u, abs=1e-9)
    assert back[1] == pytest.approx(strengths)


def test_effects_that_are_unknown_have_twins_where_they_act(tmp_path, rng) -> None:
    more = "[parameter.plate_tilt_deg]\nrange = [-2.0, 2.0]\n"
    data = planted_study(tmp_path, bench("A", "steel"), rng, more=more)
    specs = first_cases(data.study, forms_of(data), rng)
    tilted = [spec for spec in specs if spec.effects.get("plate_tilt_deg")]
    assert {spec.experiment for spec in tilted} == {"conveyor"}
    assert {spec.effects["plate_tilt_deg"] for spec in tilted} == {-2.0, 2.0}
    base = {(spec.seed, spec.parameters["mu_pp"]) for spec in specs if spec not in tilted}
    assert {(spec.seed, spec.parameters["mu_pp"]) for spec in tilted} <= base


@pytest.mark.slow
def test_a_level_on_the_plate_narrows_its_tilt(tmp_path) -> None:
    more = "[parameter.plate_tilt_deg]\nrange = [-2.0, 2.0]\n"
    known = "[known]\nplate_tilt_deg = { value = 0.0, se = 0.1 }\n"
    widths = []
    for text in (more, more + known):
        data = planted_study(
            tmp_path, bench("A", "glued"), np.random.default_rng(1), more=text, design="runs = 100"
        )
        posterior = calibrate_jointly(data, planted.run).posterior
        widths.append(posterior.column("plate_tilt_deg").std())
    assert widths[1] == pytest.approx(0.1, rel=0.15)
    assert widths[0] > 3.0 * widths[1]


def test_the_first_design_leaves_a_part_of_the_budget(tmp_path, rng) -> None:
    data = planted_study(tmp_path, bench("A", "steel"), rng, free=tuple(TRUTH), design="runs = 160")
    assert len(first_cases(data.study, forms_of(data), rng)) <= START_SHARE * 160 + 3


@pytest.mark.parametrize("start", [2, 4, 5, 8])
def test_too_small_a_start_is_refused_before_the_first_run(tmp_path, rng, start) -> None:
    """Two unknowns need five points: what is refused is what no emulator could be trained on."""
    free = ("mu_pp", "mu_roll_pp")
    data = planted_study(tmp_path, bench("A", "glued"), rng, free=free, design=f"start = {start}")
    forms = forms_of(data)
    specs = first_cases(data.study, forms, rng)
    if start >= 5:
        refuse_few_points(forms, specs)
        emulators_of(forms, with_curves(specs, planted.run(specs, ""), forms))
        return
    asked = []
    with pytest.raises(CalibrationError, match=rf"\[design\] start: gives {start} points .* 5 or"):
        calibrate_jointly(data, lambda specs, _label: asked.append(specs))
    with pytest.raises(CalibrationError, match="at least 5"):
        check_design(data, tmp_path / "out")
    assert not asked


def test_a_small_budget_still_gives_points_enough(tmp_path, rng) -> None:
    """One unknown and the smallest budget: three points were too few for an emulator."""
    data = planted_study(tmp_path, bench("A", "steel"), rng, free=("e_pw",), design="runs = 10")
    forms = forms_of(data)
    refuse_few_points(forms, first_cases(data.study, forms, rng))


def test_ties_hold_instances_together(tmp_path, rng) -> None:
    measured = [*bench("A", "steel"), *bench("B", "steel"), *bench("A", "alumina")]
    data = planted_study(tmp_path, measured, rng, free=("mu_pw",))
    text = data.path.read_text().replace(
        "range = [0.1, 0.8]", 'range = [0.1, 0.8]\ntie = "material"'
    )
    data.path.write_text(text)
    space = space_of(planted.load_data(data.path).study)
    (tie,) = space.ties
    names = {space.unknowns[i].key for i in tie.members}
    assert names == {"mu_pw[A/steel]", "mu_pw[B/steel]"}
    assert space.names[-2:] == ("mean of mu_pw[steel]", "spread of mu_pw[steel]")


def test_shared_errors_and_priors_reach_the_problem(tmp_path, rng) -> None:
    shared = '[[shared]]\nname = "balance"\ntargets = ["t2_m1_g", "t3_m2_g"]\nrelative_se = 0.02\n'
    data = planted_study(tmp_path, bench("A", "steel"), rng, more=shared)
    text = data.path.read_text().replace(
        "range = [0.1, 0.8]", "range = [0.1, 0.8]\nprior = { normal = [0.4, 0.1] }"
    )
    data.path.write_text(text)
    data = planted.load_data(data.path)
    problem = problem_for(data)
    assert problem.space.unknowns[0].prior == Prior.normal(0.4, 0.1, 0.1, 0.8)
    readings = {reading.name: reading for reading in problem.readings}
    ((column, loading),) = readings["t2_m1_g"].shared
    assert problem.space.unknowns[column].nuisance
    # The root of a mass changes by half its relative error.
    assert loading == pytest.approx(0.01 * readings["t2_m1_g"].y)
    assert readings["t0_angle_deg"].shared == ()


def test_an_error_of_one_target_alone_is_no_unknown_but_part_of_its_covariance(
    tmp_path, rng
) -> None:
    shared = '[[shared]]\nname = "rim"\ntargets = ["t2_m1_g"]\nrelative_se = 0.02\n'
    problem = problem_for(planted_study(tmp_path, bench("A", "steel"), rng, more=shared))
    assert not any(one.nuisance for one in problem.space.unknowns)
    readings = {reading.name: reading for reading in problem.readings}
    one = readings["t2_m1_g"]
    assert one.shared == ()
    assert one.extra is not None
    # The root of a mass changes by half its relative error.
    assert one.extra[:, 0] == pytest.approx(0.01 * one.y)
    assert readings["t3_m2_g"].extra is None


def test_a_number_that_is_part_of_a_curve_counts_once(tmp_path, rng) -> None:
    rows = [f"{3.0 + 0.1 * mass},{mass},0.4" for mass in range(0, 130, 5)]
    (tmp_path / "curve.csv").write_text("\n".join(["time_s,mass_g,sem_g", *rows]) + "\n")
    more = f"""
[[target]]
name = "curve"
material = "A"
surface = "steel"
experiment = "conveyor"
observable = "mass_time"
file = "curve.csv"
x_column = "time_s"
column = "mass_g"
se_column = "sem_g"
levels = {list(LEVELS)}
"""
    data = planted_study(tmp_path, bench("A", "steel"), rng, more=more)
    assert readings_left_out(data.study) == {"t1_t100_s": "curve"}

    def read(spec, _path, _name, levels):
        return planted.observed(spec)["t100_s"] * np.array(levels) / 100.0

    problem = problem_for(data, read)
    names = {reading.name: len(reading.y) for reading in problem.readings}
    assert names["curve"] == len(LEVELS)
    assert "t1_t100_s" not in names
    # What makes one run slower than another makes all of its levels later.
    (together,) = [one.together for one in problem.readings if one.name == "curve"]
    assert np.diag(together) == pytest.approx(1.0)
    assert together.min() > 0.8
    # What a level is off by more than a run scatters is its own.
    (curve,) = [one for one in problem.readings if one.name == "curve"]
    (place,) = [one for one in problem.places if curve in one.readings]
    wide = replace(curve, se=1000.0 * curve.se, together=None)
    apart = together_as_runs(wide, place.emulator).together
    assert apart == pytest.approx(np.eye(len(LEVELS)), abs=1e-3)
    # Who says which error the levels share has said how they go together.
    shared = '[[shared]]\nname = "clock"\ntargets = ["curve"]\nrelative_se = 0.01\n'
    data.path.write_text(f"{data.path.read_text()}\n{shared}")
    problem = problem_for(planted.load_data(data.path), read)
    assert all(one.together is None for one in problem.readings)


def test_runs_come_once(tmp_path, rng) -> None:
    data = planted_study(tmp_path, bench("A", "glued"), rng)
    forms = forms_of(data)
    specs = first_cases(data.study, forms, rng)
    runs = make_runs(specs, "", planted.run, forms)
    assert len(runs.joined(runs)) == len(specs)
