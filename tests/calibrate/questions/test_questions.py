"""What data can determine, what responds to what, what is stored already."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibrate.causes.studies.from_study import with_effects
from calibrate.emulator.types import Prediction
from calibrate.inference.priors import Prior
from calibrate.inference.problem import Place, Problem, Reading, Source
from calibrate.inference.space import Space, Unknown
from calibrate.questions.core.design import first_cases, pilot_cases, stands_of
from calibrate.questions.core.emulate import emulators_of
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.problem import problem_of
from calibrate.questions.core.runs import make_runs
from calibrate.questions.core.stored import question, runs_named, stored_runs
from calibrate.questions.identify import VAGUE, identify
from calibrate.questions.joint.refine import next_batch
from calibrate.runs.cost import work_of
from calibrate.runs.stored import stored_case
from liggghts_io import CaseResult, case_id, write_case
from liggghts_io.case.results import store_result
from liggghts_io.case.spec import build_case
from tests.calibrate.questions import planted
from tests.calibrate.questions.planted import TRUTH, bench, planted_study


class Plane:
    """An emulator that knows: y = u @ slopes, shape (d, M)."""

    def __init__(self, slopes: np.ndarray, sd: float = 0.0) -> None:
        self.slopes, self.sd = slopes, sd

    def predict(self, inputs):
        """Return the plane, and what it is said not to know."""
        mean = inputs.u @ self.slopes
        return Prediction(mean, np.full_like(mean, self.sd**2), np.zeros((*mean.shape, 0)))


def plane_problem(slopes: np.ndarray, y: float, se: float) -> Problem:
    unknowns = tuple(Unknown(n, "", Prior.uniform(0.0, 1.0)) for n in ("mu_pp", "mu_roll_pw"))
    reading = Reading("angle_glued", slice(0, 1), np.array([y]), np.array([se]))
    place = Place("heap", Plane(slopes), (Source(0), Source(1)), (), (reading,))
    return Problem(Space(unknowns), (place,))


def test_widths_are_those_of_linear_theory(study_data, rng) -> None:
    se = 0.05
    found = identify(study_data, plane_problem(np.array([[1.0], [0.0]]), 0.5, se), 10, rng)
    width = found.widths["width"]
    # Information 1/se^2 of the reading and 12 of the flat prior.
    assert width["mu_pp"] == pytest.approx(np.sqrt(12.0 / (12.0 + 1.0 / se**2)), rel=1e-3)
    assert width["mu_roll_pw"] == pytest.approx(1.0)
    (sentence,) = found.sentences
    assert sentence == (
        "mu_roll_pw: nothing in these data determines it; single grains on a tilting plate would"
    )


def test_two_unknowns_in_one_number_are_not_determined_apart(study_data, rng) -> None:
    found = identify(study_data, plane_problem(np.array([[1.0], [1.0]]), 1.0, 1e-3), 10, rng)
    # One of two directions is exact, so half of each variance is left.
    assert found.widths["width"].to_numpy() == pytest.approx(np.sqrt(0.5), rel=1e-3)


@pytest.mark.parametrize(("y", "far"), [(1.2, 4.0), (1.1, None), (0.5, None), (-0.5, 10.0)])
def test_data_outside_every_design_are_told_with_how_far(study_data, rng, y, far) -> None:
    found = identify(study_data, plane_problem(np.array([[1.0], [0.0]]), y, 0.05), 10, rng)
    if far is None:
        assert found.outside == ()
        return
    (one,) = found.outside
    assert one.errors == pytest.approx(far, rel=0.02)
    assert f"{one.errors:.1f} combined errors away" in found.sentences[-1]


@pytest.fixture
def study_data(tmp_path, rng):
    """Return a study with a target of the name that the plane has."""
    data = planted_study(tmp_path, bench("A", "glued"), rng)
    text = data.path.read_text().replace("t0_angle_deg", "angle_glued")
    data.path.write_text(text)
    return planted.load_data(data.path)


def test_a_pilot_sees_what_is_not_determined(tmp_path, rng) -> None:
    data = planted_study(tmp_path, bench("A", "glued"), rng, free=("mu_pp", "mu_roll_pp", "e_pp"))
    forms = forms_of(data)
    runs = make_runs(pilot_cases(data.study, forms, rng), "", planted.run, forms)
    trained = emulators_of(forms, runs).trained
    problem = problem_of(data, forms, {key: one.emulator for key, one in trained.items()})
    found = identify(data, problem, len(runs), rng)
    assert len(runs) < 30
    assert list(found.widths.index[found.widths["width"] > VAGUE]) == ["e_pp"]
    assert found.outside == ()


def test_the_next_batch_goes_to_the_posterior_and_to_the_sharper_target(tmp_path, rng) -> None:
    data = planted_study(tmp_path, bench("A", "glued"), rng)
    text = data.path.read_text().replace("se = 0.4", "se = 40.0")
    data.path.write_text(text)
    data = planted.load_data(data.path)
    forms = forms_of(data)
    runs = make_runs(first_cases(data.study, forms, rng), "", planted.run, forms)
    emulators = emulators_of(forms, runs)
    trained = {key: one.emulator for key, one in emulators.trained.items()}
    problem = problem_of(data, forms, trained)
    middle = np.array([TRUTH[name] for name in problem.space.names])
    samples = middle + 0.02 * rng.normal(size=(500, 2))
    batch = next_batch(data.study, problem, emulators, samples, 6, rng, 9)
    assert {spec.experiment for spec in batch.specs} == {"conveyor"}
    where = np.array([[spec.parameters[n] for n in problem.space.names] for spec in batch.specs])
    assert np.abs(where.mean(axis=0) - middle).max() < 0.1
    assert len({spec.seed for spec in batch.specs}) == 6
    assert all(0.0 <= move < 5.0 for move in batch.moves)
    # What another machine computes differs in the last digits; it makes the same runs.
    shaken = samples * (1.0 + 1e-9 * rng.normal(size=samples.shape))
    one, other = (
        next_batch(data.study, problem, emulators, at, 6, np.random.default_rng(5), 9)
        for at in (samples, shaken)
    )
    assert one.specs == other.specs


def test_what_a_run_costs_follows_from_its_case_alone(tmp_path, rng) -> None:
    data = planted_study(tmp_path, bench("A", "glued"), rng)
    cases = first_cases(data.study, forms_of(data), rng)
    glued = next(spec for spec in cases if spec.experiment == "conveyor")
    wall = {"mu_pw": 0.3, "mu_roll_pw": 0.1, "e_pw": 0.5}
    flat = replace(glued, surface="steel", parameters={**glued.parameters, **wall})
    assert work_of(glued) == work_of(replace(glued, seed=glued.seed + 1))
    # Steps, and the root of the grains that are there on average while they come at a steady rate.
    cases = [build_case(spec).variables for spec in (glued, flat)]
    poured = [min(v["grain_count"] / v["grain_rate"] / v["duration"], 1.0) for v in cases]
    slow, fast = (
        v["duration"] * np.sqrt(1.0 - 0.5 * part) for v, part in zip(cases, poured, strict=True)
    )
    assert slow > 1.5 * fast
    # A run has a whole number of steps, some hundred thousand.
    assert work_of(glued) / work_of(flat) == pytest.approx(slow / fast, rel=1e-4)


def test_stored_runs_of_the_same_study_are_found(tmp_path, rng) -> None:
    data = planted_study(tmp_path, bench("A", "glued"), rng)
    forms = forms_of(data)
    root = tmp_path / "runs"
    specs = first_cases(data.study, forms, rng)[:3]
    ours = [*specs, replace(specs[0], seed=99)]
    others = [
        replace(specs[0], scale="lab"),
        replace(specs[0], apparatus={"e_side": 0.7}),
        replace(specs[0], parameters={**specs[0].parameters, "e_pp": 0.7}),
        replace(specs[0], effects={"cohesion_J_m3": 1.0}),
    ]
    for spec in (*ours, *others):
        directory = write_case(spec, root / case_id(spec))
        values = planted.observed(spec)
        store_result(CaseResult(case_id(spec), directory, "ok", "", values, 1.0))
    (root / "notes").mkdir()
    found = stored_runs(data, forms, root)
    assert {case_id(spec) for spec in found.specs} == {case_id(spec) for spec in ours}
    # Ids are other ones for every version of the code; the order of runs, and sums of them, not.
    asked = [question(spec) for spec in found.specs]
    assert asked == sorted(asked)
    assert found.table["angle_deg"].notna().all()
    assert stored_runs(data, forms, tmp_path / "nowhere") is None


def test_runs_are_found_by_name_in_that_order_or_not_at_all(tmp_path, rng) -> None:
    data = planted_study(tmp_path, bench("A", "glued"), rng)
    forms = forms_of(with_effects(data))
    root = tmp_path / "runs"
    plain = first_cases(data.study, forms_of(data), rng)[0]
    specs = [replace(plain, effects={"cohesion_J_m3": 900.0}), replace(plain, seed=9), plain]
    for spec in specs:
        directory = write_case(spec, root / case_id(spec))
        values = planted.observed(spec)
        store_result(CaseResult(case_id(spec), directory, "ok", "", values, 1.0))
    names = [case_id(spec) for spec in specs]
    found = runs_named(names, forms, root, stored_case)
    assert found is not None
    assert [case_id(spec) for spec in found.specs] == names
    assert list(found.table["case_id"]) == names
    assert found.table["angle_deg"].notna().all()
    # One that is gone, or another case under its name: then none of them counts.
    assert runs_named([*names, "0" * 16], forms, root, stored_case) is None
    (root / names[0]).rename(root / "elsewhere")
    (root / names[1]).rename(root / names[0])
    assert runs_named(names[:1], forms, root, stored_case) is None


def test_surfaces_of_one_kind_are_one_stand(tmp_path, rng) -> None:
    measured = [*bench("A", "steel"), *bench("A", "alumina"), *bench("B", "steel")]
    data = planted_study(tmp_path, measured, rng)
    stands = stands_of(data.study, forms_of(data))
    heaps = [(s.material, len(s.places)) for s in stands if s.form.experiment == "heap"]
    assert heaps == [("A", 2), ("B", 1)]
