"""Parts of the diagnosis against slow twins and closed forms, on the stand-in."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from calibrate.diagnose import Diagnosis, Nuisance, Observable, Parameter, diagnose
from calibrate.diagnose.local.design import plan, specify
from calibrate.diagnose.scores import frame, marginal
from calibrate.diagnose.stack import PRIOR_SD, stack
from calibrate.errors import CalibrationError
from calibrate.report.diagnosis_figure import diagnosis_figure
from calibrate.report.diagnosis_section import section_html
from calibrate.report.diagnosis_words import sentences
from calibrate.report.record import as_data
from tests.calibrate.diagnose import cases, stand_in


@pytest.fixture(scope="module")
def named() -> Diagnosis:
    """Diagnose a study with a funnel that gives a quarter too much."""
    return cases.run(40, {"mass_flow": 0.26})


def test_parameter_map_is_its_own_inverse() -> None:
    for logarithmic in (False, True):
        one = Parameter("mu_pp", 0.1, 0.8, 0.5, logarithmic)
        for value in (0.1, 0.33, 0.8):
            assert one.from_unit(one.to_unit(value)) == pytest.approx(value, rel=1e-12)


def test_a_start_outside_the_range_is_refused_with_place_and_remedy() -> None:
    with pytest.raises(CalibrationError, match=r"mu_pp: start 0.9 .* widen the range"):
        Parameter("mu_pp", 0.1, 0.8, 0.9)


def test_an_observable_without_error_is_refused() -> None:
    with pytest.raises(CalibrationError, match=r"heap_steel.angle_deg: .* standard error 0.0"):
        Observable("heap_steel", "angle_deg", 34.0, 0.0, "linear")


def test_a_value_off_its_scale_is_refused() -> None:
    with pytest.raises(CalibrationError, match=r"m1_g: value 0 has no place on the scale 'log'"):
        Observable("plate_impact_steel", "m1_g", 0.0, 0.1, "log")


def test_strength_zero_is_the_base_model_and_seeds_are_common() -> None:
    problem = stand_in.problem((), stand_in.TRUTH)
    points = plan(problem, "conveyor_steel", problem.start, cases.OPTIONS.design)
    specs = specify(problem, "conveyor_steel", points)
    base_seeds = {s.seed for s in specs if not s.effects}
    for candidate in problem.candidates_in("conveyor_steel"):
        on = [s for s in specs if candidate.effect in s.effects]
        assert len(on) == 2 * cases.OPTIONS.design.effect_seeds
        assert {s.seed for s in on} <= base_seeds
        assert all(s.effects[candidate.effect] != 0.0 for s in on)


def test_left_out_residual_equals_brute_force(named: Diagnosis) -> None:
    """Leave each observable out of the Gaussian model and predict it from the others."""
    one = frame(named.local.stack, named.local.base)
    k = marginal(one.covariance, one.by_u)
    n = len(one.residual)
    for j, row in enumerate(named.residuals):
        kept = np.delete(np.arange(n), j)
        lever = np.linalg.solve(k[np.ix_(kept, kept)], k[kept, j])
        variance = k[j, j] - lever @ k[kept, j]
        z = (one.residual[j] - lever @ one.residual[kept]) / np.sqrt(variance)
        assert row.z_left_out == pytest.approx(z, rel=1e-6)


def test_absorption_equals_the_schur_complement(named: Diagnosis) -> None:
    """Information with parameters free, written out with J and the prior instead of K."""
    one = frame(named.local.stack, named.local.base)
    plain = np.linalg.inv(one.covariance)
    prior = np.eye(one.by_u.shape[1]) / PRIOR_SD**2
    for k, row in enumerate(named.absorption.candidates):
        g = one.by_phi[:, k]
        cross = one.by_u.T @ plain @ g
        whole = g @ plain @ g
        kept = whole - cross @ np.linalg.solve(one.by_u.T @ plain @ one.by_u + prior, cross)
        assert row.absorbed == pytest.approx(1.0 - kept / whole, abs=1e-8)
        assert row.detectable == pytest.approx(2.8 / np.sqrt(kept), rel=1e-6)


def test_the_named_cause_is_the_hidden_one_with_its_size(named: Diagnosis) -> None:
    assert named.verdict.kind == "named"
    assert named.verdict.names == ("mass_flow_factor",)
    low, high = named.verdict.intervals["mass_flow_factor"].interval95
    assert low <= 0.26 <= high
    assert named.verdict.p_search <= named.levels.search
    assert named.gains[0].claimed
    assert named.gains[0].rms_after < named.gains[0].rms_before


def test_the_same_study_gives_the_same_diagnosis() -> None:
    assert as_data(cases.run(41, {})) == as_data(cases.run(41, {}))


def test_a_declared_nuisance_takes_the_blame() -> None:
    """Both angles read too high by one camera: declared, it no longer bends the parameters."""
    rng = np.random.default_rng(5)
    shift = 4.0
    observables = tuple(
        replace(o, value=o.value + shift) if o.quantity == "angle_deg" else o
        for o in stand_in.bench(stand_in.TRUTH, {}, rng)
    )
    plain = stand_in.problem(observables, stand_in.TRUTH)
    camera = Nuisance("camera", {"heap_glued.angle_deg": 3.0, "heap_steel.angle_deg": 3.0})
    declared = replace(plain, nuisances=(camera,))
    found = [
        diagnose(p, stand_in.StandIn(3), rng=np.random.default_rng(1), options=cases.OPTIONS)
        for p in (plain, declared)
    ]
    friction = slice(0, 2)
    off = [np.abs(f.local.base.u - plain.start)[friction] for f in found]
    assert (off[1] < 0.5 * off[0]).all()
    assert (found[1].local.base.u_sd[friction] > found[0].local.base.u_sd[friction]).all()


def test_failed_runs_are_noted_and_too_many_stop_with_the_place() -> None:
    runner = stand_in.StandIn(1)

    def sometimes(specs):
        results = runner(specs)
        return [
            replace(r, status="failed", reason="lost") if s.seed == 3 else r
            for s, r in zip(specs, results, strict=True)
        ]

    rng = np.random.default_rng(2)
    problem = stand_in.problem(stand_in.bench(stand_in.TRUTH, {}, rng), stand_in.TRUTH)
    found = diagnose(problem, sometimes, rng=rng, options=cases.OPTIONS)
    assert found.local.failed
    assert all(reason.endswith("lost") for reason in found.local.failed)

    def never(specs):
        return [replace(r, status="failed", reason="lost") for r in runner(specs)]

    with pytest.raises(CalibrationError, match=r"heap_glued: only 0 of \d+ runs succeeded"):
        diagnose(problem, never, rng=rng, options=cases.OPTIONS)


def test_a_run_that_misses_an_observable_is_a_failed_run() -> None:
    runner = stand_in.StandIn(1)

    def short(specs):
        return [
            replace(r, observables={k: v for k, v in r.observables.items() if k != "t200_s"})
            if s.seed == 2
            else r
            for s, r in zip(specs, runner(specs), strict=True)
        ]

    rng = np.random.default_rng(2)
    problem = stand_in.problem(stand_in.bench(stand_in.TRUTH, {}, rng), stand_in.TRUTH)
    found = diagnose(problem, short, rng=rng, options=cases.OPTIONS)
    assert any("does not show t200_s" in reason for reason in found.local.failed)


def test_record_figure_and_section_hold_the_verdict(named: Diagnosis) -> None:
    data = json.loads(json.dumps(as_data(named)))
    assert data["verdict"] == "named"
    assert data["suspects"][0]["candidate"] == "mass_flow_factor"
    assert len(data["residuals"]) == len(named.problem.observables)
    figure = diagnosis_figure(named)
    assert figure.startswith(b"\x89PNG")
    html = section_html(named, figure)
    assert "mass_flow_factor" in html
    assert html.count("<table>") == 2
    assert any("False" not in s and "Next measurement" in s for s in sentences(named))


def test_section_escapes_what_comes_from_outside(named: Diagnosis) -> None:
    nasty = replace(named.residuals[0], name="<script>alert(1)</script>")
    html = section_html(replace(named, residuals=(nasty, *named.residuals[1:])), b"")
    assert "<script>" not in html


def test_errors_from_few_repeats_have_their_own_uncertainty() -> None:
    """Curve points share their luck: their correlation enters V, other data stay independent."""
    rng = np.random.default_rng(4)
    problem = stand_in.problem(stand_in.bench(stand_in.TRUTH, {}, rng), stand_in.TRUTH)
    found = diagnose(problem, stand_in.StandIn(1), rng=rng, options=cases.OPTIONS)
    together = stack(problem, found.local.stack.surrogates)
    rows = together.blocks["conveyor_steel"]
    assert (together.alike[rows, rows] > 0.3).all()
    boxes = together.blocks["impact_steel"]
    np.testing.assert_array_equal(together.alike[boxes, boxes], np.eye(4))
